#include "render/out/frame_clock.h"

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"

namespace merlin::render {
namespace {

using std::chrono::milliseconds;

class TimerFrameClockTest : public testing::Test {
 protected:
  test::FakeClock clock_;
  TimerFrameClock frames_{clock_};
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

}  // namespace
}  // namespace merlin::render
