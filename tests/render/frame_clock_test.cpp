#include "render/out/frame_clock.h"

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"

namespace merlin::render {
namespace {

using std::chrono::milliseconds;

class TimerFrameClockTest : public testing::Test {
 protected:
  test::FakeClock clock_;
  out::TimerFrameClock frames_{clock_};
};

TEST_F(TimerFrameClockTest, FramesBeginAPeriodApartAndEndWhereTheNextOneBegins) {
  const Timestamp from = clock_.now() + milliseconds(5);
  frames_.start(from, milliseconds(20));
  EXPECT_EQ(frames_.begin(0), from);
  EXPECT_EQ(frames_.begin(3), from + milliseconds(60));
  EXPECT_EQ(frames_.deadline(3), from + milliseconds(80));
  EXPECT_EQ(frames_.period(), milliseconds(20));
}

TEST_F(TimerFrameClockTest, TellsWhichFrameIsUnderWay) {
  const Timestamp from = clock_.now();
  frames_.start(from, milliseconds(20));
  EXPECT_EQ(frames_.frameAt(from - milliseconds(1)), -1);
  EXPECT_EQ(frames_.frameAt(from), 0);
  EXPECT_EQ(frames_.frameAt(from + milliseconds(20) - Duration(1)), 0);
  EXPECT_EQ(frames_.frameAt(from + milliseconds(20)), 1);
}

TEST_F(TimerFrameClockTest, WaitsForAFrameUntilItIsToStop) {
  frames_.start(clock_.now(), milliseconds(20));
  std::stop_source stop;
  EXPECT_TRUE(frames_.waitFor(2, stop.get_token()));
  EXPECT_EQ(clock_.now(), frames_.begin(2));
  stop.request_stop();
  EXPECT_FALSE(frames_.waitFor(3, stop.get_token()));
}

TEST_F(TimerFrameClockTest, StartsAnewWithAnotherPeriod) {
  frames_.start(clock_.now(), milliseconds(20));
  const Timestamp from = frames_.begin(7);
  frames_.start(from, milliseconds(40));
  EXPECT_EQ(frames_.begin(1), from + milliseconds(40));
}

class VblankFrameClockTest : public testing::Test {
 protected:
  static constexpr Duration kRefresh = std::chrono::microseconds(16683);  // 59.94 Hz
  // Waits for frames as the wall does, while the display's vertical blanks continue.
  void run(std::int64_t frames) {
    const std::stop_source stop;
    for (std::int64_t k = next_; k < next_ + frames; ++k) {
      if (vblank_) vblank_->last += (clock_.now() - vblank_->last) / kRefresh * kRefresh;
      ASSERT_TRUE(frames_.waitFor(k, stop.get_token()));
      EXPECT_EQ(frames_.frameAt(clock_.now()), k);
      EXPECT_EQ(frames_.deadline(k), frames_.begin(k + 1));
    }
    next_ += frames;
  }
  Duration sinceBlank() const { return (clock_.now() - vblank_->last) % kRefresh; }

  test::FakeClock clock_;
  std::optional<out::Vblank> vblank_;
  out::VblankFrameClock frames_{clock_, [this] { return vblank_; }};
  std::int64_t next_ = 0;
};

TEST_F(VblankFrameClockTest, IsATimerWithoutADisplay) {
  const Timestamp from = clock_.now() + std::chrono::milliseconds(3);
  frames_.start(from, std::chrono::milliseconds(20));
  run(100);
  EXPECT_EQ(clock_.now(), from + 99 * std::chrono::milliseconds(20));
  EXPECT_EQ(frames_.frameAt(from - Duration(1)), -1);
}

TEST_F(VblankFrameClockTest, FramesComeToBeginWithTheDisplaysBlanks) {
  vblank_ = out::Vblank{clock_.now() - std::chrono::milliseconds(7), kRefresh};
  frames_.start(clock_.now(), fromSeconds(1.0 / 60));
  run(1);
  EXPECT_NE(sinceBlank(), Duration::zero()) << "not at once";
  run(30);
  EXPECT_EQ(sinceBlank(), Duration::zero());
  EXPECT_EQ(frames_.period(), kRefresh);
  const Timestamp before = clock_.now();
  run(600);
  EXPECT_EQ(clock_.now() - before, 600 * kRefresh) << "and stay with them";
}

TEST_F(VblankFrameClockTest, HalfTheRateTakesEverySecondBlank) {
  vblank_ = out::Vblank{clock_.now() + std::chrono::milliseconds(5), kRefresh};
  frames_.start(clock_.now(), fromSeconds(1.0 / 30));
  run(40);
  EXPECT_EQ(sinceBlank(), Duration::zero());
  EXPECT_EQ(frames_.period(), 2 * kRefresh);
}

TEST_F(VblankFrameClockTest, AnotherRateOrASilentDisplayIsLeftAlone) {
  vblank_ = out::Vblank{clock_.now(), kRefresh};
  frames_.start(clock_.now(), fromSeconds(1.0 / 48));
  run(10);
  EXPECT_EQ(frames_.period(), fromSeconds(1.0 / 48));
  next_ = 0;
  frames_.start(clock_.now(), fromSeconds(1.0 / 60));
  vblank_.reset();
  run(10);
  EXPECT_EQ(frames_.period(), fromSeconds(1.0 / 60));
}

}  // namespace
}  // namespace merlin::render
