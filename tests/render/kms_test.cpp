// Outputs of kind kms on a fake card: the choice of connectors and modes, and what happens to a
// wall's displays.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "render/out/kms/buffer_turns.h"
#include "render/out/kms/choice.h"
#include "render/out/kms/displays.h"
#include "render/out/kms/settings.h"
#include "render/out/settings.h"
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

TEST(ModeNameTest, IsReadWithAndWithoutARate) {
  EXPECT_EQ(parseMode("1920x1080")->height, 1080);
  EXPECT_EQ(parseMode("1920x1080")->refresh_hz, 0);
  EXPECT_EQ(parseMode("640x480@59.94")->refresh_hz, 59.94);
  for (const char* bad :
       {"", "1920", "1920x", "x1080", "1920x1080@", "1920x1080@60Hz", "0x5", "-1x5", "1920 x 1080",
        "99999x5", "640x480@0", "640x480@1e9", "640x480@nan", "9999999999999x5"})
    EXPECT_FALSE(parseMode(bad)) << bad;
}

TEST(KmsSettingsTest, FaultsNameTheSettingAndTheWayOut) {
  const SettingFaults faults = validate(KmsSettings{"card0", "HDMI 1/../x", "big"});
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(faults[0].pointer, "/card");
  EXPECT_NE(faults[0].what.find("/dev/dri/card0"), std::string::npos);
  EXPECT_EQ(faults[1].pointer, "/connector");
  EXPECT_EQ(faults[2].pointer, "/mode");
  EXPECT_TRUE(validate(KmsSettings{"/dev/dri/card1", "HDMI-A-1", "1920x1080@60"}).empty());
  EXPECT_TRUE(validate(KmsSettings{}).empty());
  EXPECT_TRUE(validate(KmsSettings{"", "*", ""}).empty());
  EXPECT_EQ(validate(KmsSettings{"", "HDMI-*", ""}).size(), 1U);
}

SettingFaults faultsOf(const std::vector<KmsSettings>& displays) {
  std::vector<OutputSettings> outputs;
  for (const KmsSettings& display : displays) {
    outputs.push_back(
        {.kind = OutputKind::kKms, .name = std::to_string(outputs.size()), .kms = display});
  }
  return out::validate(outputs, tiles::TilesSettings{});
}

TEST(KmsSettingsTest, ADisplayIsOneOutputs) {
  EXPECT_TRUE(faultsOf({{"", "A-1", ""}, {"", "A-2", ""}}).empty());
  EXPECT_TRUE(faultsOf({{"/dev/a", "A-1", ""}, {"/dev/b", "A-1", ""}}).empty());
  const SettingFaults twice = faultsOf({{"", "A-1", ""}, {"", "A-1", ""}});
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_EQ(twice[0].pointer, "/1/kms/connector");
  EXPECT_EQ(faultsOf({{"", "A-1", ""}, {"", "", ""}}).size(), 1U) << "which connector is open";
  EXPECT_TRUE(faultsOf({{"", "A-1", ""}, {"", "*", ""}}).empty());
  EXPECT_EQ(faultsOf({{"", "*", ""}, {"", "*", ""}}).size(), 1U);
  EXPECT_EQ(faultsOf({{"", "A-1", ""}, {"/dev/a", "A-2", ""}}).size(), 1U)
      << "the unnamed card may be the named one";
}

TEST(ChooseModeTest, NamedModesAreTakenByTheirRate) {
  const Connector c = projector(1, "A-1");
  EXPECT_EQ(*chooseMode(c, "640x480@75", 640, 480), 3U);
  EXPECT_EQ(*chooseMode(c, "640x480@60", 640, 480), 1U);
  EXPECT_EQ(*chooseMode(c, "640x480@59.94", 640, 480), 2U);
  EXPECT_EQ(*chooseMode(c, "640x480", 640, 480), 3U) << "the fastest";
  EXPECT_EQ(*chooseMode(c, "1024x768", 640, 480), 0U) << "a smaller picture is shown in it";
}

TEST(ChooseModeTest, WithoutANameThePicturesSizeDecidesThenTheDisplay) {
  const Connector c = projector(1, "A-1");
  EXPECT_EQ(*chooseMode(c, "", 640, 480), 3U);
  EXPECT_EQ(*chooseMode(c, "", 1024, 768), 0U);
  EXPECT_EQ(*chooseMode(c, "", 800, 600), 0U) << "the preferred one";
}

TEST(ChooseModeTest, WhatIsNotThereIsSaidWithWhatIs) {
  const Connector c = projector(1, "A-1");
  const auto missing = chooseMode(c, "1920x1080", 640, 480);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().what,
            "A-1 has no mode 1920x1080; it has 1024x768@60, 640x480@60, 640x480@75");
  EXPECT_FALSE(chooseMode(c, "640x480@90", 640, 480));
  const auto large = chooseMode(c, "640x480", 800, 480);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(chooseMode(Connector{.name = "A-2"}, "", 640, 480));
}

TEST(ChooseModeTest, InterlacedOnesAreTheLastChoice) {
  Connector c{.name = "A-1", .modes = {mode(1920, 1080, 60), mode(1920, 1080, 50)}};
  c.modes[0].interlaced = true;
  EXPECT_EQ(*chooseMode(c, "1920x1080", 1920, 1080), 1U);
  EXPECT_EQ(*chooseMode(c, "", 1920, 1080), 1U);
}

TEST(ChooseConnectorTest, ByNameOrTheFirstWithADisplay) {
  std::vector<Connector> all = {projector(1, "A-1"), projector(2, "A-2")};
  all[0].connected = false;
  EXPECT_EQ(*chooseConnector(all, "A-1", "card"), 0U);
  EXPECT_EQ(*chooseConnector(all, "", "card"), 1U);
  all[1].connected = false;
  EXPECT_EQ(*chooseConnector(all, "", "card"), 0U);
  EXPECT_EQ(chooseConnector(all, "B-1", "/dev/c").error().what,
            "/dev/c has no connector B-1; it has A-1, A-2");
  EXPECT_FALSE(chooseConnector({}, "", "card"));
}

TEST(AssignCrtcsTest, NobodyGoesWithoutIfThereIsAWay) {
  const std::uint32_t any[] = {0b11, 0b01};
  EXPECT_EQ(assignCrtcs(any, 0b11)[0], 1U) << "the second one can have the first CRTC alone";
  EXPECT_EQ(assignCrtcs(any, 0b11)[1], 0U);
  const std::uint32_t chain[] = {0b0011, 0b0110, 0b0001};
  const auto assigned = assignCrtcs(chain, ~0U);
  EXPECT_EQ(assigned[0], 1U);
  EXPECT_EQ(assigned[1], 2U);
  EXPECT_EQ(assigned[2], 0U);
  const std::uint32_t many[] = {0b11, 0b11, 0b11};
  const auto first_come = assignCrtcs(many, 0b11);
  EXPECT_TRUE(first_come[0] && first_come[1]);
  EXPECT_FALSE(first_come[2]);
  EXPECT_FALSE(assignCrtcs(any, 0b10)[1]) << "a CRTC without a plane is no use";
}

TEST(WritePictureTest, SwapsRedAndBlueInTheMiddle) {
  const std::uint8_t rgba[] = {1, 2, 3, 255, 4, 5, 6, 255};  // 2 x 1
  std::vector<std::uint8_t> buffer(3 * 20);                  // 4 x 3, a pitch of 5 pixels
  writePicture(rgba, 2, 1, buffer, 20, 4, 3);
  std::vector<std::uint8_t> expected(3 * 20);
  const std::uint8_t middle[] = {3, 2, 1, 255, 6, 5, 4, 255};
  std::copy(std::begin(middle), std::end(middle), expected.begin() + 24);
  EXPECT_EQ(buffer, expected);
}

TEST(WritePictureTest, RowsOfAnyLength) {
  const int width = 37;
  std::vector<std::uint8_t> rgba(width * 4 * 2), buffer(rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<std::uint8_t>(i);
  writePicture(rgba, width, 2, buffer, width * 4, width, 2);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    EXPECT_EQ(buffer[i], rgba[i + 2]) << i;
    EXPECT_EQ(buffer[i + 1], rgba[i + 1]) << i;
    EXPECT_EQ(buffer[i + 2], rgba[i]) << i;
  }
}

TEST(BufferTurnsTest, WhatIsShownOrOnItsWayIsNeverWritten) {
  BufferTurns turns;
  std::set<std::size_t> used;
  const auto first = turns.beginWrite();
  EXPECT_FALSE(first.replaces);
  EXPECT_FALSE(turns.ready());
  turns.endWrite(first.buffer);
  turns.commit();
  EXPECT_TRUE(turns.isPending());
  turns.flipped();
  const auto second = turns.beginWrite();
  turns.endWrite(second.buffer);
  turns.commit();
  const auto third = turns.beginWrite();
  turns.endWrite(third.buffer);
  EXPECT_EQ((std::set{first.buffer, second.buffer, third.buffer}).size(), 3U);
  const auto newer = turns.beginWrite();
  EXPECT_TRUE(newer.replaces);
  EXPECT_EQ(newer.buffer, third.buffer);
  turns.endWrite(newer.buffer);
  turns.flipped();
  EXPECT_EQ(turns.ready(), newer.buffer);
  EXPECT_EQ(turns.beginWrite().buffer, newer.buffer);
}

TEST(BufferTurnsTest, ARefusedCommitWaitsAgainUnlessANewerOneDoes) {
  BufferTurns turns;
  turns.endWrite(turns.beginWrite().buffer);
  turns.commit();
  turns.uncommit();
  ASSERT_TRUE(turns.ready());
  turns.commit();
  turns.endWrite(turns.beginWrite().buffer);
  const auto newer = turns.ready();
  turns.uncommit();
  EXPECT_EQ(turns.ready(), newer);
  turns.commit();
  EXPECT_FALSE(turns.ready());
}

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
