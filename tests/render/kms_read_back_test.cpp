// Reads back what the displays of a graphics card really show, independently of what `Displays` has
// recorded.
#include <gtest/gtest.h>

#include "render/out/kms/displays.h"
#include "tests/support/fake_card.h"
#include "tests/support/fake_clock.h"

namespace merlin::render::out::kms {
namespace {

using Kind = FoundPicture::Kind;

class KmsReadBackTest : public testing::Test {
 protected:
  KmsReadBackTest() {
    for (const char* connector : {"A-1", "A-2"})
      displays_.add({"", connector, "640x480@60"}, 640, 480);
  }
  void step() { displays_.step(Duration::zero()); }
  static std::vector<std::uint8_t> picture(std::uint8_t n) {
    std::vector<std::uint8_t> pixels(640 * 480 * 4);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(n + i);
    return pixels;
  }
  static PictureDigest digest(std::uint8_t n) {
    return digestOf({640, 480, picture(n), std::size_t{640} * 4});
  }
  void present(std::uint8_t n) {
    ++sequence_;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(displays_.present(i, picture(n), sequence_));
    }
  }
  void light() {
    step();
    present(1);
    step();
  }
  FoundPicture found(std::size_t i) {
    const auto readings = displays_.readBack(i);
    EXPECT_TRUE(readings.ok());
    EXPECT_EQ(readings->size(), 1U);
    return readings->at(0).found;
  }

  test::Bench bench_;
  test::FakeClock clock_;
  Displays displays_{[this]() -> Result<std::unique_ptr<Card>> {
                       return std::unique_ptr<Card>(std::make_unique<test::FakeCard>(bench_));
                     },
                     clock_};
  std::uint64_t sequence_ = 0;
};

TEST_F(KmsReadBackTest, WhatIsScannedOutIsWhatWasPresented) {
  light();
  EXPECT_EQ(found(0).digest, digest(1));
  EXPECT_EQ(found(1).kind, Kind::kPixels);
  EXPECT_EQ(displays_.readBack(0)->at(0).connector, "A-1");
  present(2);
  EXPECT_EQ(found(0).digest, digest(1)) << "the new one is not committed yet";
  step();
  EXPECT_EQ(found(0).digest, digest(2));
}

TEST_F(KmsReadBackTest, NothingIsReadBeforeTheFirstCommit) {
  EXPECT_EQ(displays_.readBack(0)->size(), 0U);
  step();
  present(1);
  EXPECT_EQ(displays_.readBack(0)->size(), 0U) << "the console is still there";
  step();
  EXPECT_EQ(displays_.readBack(0)->size(), 1U);
}

TEST_F(KmsReadBackTest, ADisplayThatIsOffAndOneWithAnotherBuffer) {
  light();
  bench_.scanned[21].is_on = false;
  EXPECT_EQ(found(0).kind, Kind::kOff);
  bench_.scanned[22].buffer = 5;
  EXPECT_EQ(found(1).kind, Kind::kForeign);
  EXPECT_EQ(displays_.readBack(1)->at(0).programs, "desktop (77)");
}

TEST_F(KmsReadBackTest, AnotherPlaneOverThePictureIsForeign) {
  light();
  bench_.scanned[21].covered = true;
  EXPECT_EQ(found(0).kind, Kind::kForeign);
}

TEST_F(KmsReadBackTest, ABufferThatIsFlippedWhileItIsReadIsReadAgain) {
  light();
  bench_.on_read = [this] {
    bench_.on_read = nullptr;
    present(2);
    step();
  };
  EXPECT_EQ(found(0).digest, digest(2));
  bench_.on_read = [this] {
    present(static_cast<std::uint8_t>(sequence_));
    step();
  };
  EXPECT_FALSE(displays_.readBack(0)) << "it never stands still";
}

TEST_F(KmsReadBackTest, ShowAgainSetsTheModeAndAsksForAFrame) {
  light();
  ASSERT_FALSE(displays_.wantsFrame(0));
  displays_.showAgain(0);
  step();
  EXPECT_TRUE(displays_.wantsFrame(0));
  EXPECT_FALSE(displays_.wantsFrame(1));
  EXPECT_EQ(displays_.readBack(0)->size(), 0U) << "until its mode is set";
  present(1);
  step();
  ASSERT_EQ(bench_.commits.size(), 2U);
  EXPECT_TRUE(bench_.commits[1][0].sets_mode);
  EXPECT_FALSE(bench_.commits[1][1].sets_mode);
  EXPECT_EQ(found(0).digest, digest(1));
}

TEST_F(KmsReadBackTest, ADisplayThatFailsAnywayIsNotRead) {
  light();
  bench_.other_is_master = true;
  clock_.advance(std::chrono::seconds(1));
  step();
  EXPECT_NE(displays_.fault(0), "");
  EXPECT_EQ(displays_.readBack(0)->size(), 0U);
}

TEST_F(KmsReadBackTest, ACardThatIsGoneIsAnError) {
  light();
  bench_.there = false;
  EXPECT_FALSE(displays_.readBack(0));
  clock_.advance(std::chrono::seconds(1));
  step();
  EXPECT_EQ(displays_.readBack(0)->size(), 0U);
}

// `Displays` has recorded that a newer frame is shown, but the card still shows the old one.
TEST_F(KmsReadBackTest, ACommitWithoutAFlipLeavesTheOldBuffer) {
  light();
  const ScannedOut before = bench_.scanned[21];
  present(2);
  step();
  bench_.scanned[21] = before;
  EXPECT_EQ(found(0).digest, digest(1));
}

}  // namespace
}  // namespace merlin::render::out::kms
