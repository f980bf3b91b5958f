#include "drivers/registry.h"

#include "drivers/cyberglove/device.h"
#include "drivers/evdev/device.h"
#include "drivers/fastrak/device.h"
#include "drivers/sample/device.h"
#include "drivers/spaceball/device.h"
#include "drivers/spacenav/device.h"
#include "drivers/vrpn/device.h"

namespace merlin {
namespace {

using DevicePtr = std::unique_ptr<Device>;

// All drivers of merlind. A new driver needs one row here and one folder beside this file. This is
// a table, not self-registration, because a linker drops unreferenced objects of a static library.
constexpr DriverEntry kDrivers[] = {
    {"cyberglove", SampleKind::kGlove, kCybergloveBaud,
     "CyberGlove with its interface unit, 18 or 22 sensors",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return cyberglove::makeDevice(s.cyberglove, c, k);
     }},
    {"fastrak", SampleKind::kTracker, kFastrakBaud, "Polhemus Fastrak, 1 to 4 receivers",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return fastrak::makeDevice(s.fastrak, c, k);
     }},
    {"vrpn", SampleKind::kTracker, 0, "tracker of a VRPN server, over the network",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return vrpn::makeDevice(s.vrpn, c, k);
     }},
    {"spaceball", SampleKind::kBall, kSpaceballBaud, "Spaceball 1003, 2003, 3003 or 4000 FLX",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return spaceball::makeDevice(s.spaceball, c, k);
     }},
    {"spacenav", SampleKind::kBall, 0, "space mouse, through spacenavd's socket",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return spacenav::makeDevice(s.spacenav, c, k);
     }},
    {"evdev", SampleKind::kBall, 0, "gamepad, joystick, space mouse or clicker, through the kernel",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return evdev::makeDevice(s.evdev, c, k);
     }},
    {"sample", SampleKind::kBall, 9600, "template for new drivers: a ball that sends lines of text",
     [](const DriverSettings&, const Clock& c, SampleSink& k) -> DevicePtr {
       return sample::makeDevice(c, k);
     }},
};

}  // namespace

std::span<const DriverEntry> drivers() { return kDrivers; }

const DriverEntry* findDriver(SampleKind kind, std::string_view name) {
  for (const DriverEntry& entry : kDrivers) {
    if (entry.kind == kind && entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace merlin
