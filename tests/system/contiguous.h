// Expectations that a device of a running merlind has lost no sample, checked by the samples'
// counters in shared memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "daemon/shm/device_slots.h"

namespace merlin::test {

// Expects that, of the samples since number `from`, the newest 100 have consecutive counters.
template <typename T>
void expectContiguous(const shm::Channel<T>& channel, std::uint64_t from, const std::string& what) {
  const std::uint64_t to = channel.count();
  std::optional<std::uint32_t> last;
  for (std::uint64_t n = std::max(from, to > 100 ? to - 100 : 0); n < to; ++n) {
    const auto sample = channel.at(n);
    ASSERT_TRUE(sample) << what;
    EXPECT_TRUE(!last || sample->counter == *last + 1) << what;
    last = sample->counter;
  }
}

// Expects the same of the samples of a glove, of a ball, or of each station of a tracker.
inline void expectContiguous(const shm::DeviceSlots& devices, const std::string& device,
                             std::uint64_t from) {
  if (const auto* const glove = devices.glove(device))
    return expectContiguous(*glove->samples, from, device);
  if (const auto* const ball = devices.ball(device))
    return expectContiguous(*ball->samples, from, device);
  for (const auto* const station : devices.tracker(device)->stations)
    expectContiguous(*station, from, device);
}

}  // namespace merlin::test
