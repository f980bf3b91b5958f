#include "daemon/shm/device_slots.h"

#include <optional>

#include <fmt/format.h>

namespace merlin::shm {
namespace {

// Looks up one slot after the other and keeps the first error.
class Finder {
 public:
  explicit Finder(const SlotTable& table) : table_(table) {}

  template <typename T>
  void find(const std::string& name, const Channel<T>*& slot) {
    keep(slot, table_.channel<T>(name));
  }
  template <typename T>
  void find(const std::string& name, const SeqSlot<T>*& slot) {
    keep(slot, table_.slot<T>(name));
  }
  const std::optional<Error>& error() const { return error_; }

 private:
  template <typename Slot>
  void keep(const Slot*& slot, const Result<const Slot*>& found) {
    if (found)
      slot = *found;
    else if (!error_)
      error_ = found.error();
  }

  const SlotTable& table_;
  std::optional<Error> error_;
};

}  // namespace

Result<DeviceSlots> DeviceSlots::find(const SlotTable& table, const Header& header) {
  DeviceSlots slots;
  slots.header = &header;
  Finder finder(table);
  for (const std::string& device : table.namesBefore(".health.state")) {
    if (device == "gpio") continue;
    finder.find(device + ".health", slots.health.emplace_back(Health{device, nullptr}).slot);
  }
  finder.find("glove.health", slots.glove_health);
  finder.find("tracker.health", slots.tracker_health);
  finder.find("ball.health", slots.ball_health);
  finder.find("glove", slots.glove);
  finder.find("posture", slots.posture);
  finder.find("posture_state", slots.posture_state);
  for (std::size_t i = 0; i < kStations; ++i)
    finder.find(fmt::format("tracker{}", i + 1), slots.tracker[i]);
  finder.find("tracker", slots.tracker_frames);
  finder.find("ball", slots.ball);
  finder.find("hand", slots.hand);
  for (std::size_t i = 0; i < kActionSources; ++i)
    finder.find(fmt::format("actions.{}", kActionSourceNames[i]), slots.actions[i]);
  if (finder.error()) return *finder.error();
  if (const auto gpio = table.channel<GpioSample>("gpio")) slots.gpio = *gpio;
  return slots;
}

Result<DeviceSlots> DeviceSlots::find(const DevicesSegment& segment) {
  const auto table = SlotTable::read(std::as_bytes(std::span(&segment, 1)), "of the devices");
  if (!table) return table.error();
  return find(*table, segment.header);
}

const char* healthName(const DeviceHealth& health, Timestamp now) {
  constexpr Duration kStale = std::chrono::seconds(1);
  if (health.state == HealthState::kOk && now - fromNanoseconds(health.updated_ns) > kStale)
    return "stale";
  switch (health.state) {
    case HealthState::kAbsent: return "absent";
    case HealthState::kOpening: return "opening";
    case HealthState::kOk: return "ok";
    case HealthState::kFailed: return "failed";
  }
  return "failed";
}

}  // namespace merlin::shm
