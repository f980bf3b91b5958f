#include "daemon/cli/live_samples.h"

#include <cstring>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "daemon/shm/fields.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::cli {
namespace {

TEST(LiveSamples, KnowsAStateThatIsBeingWrittenFromBefore) {
  const std::string instance = test::privateName("live");
  const auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(instance, "devices"), shm::devicesFields(test::defaultSlotNames()), 1,
      SystemClock().now(), {});
  ASSERT_TRUE(segment);
  auto samples = LiveSamples<BallSample>::open(instance, "ball", "ball");
  ASSERT_TRUE(samples);
  EXPECT_EQ(samples->complaint(), "its state is not known yet");
  auto& slot = (*segment)->health[test::kBall];
  DeviceHealth health{};
  health.state = HealthState::kOk;
  slot.publish(health);
  EXPECT_EQ(samples->complaint(), "");
  // An odd sequence number: the writer was interrupted in the middle of a write.
  const std::uint64_t odd = 3;
  std::memcpy(static_cast<void*>(&slot), &odd, sizeof odd);
  ASSERT_FALSE(slot.read());
  EXPECT_EQ(samples->complaint(), "");
}

}  // namespace
}  // namespace merlin::cli
