// LocalDevices: the devices' segment of the shared memory, in memory of the test's process, with
// its table of fields and with its slots as a reader finds them.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "daemon/shm/device_slots.h"
#include "daemon/shm/fields.h"

namespace merlin::test {

// Indices of the default configuration's devices and of the control panel as sources of actions.
inline constexpr std::size_t kGlove = 0, kTracker = 1, kBall = 2, kPanel = shm::kPanelSource;

// The names and kinds of the default configuration's devices.
inline shm::SlotNames defaultSlotNames() {
  return {{{"glove", SampleKind::kGlove},
           {"tracker", SampleKind::kTracker},
           {"ball", SampleKind::kBall}},
          {"hand"}};
}

class LocalDevices {
 public:
  explicit LocalDevices(const shm::SlotNames& names = defaultSlotNames()) {
    shm::setFields(segment_->header, segment_->fields, shm::devicesFields(names));
    auto found = shm::DeviceSlots::find(*segment_);
    EXPECT_TRUE(found) << found.error().what;
    if (found) slots_ = *std::move(found);
  }
  shm::DevicesSegment& operator*() const { return *segment_; }
  shm::DevicesSegment* operator->() const { return segment_.get(); }
  const shm::DeviceSlots& slots() const { return slots_; }

 private:
  std::unique_ptr<shm::DevicesSegment> segment_ = std::make_unique<shm::DevicesSegment>();
  shm::DeviceSlots slots_;
};

}  // namespace merlin::test
