// The sentences that report what the wall has reduced for lack of time.
#include "daemon/status/wall_events.h"

#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/told.h"

namespace merlin::status {
namespace {

using test::Sentences;
using test::told;

class WallEventsTest : public testing::Test {
 protected:
  Sentences after(const shm::WallStats& stats) {
    segment_->stats.publish(stats);
    return told(events_.take());
  }
  std::unique_ptr<shm::WallSegment> segment_ = std::make_unique<shm::WallSegment>();
  WallEvents events_{*segment_};
  shm::WallStats stats_ = [] {
    shm::WallStats s{};
    s.rate_asked_hz = s.rate_now_hz = 30;
    s.rate_divisor = s.scale_divisor = 1;
    return s;
  }();
};

TEST_F(WallEventsTest, TellEachStepDownAndUpOnce) {
  EXPECT_EQ(told(events_.take()), Sentences{});
  EXPECT_EQ(after(stats_), Sentences{});
  stats_.operator_coarser = 1;
  EXPECT_EQ(after(stats_), Sentences{"the operator's view is coarser: there is too little time"});
  EXPECT_EQ(after(stats_), Sentences{});
  stats_.scale_divisor = 2;
  EXPECT_EQ(after(stats_), Sentences{"tiles at half size while moving: even the coarsest level of "
                                     "detail takes too long"});
  stats_.rate_divisor = 2;
  EXPECT_EQ(
      after(stats_),
      Sentences{"frame rate reduced to 15 of 30 Hz: even the coarsest level of detail takes too "
                "long"});
  stats_.rate_divisor = 1;
  stats_.operator_coarser = 0;
  EXPECT_EQ(after(stats_), (Sentences{"the operator's view is as fine as the wall again",
                                      "frame rate raised to 30 of 30 Hz: the coarsest level of "
                                      "detail is fast enough"}));
}

TEST_F(WallEventsTest, TellWhatIsSetByHand) {
  after(stats_);
  stats_.held_cost = 5000;
  std::strcpy(stats_.cost_unit, "triangles");
  stats_.rate_asked_hz = 20;
  EXPECT_EQ(after(stats_), (Sentences{"5000 triangles while moving, set by hand",
                                      "the desired frame rate is 20 Hz now"}));
  stats_.held_cost = 0;
  EXPECT_EQ(after(stats_), Sentences{"detail chosen by the governor again"});
}

TEST_F(WallEventsTest, AnOutputThatFailsIsAFaultAndItsReturnIsNone) {
  shm::WallOutputs outputs{};
  outputs.count = 1;
  std::strcpy(outputs.outputs[0].name, "png");
  std::strcpy(outputs.outputs[0].fault, "no space left");
  segment_->outputs.publish(outputs);
  EXPECT_EQ(after(stats_), Sentences{"fault: output png failed: no space left"});
  outputs.outputs[0].fault[0] = '\0';
  segment_->outputs.publish(outputs);
  EXPECT_EQ(after(stats_), Sentences{"output png works again"});
}

TEST_F(WallEventsTest, TellOnceWhatAnOutputWasFoundToShow) {
  shm::WallOutputs outputs{};
  outputs.count = 2;
  std::strcpy(outputs.outputs[1].name, "left");
  const auto finds = [&](std::uint32_t picture, const char* fault) {
    outputs.outputs[1].picture = picture;
    std::strcpy(outputs.outputs[1].picture_fault, fault);
    segment_->outputs.publish(outputs);
    return told(events_.takePictures());
  };
  EXPECT_EQ(told(events_.takePictures()), Sentences{});
  EXPECT_EQ(finds(1, ""), Sentences{});
  EXPECT_EQ(finds(2, "is black instead of what was meant, at A-1"),
            Sentences{"fault: output left is black instead of what was meant, at A-1"});
  EXPECT_EQ(finds(2, "is black instead of what was meant, at A-1"), Sentences{});
  EXPECT_EQ(finds(3, "stands still on an older frame"),
            Sentences{"fault: output left stands still on an older frame"});
  EXPECT_EQ(finds(1, ""), Sentences{"output left shows what was meant again"});
  finds(2, "is black");
  EXPECT_EQ(finds(0, ""), Sentences{"fault: output left shows no picture that could be read back"});
  EXPECT_EQ(told(events_.take()), Sentences{}) << "these are events of their own";
}

}  // namespace
}  // namespace merlin::status
