// Outputs of kind kms on a fake card: what happens to the displays of a wall.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "render/out/kms/displays.h"
#include "tests/support/fake_card.h"
#include "tests/support/fake_clock.h"

namespace merlin::render::out::kms {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Bench;
using test::FakeCard;
using test::mode;
using test::projector;

class DisplaysTest : public testing::Test {
 protected:
  DisplaysTest() {
    for (const char* connector : {"A-1", "A-2"})
      displays_.add({"", connector, "640x480@60"}, 640, 480);
  }
  void step() { displays_.step(Duration::zero()); }
  void secondLater() {
    clock_.advance(seconds(1));
    step();
  }
  // Presents a frame with this blue value to both outputs.
  void present(std::uint8_t blue) {
    std::vector<std::uint8_t> pixels(640 * 480 * 4);
    for (std::size_t i = 2; i < pixels.size(); i += 4) pixels[i] = blue;
    ++sequence_;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto shown = displays_.present(i, pixels, sequence_);
      faults_[i] = shown ? "" : shown.error().what;
      counted_[i] += shown && *shown ? 1 : 0;
    }
  }
  void light() {
    step();
    present(1);
    step();
    ASSERT_EQ(bench_.commits.size(), 1U);
  }

  Bench bench_;
  bool opens_ = true;
  test::FakeClock clock_;
  Displays displays_{[this]() -> Result<std::unique_ptr<Card>> {
                       if (!opens_) return Error{Errc::kNotFound, "there is no card"};
                       return std::unique_ptr<Card>(std::make_unique<FakeCard>(bench_));
                     },
                     clock_};
  std::uint64_t sequence_ = 0;
  std::string faults_[2];
  int counted_[2] = {};
};

TEST_F(DisplaysTest, AFrameIsOneCommitOfAllDisplays) {
  light();
  EXPECT_EQ(bench_.commits[0].size(), 2U);
  EXPECT_TRUE(bench_.commits[0][0].sets_mode && bench_.commits[0][1].sets_mode);
  EXPECT_EQ(bench_.commits[0][1].plane, 32U);
  EXPECT_EQ(bench_.commits[0][0].mode.refresh_hz, 60);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 1}, {22, 1}}));
  present(2);
  step();
  ASSERT_EQ(bench_.commits.size(), 2U);
  EXPECT_EQ(bench_.commits[1].size(), 2U);
  EXPECT_FALSE(bench_.commits[1][0].sets_mode);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 2}, {22, 2}}));
  EXPECT_EQ(counted_[0], 2);
  EXPECT_FALSE(displays_.wantsFrame(0));
}

class EveryConnectorTest : public DisplaysTest {
 protected:
  EveryConnectorTest() { every_.add({"", "*", ""}, 640, 480); }
  // Presents a frame and completes its flip; returns the fault.
  std::string show(std::uint64_t sequence, std::uint8_t blue) {
    std::vector<std::uint8_t> pixels(640 * 480 * 4);
    for (std::size_t i = 2; i < pixels.size(); i += 4) pixels[i] = blue;
    const auto shown = every_.present(0, pixels, sequence);
    every_.step(Duration::zero());
    return shown ? "" : shown.error().what;
  }
  void lookAgain() {
    clock_.advance(seconds(1));
    every_.step(Duration::zero());
  }
  Displays every_{[this]() -> Result<std::unique_ptr<Card>> {
                    if (!opens_) return Error{Errc::kNotFound, "there is no card"};
                    return std::unique_ptr<Card>(std::make_unique<FakeCard>(bench_));
                  },
                  clock_};
};

TEST_F(EveryConnectorTest, ShowsThePictureOnEachDisplayThatThereIs) {
  every_.step(Duration::zero());
  EXPECT_EQ(show(1, 5), "");
  ASSERT_EQ(bench_.commits.size(), 1U) << "one commit";
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 5}, {22, 5}}));
}

TEST_F(EveryConnectorTest, HasNoFaultWithoutADisplayOrACard) {
  opens_ = false;
  every_.step(Duration::zero());
  EXPECT_EQ(show(1, 5), "");
  EXPECT_EQ(every_.fault(0), "");
  opens_ = true;
  for (Connector& connector : bench_.connectors) connector.connected = false;
  lookAgain();
  EXPECT_EQ(show(2, 6), "");
  EXPECT_TRUE(bench_.commits.empty());
  EXPECT_FALSE(every_.wantsFrame(0));
  bench_.connectors[1].connected = true;
  lookAgain();
  EXPECT_TRUE(every_.wantsFrame(0)) << "although nothing moves";
  EXPECT_EQ(show(3, 7), "");
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 7}})) << "the first CRTC is free";
}

TEST_F(EveryConnectorTest, APulledDisplayDoesNotMoveTheOthers) {
  every_.step(Duration::zero());
  show(1, 5);
  bench_.connectors[0].connected = false;
  lookAgain();
  EXPECT_EQ(show(2, 6), "");
  ASSERT_EQ(bench_.commits.back().size(), 1U);
  EXPECT_EQ(bench_.commits.back()[0].crtc, 22U);
  EXPECT_FALSE(bench_.commits.back()[0].sets_mode);
}

TEST_F(EveryConnectorTest, WhatIsWrongWithADisplayIsAFaultAndTheOthersShow) {
  bench_.connectors[1].modes = {mode(320, 240, 60)};
  every_.step(Duration::zero());
  EXPECT_NE(show(1, 5).find("more than mode 320x240@60 of A-2"), std::string::npos);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 5}}));
}

TEST_F(EveryConnectorTest, LeavesTheOnesThatAnotherOutputNames) {
  every_.add({"", "A-1", "1024x768"}, 640, 480);
  every_.step(Duration::zero());
  show(1, 5);
  std::vector<std::uint8_t> pixels(640 * 480 * 4);
  ASSERT_TRUE(every_.present(1, pixels, 1));
  every_.step(Duration::zero());
  ASSERT_EQ(bench_.commits.size(), 1U);
  EXPECT_EQ(bench_.commits[0].size(), 2U);
  const int blues = bench_.shown[21] + bench_.shown[22];
  EXPECT_EQ(blues, 5) << "one display each";
}

TEST_F(DisplaysTest, AFrameThatNotEveryOutputHasIsNotCommitted) {
  light();
  std::vector<std::uint8_t> pixels(640 * 480 * 4);
  ASSERT_TRUE(displays_.present(0, pixels, 99));
  step();
  EXPECT_EQ(bench_.commits.size(), 1U);
  ASSERT_TRUE(displays_.present(1, pixels, 99));
  step();
  EXPECT_EQ(bench_.commits.size(), 2U);
}

TEST_F(DisplaysTest, ASlowDisplayGetsTheNewestFrameWhenItIsDone) {
  light();
  bench_.answers_flips = false;
  present(2);
  step();
  for (const std::uint8_t blue : std::initializer_list<std::uint8_t>{3, 4, 5}) {
    present(blue);
    step();
  }
  EXPECT_EQ(bench_.commits.size(), 2U) << "one flip at a time";
  EXPECT_EQ(counted_[0], 3) << "two frames were replaced before they were committed";
  bench_.flips = {{21, clock_.now()}, {22, clock_.now()}};
  step();
  step();
  EXPECT_EQ(bench_.commits.size(), 3U);
  EXPECT_EQ(bench_.shown[22], 5);
}

TEST_F(DisplaysTest, APulledConnectorLeavesTheOthersUpAndComesBackByItself) {
  light();
  bench_.connectors[1].connected = false;
  secondLater();
  EXPECT_EQ(displays_.fault(1), "nothing is plugged in at A-2 of /dev/dri/card7")
      << "while nothing moves";
  EXPECT_FALSE(displays_.wantsFrame(0) || displays_.wantsFrame(1));
  present(2);
  step();
  EXPECT_EQ(faults_[0], "");
  EXPECT_EQ(faults_[1], "nothing is plugged in at A-2 of /dev/dri/card7");
  EXPECT_EQ(bench_.commits.back().size(), 1U);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 2}, {22, 1}}));

  const int probes = bench_.probes;
  bench_.connectors[1].connected = true;
  secondLater();
  EXPECT_EQ(bench_.probes, probes + 1) << "it may be another display";
  ASSERT_TRUE(displays_.wantsFrame(1));
  present(3);
  step();
  EXPECT_EQ(faults_[1], "");
  ASSERT_EQ(bench_.commits.back().size(), 2U);
  EXPECT_FALSE(bench_.commits.back()[0].sets_mode) << "the others do not blink";
  EXPECT_TRUE(bench_.commits.back()[1].sets_mode);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 3}, {22, 3}}));
  secondLater();
  EXPECT_EQ(bench_.probes, probes + 1) << "displays are not asked without need";
}

TEST_F(DisplaysTest, AnotherDisplayAtAConnectorGetsItsOwnMode) {
  light();
  bench_.connectors[0].connected = false;
  secondLater();
  bench_.connectors[0] = projector(11, "A-1");
  bench_.connectors[0].modes = {mode(1024, 768, 60, true)};
  secondLater();
  present(2);
  EXPECT_EQ(faults_[0], "A-1 has no mode 640x480@60; it has 1024x768@60");
  EXPECT_EQ(faults_[1], "");
}

TEST_F(DisplaysTest, ADisplayThatLostItsSignalIsLitAgain) {
  light();
  bench_.connectors[0].link_bad = true;
  secondLater();
  bench_.connectors[0].link_bad = false;
  present(2);
  step();
  EXPECT_TRUE(bench_.commits.back()[0].sets_mode);
}

TEST_F(DisplaysTest, AnotherProgramThatHasTheDisplaysIsNamedUntilItGivesThemBack) {
  bench_.other_is_master = true;
  step();
  present(1);
  EXPECT_EQ(faults_[0],
            "another program has the displays of /dev/dri/card7: desktop (77); the wall returns "
            "when it ends");
  EXPECT_TRUE(bench_.commits.empty());
  bench_.other_is_master = false;
  secondLater();
  ASSERT_TRUE(displays_.wantsFrame(0));
  present(2);
  step();
  EXPECT_EQ(faults_[0], "");
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 2}, {22, 2}}));
}

TEST_F(DisplaysTest, DisplaysThatAreTakenAwayAreLitAgainWithTheirModes) {
  light();
  bench_.other_is_master = true;
  present(2);
  step();
  EXPECT_NE(displays_.fault(0), "");
  present(3);
  EXPECT_NE(faults_[1].find("desktop (77)"), std::string::npos);
  bench_.other_is_master = false;
  secondLater();
  present(4);
  step();
  EXPECT_EQ(faults_[1], "");
  EXPECT_EQ(bench_.commits.back().size(), 2U);
  EXPECT_TRUE(bench_.commits.back()[0].sets_mode);
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 4}, {22, 4}}));
}

TEST_F(DisplaysTest, WhileNothingMovesTheyAreSeenToBeTakenAway) {
  light();
  bench_.other_is_master = true;
  secondLater();
  EXPECT_NE(displays_.fault(0), "");
  bench_.other_is_master = false;
  secondLater();
  EXPECT_TRUE(displays_.wantsFrame(0));
}

TEST_F(DisplaysTest, ACardThatComesLaterOrGoesIsWaitedFor) {
  opens_ = false;
  step();
  present(1);
  EXPECT_EQ(faults_[1], "there is no card");
  step();
  opens_ = true;
  secondLater();
  step();
  light();
  EXPECT_EQ(faults_[1], "");
  bench_.there = false;
  secondLater();
  present(2);
  EXPECT_EQ(faults_[0], "the card has gone");
  bench_.there = true;
  secondLater();
  step();
  present(3);
  step();
  EXPECT_EQ(bench_.shown[21], 3);
  EXPECT_EQ(bench_.buffers.size(), 6U) << "the old buffers are gone";
}

TEST_F(DisplaysTest, WhatTheCardRefusesIsLeftOutAndTriedAgain) {
  bench_.refused = {11};
  step();
  present(1);
  step();
  present(2);
  step();
  EXPECT_EQ(faults_[0], "the card refuses 640x480@60 at A-1: Invalid argument");
  EXPECT_EQ(faults_[1], "");
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{22, 2}}));
  bench_.refused.clear();
  clock_.advance(seconds(11));
  step();
  present(3);
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 3}, {22, 3}}));
}

TEST_F(DisplaysTest, MoreDisplaysThanTheCardCanDriveLightTheFirstOnes) {
  bench_.most_at_once = 1;
  step();
  present(1);
  step();
  present(2);
  step();
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 2}}));
  EXPECT_NE(faults_[1].find("beside the other displays"), std::string::npos);
}

TEST_F(DisplaysTest, AConnectorThatIsNotThereIsSaidWithTheOnesThatAre) {
  bench_.connectors[1].name = "B-5";
  step();
  present(1);
  step();
  EXPECT_EQ(faults_[1], "/dev/dri/card7 has no connector A-2; it has A-1, B-5");
  EXPECT_EQ(bench_.shown, (std::map<Id, int>{{21, 1}}));
}

TEST_F(DisplaysTest, ACommitThatComesTooEarlyIsTriedAgain) {
  light();
  bench_.next = Committed::kBusy;
  present(2);
  step();
  EXPECT_EQ(bench_.shown[21], 1);
  step();
  EXPECT_EQ(bench_.shown[21], 2);
}

TEST_F(DisplaysTest, ADisplayThatShowsNothingDoesNotStopTheOthers) {
  light();
  bench_.answers_flips = false;
  present(2);
  bench_.flips = {{22, clock_.now()}};
  step();
  clock_.advance(milliseconds(1100));
  step();
  present(3);
  EXPECT_EQ(faults_[0], "A-1 has shown no frame for a second; it is lit again");
  bench_.answers_flips = true;
  step();
  EXPECT_EQ(bench_.shown[22], 3);
}

TEST_F(DisplaysTest, VerticalBlanksAreToldWhereTheyAreCounted) {
  light();
  EXPECT_FALSE(displays_.blanks());
  bench_.has_vblank = true;
  bench_.flip_time = clock_.now() + milliseconds(7);
  present(2);
  step();
  const auto blanks = displays_.blanks();
  ASSERT_TRUE(blanks);
  EXPECT_EQ(blanks->last, bench_.flip_time);
  EXPECT_EQ(blanks->period, Duration(16666666));
}

}  // namespace
}  // namespace merlin::render::out::kms
