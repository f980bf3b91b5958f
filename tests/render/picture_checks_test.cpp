// Outputs that show something other than what they were given, and how soon the checks find it.
#include "render/out/picture_checks.h"

#include <memory>

#include <gtest/gtest.h>

#include "render/out/output_set.h"
#include "render/out/settings.h"
#include "tests/support/eventually.h"
#include "tests/support/fake_clock.h"

namespace merlin::render::out {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Pixels = std::vector<std::uint8_t>;

constexpr int kSide = 64;

Pixels picture(std::uint8_t n) {
  Pixels pixels(static_cast<std::size_t>(kSide * kSide) * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(n + i / 4);
  return pixels;
}

// A display that shows what it is given, unless a test changes that.
struct FakeDisplay final : Output {
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override {
    if (takes) shown.assign(signal.pixels.begin(), signal.pixels.end());
    return std::optional(info.finished);
  }
  bool canReadBack() const override { return readable; }
  Result<std::vector<DisplayReading>> readBack() override {
    ++readings;
    if (!why_not.empty()) return Error{Errc::kIo, why_not};
    if (sets_mode) return std::vector<DisplayReading>();
    DisplayReading reading{where, {kind, digestOf({kSide, kSide, shown, std::size_t{kSide} * 4})}};
    return std::vector{reading};
  }
  void showAgain() override { ++times_mended; }

  bool takes = true, readable = true, sets_mode = false;
  FoundPicture::Kind kind = FoundPicture::Kind::kPixels;
  std::string why_not, where;
  Pixels shown = Pixels(static_cast<std::size_t>(kSide * kSide) * 4);
  int readings = 0, times_mended = 0;
};

class PictureChecksTest : public testing::Test {
 protected:
  PictureChecksTest() { make({seconds(5), seconds(5)}); }
  void make(const std::vector<Duration>& every) {
    std::vector<NamedOutput> outputs;
    displays_.clear();
    for (std::size_t i = 0; i < every.size(); ++i) {
      auto display = std::make_unique<FakeDisplay>();
      display->readable = readable_;
      displays_.push_back(display.get());
      outputs.push_back({"output", "fake", std::move(display)});
    }
    set_ = std::make_unique<OutputSet>(std::move(outputs));
    std::vector<PictureChecks::Checked> checked;
    for (std::size_t i = 0; i < every.size(); ++i) checked.push_back({&set_->output(i), every[i]});
    checks_ = std::make_unique<PictureChecks>(checked, clock_);
    set_->checkWith(checks_.get());
  }
  void present(std::uint8_t n) {
    const Pixels pixels = picture(n);
    for (std::size_t i = 0; i < set_->size(); ++i)
      set_->present(i, {kSide, kSide, pixels}, {.finished = clock_.now()}, std::nullopt);
  }
  // Performs every check that is due within this time.
  void pass(Duration time) {
    const Timestamp end = clock_.now() + time;
    for (auto due = checks_->step(); due && *due <= end; due = checks_->step()) {
      if (*due > clock_.now()) clock_.advance(*due - clock_.now());
    }
    clock_.advance(end - clock_.now());
  }
  PictureVerdict verdict(std::size_t i) const { return set_->picture(i).verdict; }
  std::string says(std::size_t i) const { return set_->picture(i).says; }

  bool readable_ = true;
  test::FakeClock clock_;
  std::vector<FakeDisplay*> displays_;
  std::unique_ptr<OutputSet> set_;
  std::unique_ptr<PictureChecks> checks_;
};

TEST_F(PictureChecksTest, EachIsReadOnceInItsTimeAndNotAtTheSameTime) {
  present(1);
  EXPECT_EQ(verdict(0), PictureVerdict::kUnchecked);
  pass(milliseconds(2499));
  EXPECT_EQ(displays_[0]->readings + displays_[1]->readings, 0);
  pass(milliseconds(1));
  EXPECT_EQ(displays_[0]->readings, 1);
  EXPECT_EQ(displays_[1]->readings, 0);
  pass(seconds(20));
  EXPECT_EQ(displays_[0]->readings, 5);
  EXPECT_EQ(displays_[1]->readings, 4);
  EXPECT_EQ(verdict(0), PictureVerdict::kRight);
  EXPECT_EQ(says(0), "");
  EXPECT_EQ(displays_[0]->times_mended, 0);
}

TEST_F(PictureChecksTest, ABlackDisplayIsFoundWithinSixSecondsAndMendedOnce) {
  present(1);
  pass(seconds(10));
  displays_[1]->where = "HDMI-A-2";
  displays_[1]->shown = Pixels(displays_[1]->shown.size());
  pass(seconds(6));
  EXPECT_EQ(verdict(0), PictureVerdict::kRight);
  EXPECT_EQ(verdict(1), PictureVerdict::kBlack);
  EXPECT_EQ(says(1), "is black instead of what was meant, at HDMI-A-2");
  EXPECT_EQ(displays_[1]->times_mended, 1);
  EXPECT_TRUE(set_->wantsFrame(1, Timestamp{})) << "although nothing moves";
  EXPECT_FALSE(set_->wantsFrame(0, Timestamp{}));
  present(1);
  EXPECT_FALSE(set_->wantsFrame(1, Timestamp{}));
  pass(milliseconds(1100));
  EXPECT_EQ(verdict(1), PictureVerdict::kRight) << "two readings, half a second apart";
  EXPECT_EQ(displays_[1]->times_mended, 1);
}

TEST_F(PictureChecksTest, WhatIsBeingMendedStaysWrongUntilItShowsSomething) {
  present(1);
  pass(seconds(10));
  displays_[0]->kind = FoundPicture::Kind::kOff;
  while (displays_[0]->times_mended == 0) pass(milliseconds(100));
  displays_[0]->sets_mode = true;
  pass(seconds(3));
  EXPECT_EQ(verdict(0), PictureVerdict::kBlack) << "its mode is set, which takes its time";
  displays_[0]->sets_mode = false;
  displays_[0]->kind = FoundPicture::Kind::kPixels;
  pass(milliseconds(1100));
  EXPECT_EQ(verdict(0), PictureVerdict::kRight);
  displays_[0]->kind = FoundPicture::Kind::kOff;
  while (displays_[0]->times_mended == 1) pass(milliseconds(100));
  displays_[0]->sets_mode = true;
  pass(seconds(6));
  EXPECT_EQ(verdict(0), PictureVerdict::kUnchecked) << "not for ever";
}

TEST_F(PictureChecksTest, OneBadReadingIsNoAlarm) {
  present(1);
  pass(seconds(10));
  const Pixels good = displays_[0]->shown;
  displays_[0]->shown = Pixels(good.size());
  const int before = displays_[0]->readings;
  while (displays_[0]->readings == before) pass(milliseconds(100));
  displays_[0]->shown = good;
  pass(seconds(10));
  EXPECT_EQ(verdict(0), PictureVerdict::kRight);
  EXPECT_EQ(displays_[0]->times_mended, 0);
}

TEST_F(PictureChecksTest, WhatCannotBeMendedIsTriedOnceInATime) {
  present(1);
  displays_[0]->kind = FoundPicture::Kind::kForeign;
  pass(seconds(22));
  EXPECT_EQ(verdict(0), PictureVerdict::kForeign);
  EXPECT_EQ(says(0), "shows a picture that is not the wall's");
  EXPECT_EQ(displays_[0]->times_mended, 4);
}

TEST_F(PictureChecksTest, ADisplayThatTakesNoMoreFramesIsFrozen) {
  present(1);
  pass(seconds(6));
  displays_[0]->takes = false;
  for (std::uint8_t n = 2; n < 100; ++n) {
    present(n);
    pass(milliseconds(100));
  }
  EXPECT_EQ(verdict(0), PictureVerdict::kFrozen);
  EXPECT_EQ(says(0), "stands still on an older frame");
  EXPECT_EQ(verdict(1), PictureVerdict::kRight) << "while everything moves";
}

TEST_F(PictureChecksTest, ABlackPictureThatIsMeantIsRight) {
  present(1);
  pass(seconds(10));
  const Pixels black(displays_[0]->shown.size());
  for (std::size_t i = 0; i < 2; ++i)
    set_->present(i, {kSide, kSide, black}, {.finished = clock_.now()}, std::nullopt);
  pass(seconds(20));
  EXPECT_EQ(verdict(0), PictureVerdict::kRight);
  EXPECT_EQ(displays_[0]->times_mended, 0);
}

TEST_F(PictureChecksTest, AnOutputThatCannotBeReadNowIsUnchecked) {
  present(1);
  pass(seconds(6));
  displays_[0]->why_not = "it is gone";
  pass(seconds(6));
  EXPECT_EQ(verdict(0), PictureVerdict::kUnchecked);
  EXPECT_EQ(verdict(1), PictureVerdict::kRight);
}

TEST_F(PictureChecksTest, ZeroSecondsIsNeverAndSoIsAnOutputThatCannotBeRead) {
  make({Duration::zero(), seconds(1)});
  present(1);
  pass(seconds(10));
  EXPECT_EQ(displays_[0]->readings, 0);
  EXPECT_EQ(displays_[1]->readings, 10);
  readable_ = false;
  make({seconds(1)});
  EXPECT_EQ(checks_->step(), std::nullopt);
}

TEST(PictureCheckSettingsTest, AnOutputThatCannotBeReadHasNoTime) {
  OutputSettings png{.kind = OutputKind::kPng, .path = "a.png"};
  EXPECT_TRUE(validate({png}, {}).empty());
  png.check_s = 1;
  const SettingFaults faults = validate({png}, {});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, "/0/check_s");
  EXPECT_EQ(faults[0].what, "is not a setting of kind png");
  OutputSettings shared;
  shared.check_s = 0;
  EXPECT_TRUE(validate({shared}, {}).empty());
}

TEST_F(PictureChecksTest, TheThreadFindsIt) {
  make({milliseconds(1)});
  present(1);
  SystemClock clock;
  PictureChecks checks({{displays_[0], milliseconds(1)}}, clock);
  checks.meant(0, {kSide, kSide, displays_[0]->shown});
  ThreadWatch watch;
  checks.start(watch);
  ASSERT_EQ(watch.threads().size(), 1U);
  EXPECT_TRUE(
      test::eventually([&checks] { return checks.state(0).verdict == PictureVerdict::kRight; }));
  checks.stop();
}

}  // namespace
}  // namespace merlin::render::out
