#include "drivers/registry.h"

#include "drivers/cyberglove/device.h"
#include "drivers/evdev/device.h"
#include "drivers/fastrak/device.h"
#include "drivers/osc/device.h"
#include "drivers/sample/device.h"
#include "drivers/spaceball/device.h"
#include "drivers/spacenav/device.h"
#include "drivers/touch/device.h"
#include "drivers/tuio/device.h"
#include "drivers/vrpn/device.h"
#include "drivers/vrpn/pad_device.h"

namespace merlin {
namespace {

using DevicePtr = std::unique_ptr<Device>;

// The functions of a driver whose settings are the member kOwn of DriverSettings.
template <auto kOwn>
void describeOwn(DriverSettings& s, SettingsVisitor& visitor) {
  describe(s.*kOwn, visitor);
}

// Returns the faults with pointers relative to the device instead of the driver's own settings.
SettingFaults within(const std::string& driver, SettingFaults faults) {
  for (SettingFault& fault : faults) {
    fault.pointer = "/" + driver + fault.pointer;
    if (!fault.other.empty()) fault.other = "/" + driver + fault.other;
  }
  return faults;
}

// All drivers of merlind. A new driver needs only an entry here, its folder, and, if it has
// settings of its own, a member of DriverSettings. This is a table, not self-registration, because
// a linker drops unreferenced objects of a static library.
constexpr DriverEntry kDrivers[] = {
    {"cyberglove", SampleKind::kGlove, kCybergloveBaud,
     "CyberGlove with its interface unit, 18 or 22 sensors",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return cyberglove::makeDevice(s.cyberglove, c, k);
     },
     describeOwn<&DriverSettings::cyberglove>,
     [](const DriverSettings& s, const LineSettings& line) {
       return within("cyberglove", validate(s.cyberglove, line));
     }},
    {"fastrak", SampleKind::kTracker, kFastrakBaud, "Polhemus Fastrak, 1 to 4 receivers",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return fastrak::makeDevice(s.fastrak, c, k);
     },
     describeOwn<&DriverSettings::fastrak>, nullptr},
    {"vrpn", SampleKind::kTracker, 0, "tracker of a VRPN server, over the network",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return vrpn::makeDevice(s.vrpn, c, k);
     },
     describeOwn<&DriverSettings::vrpn>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.vrpn, line); },
     false, true,
     [](const DriverSettings& s, int station) {
       return s.vrpn.stations[static_cast<std::size_t>(station - 1)] >= 0;
     }},
    {"osc", SampleKind::kTracker, 0, "tracker whose poses come as OSC messages, over the network",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return osc::makeDevice(s.osc, c, k);
     },
     describeOwn<&DriverSettings::osc>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.osc, line); }, false,
     false,
     [](const DriverSettings& s, int station) {
       const auto index = static_cast<std::size_t>(station - 1);
       return index < s.osc.stations.size() && !s.osc.stations[index].empty();
     }},
    {"spaceball", SampleKind::kBall, kSpaceballBaud, "Spaceball 1003, 2003, 3003 or 4000 FLX",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return spaceball::makeDevice(s.spaceball, c, k);
     },
     describeOwn<&DriverSettings::spaceball>,
     [](const DriverSettings& s, const LineSettings&) {
       return within("spaceball", validate(s.spaceball));
     }},
    {"spacenav", SampleKind::kBall, 0, "space mouse, through spacenavd's socket",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return spacenav::makeDevice(s.spacenav, c, k);
     },
     describeOwn<&DriverSettings::spacenav>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.spacenav, line); }},
    {"evdev", SampleKind::kBall, 0, "gamepad, joystick, space mouse or clicker, through the kernel",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return evdev::makeDevice(s.evdev, c, k);
     },
     describeOwn<&DriverSettings::evdev>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.evdev, line); },
     true},
    {"vrpn_pad", SampleKind::kBall, 0,
     "button box, joystick or analogs of a VRPN server, over the network",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return vrpn::makeDevice(s.vrpn_pad, c, k);
     },
     describeOwn<&DriverSettings::vrpn_pad>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.vrpn_pad, line); },
     false, true},
    {"touch", SampleKind::kTouch, 0, "touch frame, touch screen or mouse, through the kernel",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return touch::makeDevice(s.touch, c, k);
     },
     describeOwn<&DriverSettings::touch>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.touch, line); },
     true},
    {"tuio", SampleKind::kTouch, 0, "touch surface of a TUIO 1.1 tracker, over the network",
     [](const DriverSettings& s, const Clock& c, SampleSink& k) -> DevicePtr {
       return tuio::makeDevice(s.tuio, c, k);
     },
     describeOwn<&DriverSettings::tuio>,
     [](const DriverSettings& s, const LineSettings& line) { return validate(s.tuio, line); }},
    {"sample", SampleKind::kBall, 9600, "template for new drivers: a ball that sends lines of text",
     [](const DriverSettings&, const Clock& c, SampleSink& k) -> DevicePtr {
       return sample::makeDevice(c, k);
     },
     nullptr, nullptr},
};

}  // namespace

std::span<const DriverEntry> drivers() { return kDrivers; }

const DriverEntry* findDriver(std::string_view name) {
  for (const DriverEntry& entry : kDrivers) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

const char* kindName(SampleKind kind) {
  constexpr const char* kNames[] = {"glove", "tracker", "ball", "touch"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace merlin
