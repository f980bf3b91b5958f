// The faults that light the lamp of the control panel.
#include "daemon/devices/wall_fault.h"

#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"

namespace merlin::devices {
namespace {

using std::chrono::seconds;

shm::WallOutputs outputs() {
  shm::WallOutputs all{};
  all.count = 2;
  std::strcpy(all.outputs[0].name, "left");
  std::strcpy(all.outputs[1].name, "right");
  all.outputs[1].picture = 1;
  return all;
}

TEST(WallFault, IsAnOutputThatFailsOrShowsSomethingElse) {
  shm::WallOutputs all = outputs();
  EXPECT_EQ(faultAmong(all), "");
  all.outputs[1].picture = 2;
  std::strcpy(all.outputs[1].picture_fault, "Virtual-2 is black");
  EXPECT_EQ(faultAmong(all), "output right: Virtual-2 is black");
  all.outputs[0].failed = 1;
  std::strcpy(all.outputs[0].fault, "nothing is plugged in");
  EXPECT_EQ(faultAmong(all), "output left: nothing is plugged in");
  all.count = 0;
  EXPECT_EQ(faultAmong(all), "");
  all.count = 1000;  // as in a segment that somebody has overwritten
  EXPECT_NE(faultAmong(all), "");
}

TEST(WallFault, IsAWallThatIsGoneButNoneThatNeverRan) {
  test::FakeClock clock;
  const std::string instance = test::privateName("fault");
  WallFault fault(instance);
  std::optional<shm::SegmentWriter<shm::WallSegment>> wall;
  const auto pass = [&](Duration time) {
    clock.advance(time);
    if (wall) wall->writeHeartbeat(clock.now());
    return fault.look(clock.now());
  };
  EXPECT_EQ(pass(seconds(100)), "") << "there is none here";
  auto segment = shm::SegmentWriter<shm::WallSegment>::make(
      shm::segmentName(instance, "wall"), shm::wallFields(), shm::newGeneration(), clock.now(), {});
  ASSERT_TRUE(segment) << segment.error().what;
  wall.emplace(*std::move(segment));
  EXPECT_EQ(pass(seconds(1)), "") << "it says nothing yet";
  shm::WallOutputs all = outputs();
  all.outputs[0].failed = 1;
  std::strcpy(all.outputs[0].fault, "no card");
  (*wall)->outputs.publish(all);
  EXPECT_EQ(pass(seconds(1)), "output left: no card");
  wall.reset();
  EXPECT_EQ(pass(seconds(1)), "") << "it may be restarted";
  EXPECT_EQ(pass(seconds(14)), "the role wall has not run for 15 s");
}

}  // namespace
}  // namespace merlin::devices
