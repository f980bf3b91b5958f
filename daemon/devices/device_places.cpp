#include "daemon/devices/device_places.h"

#include <array>
#include <cassert>

namespace merlin::devices {
namespace {

SampleKind kindOf(const DeviceSettings& device) {
  const DriverEntry* const driver = findDriver(device.line.driver);
  assert(driver);
  return driver->kind;
}

}  // namespace

std::vector<DevicePlace> devicePlaces(const DevicesSettings& settings) {
  std::vector<DevicePlace> places;
  std::array<std::size_t, 4> before{};
  for (const DeviceSettings& device : settings.list) {
    const SampleKind kind = kindOf(device);
    places.push_back({kind, before[static_cast<std::size_t>(kind)]++});
  }
  return places;
}

shm::SlotNames slotNames(const DevicesSettings& settings) {
  shm::SlotNames names;
  for (const DeviceSettings& device : settings.list)
    names.devices.push_back({device.name, kindOf(device)});
  for (const HandSettings& hand : settings.hands) names.hands.push_back(hand.name);
  return names;
}

std::optional<std::size_t> placeOf(const DevicesSettings& settings, SampleKind kind,
                                   std::string_view name) {
  std::size_t before = 0;
  for (const DeviceSettings& device : settings.list) {
    if (kindOf(device) != kind) continue;
    if (name.empty() || device.name == name) return before;
    ++before;
  }
  return std::nullopt;
}

}  // namespace merlin::devices
