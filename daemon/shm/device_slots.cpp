#include "daemon/shm/device_slots.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace merlin::shm {
namespace {

// Looks up slots one after the other, and keeps the error of the first look-up that fails.
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
    if (device != "gpio")
      finder.find(device + ".health", slots.health.emplace_back(Health{device, {}}).slot);
  }
  // The kind of a device is recognised by a field that only the samples of this kind have.
  for (const std::string& name : table.namesBefore(".angle_rad")) {
    Glove& glove = slots.gloves.emplace_back(Glove{name, {}, {}, {}, {}});
    finder.find(name + ".health", glove.health);
    finder.find(name, glove.samples);
    finder.find(name + ".posture", glove.posture);
    finder.find(name + ".posture_state", glove.posture_state);
  }
  for (const std::string& name : table.namesBefore(".boresight_wxyz")) {
    Tracker& tracker = slots.trackers.emplace_back(Tracker{name, {}, {}, {}});
    finder.find(name + ".health", tracker.health);
    for (std::size_t i = 0; i < kStations; ++i)
      finder.find(fmt::format("{}{}", name, i + 1), tracker.stations[i]);
    finder.find(name, tracker.frames);
  }
  for (const std::string& name : table.namesBefore(".translation")) {
    Ball& ball = slots.balls.emplace_back(Ball{name, {}, {}});
    finder.find(name + ".health", ball.health);
    finder.find(name, ball.samples);
  }
  for (const std::string& name : table.namesBefore(".fingers")) {
    Touch& touch = slots.touches.emplace_back(Touch{name, {}, {}});
    finder.find(name + ".health", touch.health);
    finder.find(name, touch.samples);
  }
  for (const std::string& name : table.namesBefore(".joint_rad")) {
    Hand& hand = slots.hands.emplace_back(Hand{name, {}, {}});
    finder.find(name, hand.samples);
    finder.find(name + ".gesture", hand.gesture);
  }
  for (const std::string& name : table.namesBefore(".sequence")) {
    constexpr std::string_view kActions = "actions.";
    if (name.starts_with(kActions))
      finder.find(name, slots.actions.emplace_back(Actions{name.substr(kActions.size()), {}}).slot);
  }
  if (slots.actions.empty())  // every valid table has the panel's, so this look-up reports an error
    finder.find("actions.panel", slots.actions.emplace_back(Actions{"panel", {}}).slot);
  if (finder.error()) return *finder.error();
  if (const auto gpio = table.channel<GpioSample>("gpio")) slots.gpio = *gpio;
  return slots;
}

Result<DeviceSlots> DeviceSlots::find(const DevicesSegment& segment) {
  const auto table = SlotTable::read(std::as_bytes(std::span(&segment, 1)), "of the devices");
  if (!table) return table.error();
  return find(*table, segment.header);
}

namespace {

template <typename Slots>
const Slots* named(const std::vector<Slots>& all, std::string_view name) {
  if (name.empty()) return all.empty() ? nullptr : &all.front();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Slots& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

const DeviceSlots::Glove* DeviceSlots::glove(std::string_view name) const {
  return named(gloves, name);
}
const DeviceSlots::Tracker* DeviceSlots::tracker(std::string_view name) const {
  return named(trackers, name);
}
const DeviceSlots::Ball* DeviceSlots::ball(std::string_view name) const {
  return named(balls, name);
}
const DeviceSlots::Touch* DeviceSlots::touch(std::string_view name) const {
  return named(touches, name);
}
const DeviceSlots::Hand* DeviceSlots::hand(std::string_view name) const {
  return named(hands, name);
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
