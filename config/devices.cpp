#include "config/devices.h"

namespace merlin {

void completeDevices(std::vector<DeviceSettings>& devices) {
  for (DeviceSettings& device : devices) {
    const DriverEntry* const driver = findDriver(device.line.driver);
    if (!driver) continue;
    if (device.name.empty()) device.name = kindName(driver->kind);
    if (device.line.baud == 0) device.line.baud = driver->baud > 0 ? driver->baud : kUsualBaud;
  }
}

std::vector<DeviceSettings> defaultDevices() {
  std::vector<DeviceSettings> devices;
  for (const char* const driver : {"cyberglove", "fastrak", "spaceball"}) {
    DeviceSettings device;
    device.line.driver = driver;
    devices.push_back(std::move(device));
  }
  completeDevices(devices);
  return devices;
}

const DeviceSettings* findDevice(const DevicesSettings& devices, SampleKind kind,
                                 const std::string& name) {
  for (const DeviceSettings& device : devices.list) {
    const DriverEntry* const driver = findDriver(device.line.driver);
    if (driver && driver->kind == kind && (name.empty() || device.name == name)) return &device;
  }
  return nullptr;
}

}  // namespace merlin
