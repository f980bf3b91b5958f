#include "config/device_checks.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "config/devices.h"
#include "daemon/actions/input.h"
#include "daemon/base/printable_text.h"

namespace merlin {
namespace {

constexpr std::size_t kLongestName = 16;

// Names that no device or hand may have, because they are used otherwise in shared memory and in
// the names of inputs.
constexpr const char* kReserved[] = {"posture",
                                     "posture_state",
                                     "postures",
                                     "gesture",
                                     "gpio",
                                     "panel",
                                     "actions",
                                     "health",
                                     "key",
                                     "button",
                                     "axis",
                                     "switch",
                                     "pinch",
                                     "spread",
                                     "now_ns",
                                     "time_utc",
                                     HandSettings::kNoGlove};

std::string deviceAt(std::size_t index) { return fmt::format("/devices/{}", index); }
std::string handAt(std::size_t index) { return fmt::format("/hands/{}", index); }

bool isName(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && name[0] >= 'a' && name[0] <= 'z' &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
         });
}

// Returns whether the numbers of devices, of devices of each kind and of hands are allowed; adds a
// finding for each number that is too large.
bool checkNumbers(const DevicesSettings& d, LoadedSettings& loaded) {
  const auto check = [&](const char* at, const std::string& what, std::size_t n, std::size_t most) {
    if (n <= most) return true;
    loaded.addFinding(at, fmt::format("has {} {}; at most {} are allowed: leave out {}", n, what,
                                      most, n - most));
    return false;
  };
  std::map<SampleKind, std::size_t> number;
  for (const DeviceSettings& device : d.list) {
    if (const DriverEntry* const driver = findDriver(device.line.driver)) ++number[driver->kind];
  }
  bool good = check("/devices", "devices", d.list.size(), kMostDevices);
  for (const auto& [kind, most] : {std::pair{SampleKind::kGlove, kMostGloves},
                                   {SampleKind::kTracker, kMostTrackers},
                                   {SampleKind::kBall, kMostBalls},
                                   {SampleKind::kTouch, kMostTouches}})
    good = check("/devices", fmt::format("devices of the kind {}", kindName(kind)), number[kind],
                 most) &&
           good;
  return check("/hands", "hands", d.hands.size(), kMostHands) && good;
}

// Maps each name in use to its owner, as a text that continues the sentence "is NAME, ...", such as
// "the name of the hand at /hands/0".
using TakenNames = std::map<std::string, std::string>;

void takeName(const std::string& name, const std::string& at, const std::string& owner,
              TakenNames& taken, LoadedSettings& loaded) {
  if (!isName(name)) {
    return loaded.addFinding(at + "/name",
                             fmt::format("is \"{}\"; allowed are 1 to {} of a to z, 0 to 9 and _, "
                                         "beginning with a letter",
                                         excerpt(name), kLongestName));
  }
  const auto [first, fresh] = taken.emplace(name, owner);
  if (!fresh)
    loaded.addFinding(at + "/name",
                      fmt::format("is \"{}\", {}; give it another name", name, first->second));
}

// Adds the names of a tracker's stations in shared memory ("tracker1") to `taken`; adds a finding
// for each name that is in use already.
void takeStations(const std::string& name, const std::string& at, TakenNames& taken,
                  LoadedSettings& loaded) {
  for (std::size_t station = 1; station <= kStations; ++station) {
    const std::string own = name + std::to_string(station);
    const auto [first, fresh] =
        taken.emplace(own, fmt::format("the name of station {} of the tracker at {}", station, at));
    if (!fresh)
      loaded.addFinding(at + "/name", fmt::format("is \"{}\", so that its station {} would be "
                                                  "\"{}\", {}; give one of them another name",
                                                  name, station, own, first->second));
  }
}

void checkNames(const DevicesSettings& d, LoadedSettings& loaded) {
  TakenNames taken;
  for (const char* const name : kReserved)
    taken.emplace(name, "a name that merlind uses for something else");
  for (std::size_t i = 0; i < d.hands.size(); ++i)
    takeName(d.hands[i].name, handAt(i), fmt::format("the name of the hand at {}", handAt(i)),
             taken, loaded);
  for (std::size_t i = 0; i < d.list.size(); ++i) {
    if (!findDriver(d.list[i].line.driver) && d.list[i].name.empty()) continue;
    takeName(d.list[i].name, deviceAt(i), fmt::format("the name of the device at {}", deviceAt(i)),
             taken, loaded);
  }
  for (std::size_t i = 0; i < d.list.size(); ++i) {
    const DriverEntry* const driver = findDriver(d.list[i].line.driver);
    if (driver && driver->kind == SampleKind::kTracker)
      takeStations(d.list[i].name, deviceAt(i), taken, loaded);
  }
}

// Returns whether both devices may be read at the same port, because it is that of a server that
// accepts a connection from each of them.
bool shareServer(const DeviceSettings& a, const DeviceSettings& b, const PortAddress& port) {
  const auto shares = [](const DeviceSettings& device) {
    const DriverEntry* const driver = findDriver(device.line.driver);
    return driver && driver->shares_server;
  };
  return port.kind == PortKind::kTcp && shares(a) && shares(b);
}

// Adds a finding for each port that two devices share, because each driver would read only a part
// of the bytes. Different paths of one device file are detected in daemon/devices/device_checks,
// which may read files.
void checkPortsDiffer(const DevicesSettings& d, LoadedSettings& loaded) {
  std::vector<std::pair<PortAddress, std::size_t>> taken;
  for (std::size_t i = 0; i < d.list.size(); ++i) {
    auto port = parsePort(d.list[i].line.port);
    if (!port) continue;
    const auto same = std::ranges::find_if(taken, [&](const auto& other) {
      return sameLine(other.first, *port) && !shareServer(d.list[other.second], d.list[i], *port);
    });
    if (same == taken.end()) {
      taken.emplace_back(*std::move(port), i);
      continue;
    }
    const DeviceSettings& first = d.list[same->second];
    const bool alike = first.line.port == d.list[i].line.port;
    loaded.addFinding(
        deviceAt(i) + "/port",
        fmt::format("is \"{}\", which is the port of the device \"{}\" at {}{}; each device needs "
                    "its own",
                    d.list[i].line.port, first.name, deviceAt(same->second),
                    alike ? "" : fmt::format(", \"{}\"", first.line.port)));
  }
}

// Adds a finding if the device is to be read from merlind's own spnav socket, because merlind would
// read its own output.
void checkOwnSocket(const DeviceSettings& device, const std::string& at, LoadedSettings& loaded) {
  const std::string& own = loaded.settings.serve.spnav_socket;
  if (own.empty() || device.line.port != "unix:" + own) return;
  loaded.addFinding(at + "/port",
                    fmt::format("is \"unix:{0}\", the socket that merlind serves by "
                                "/serve/spnav_socket; spacenavd's own socket is needed here, and "
                                "another path there",
                                own));
}

// Adds a finding if the device is to be read from merlind's own VRPN server, because merlind would
// read its own output.
void checkOwnVrpn(const DeviceSettings& device, const std::string& at, LoadedSettings& loaded) {
  const auto port = parsePort(device.line.port);
  const bool of_vrpn = device.line.driver == "vrpn" || device.line.driver == "vrpn_pad";
  if (!of_vrpn || !port || !isOwnVrpnServer(*port, loaded.settings.serve)) return;
  loaded.addFinding(at + "/port",
                    fmt::format("is \"{}\", where merlind itself serves by /serve/vrpn_port; the "
                                "device's own server is needed here, and another number there",
                                device.line.port));
}

void checkDevice(const DeviceSettings& device, const std::string& at, LoadedSettings& loaded) {
  const DriverEntry* const driver = findDriver(device.line.driver);
  if (!driver) {
    if (!loaded.lines.contains(at + "/driver"))
      loaded.addFinding(at,
                        "has no driver: name one in \"driver\", such as cyberglove, fastrak, "
                        "spaceball or evdev");
    return;
  }
  addFaults(validate(device.line), at, loaded);
  if (driver->validate) addFaults(driver->validate(device.own, device.line), at, loaded);
  checkOwnSocket(device, at, loaded);
  checkOwnVrpn(device, at, loaded);
}

std::string namesOf(const DevicesSettings& d, SampleKind kind) {
  std::string names;
  for (const DeviceSettings& device : d.list) {
    const DriverEntry* const driver = findDriver(device.line.driver);
    if (driver && driver->kind == kind) names += (names.empty() ? "" : ", ") + device.name;
  }
  return names;
}

// Adds a finding if no device of the kind has the name `name`; an empty name is always valid. `at`:
// pointer of the setting that contains the name. On a wall that uses the devices of another
// machine, nothing is checked, because those devices are not in this configuration.
void checkNamed(const std::string& name, SampleKind kind, const std::string& at,
                LoadedSettings& loaded) {
  const Settings& s = loaded.settings;
  if (name.empty() || !s.wall.input.endpoint.empty() || findDevice(s.devices, kind, name)) return;
  const std::string there = namesOf(s.devices, kind);
  loaded.addFinding(
      at, fmt::format("is \"{}\", which is not the name of a {}; /devices has {}", excerpt(name),
                      kindName(kind),
                      there.empty() ? fmt::format("no {}: add one", kindName(kind)) : there));
}

SampleKind kindOf(const actions::Input& input) {
  if (input.kind == actions::Input::Kind::kButton) return SampleKind::kBall;
  return input.kind == actions::Input::Kind::kPinch ? SampleKind::kTouch : SampleKind::kGlove;
}

// Adds a finding if there is no hand of that name, or if its gestures are not recognised. `text`:
// the input, as the binding names it.
void checkGesture(const std::string& text, const std::string& hand, const std::string& at,
                  LoadedSettings& loaded) {
  const std::vector<HandSettings>& hands = loaded.settings.devices.hands;
  const auto found = std::ranges::find(hands, hand, &HandSettings::name);
  if (found == hands.end()) {
    std::string there;
    for (const HandSettings& h : hands) there += (there.empty() ? "" : ", ") + h.name;
    return loaded.addFinding(
        at, fmt::format("is \"{}\", and \"{}\" is not the name of a hand; /hands has {}",
                        excerpt(text), excerpt(hand),
                        there.empty() ? "no hand: leave the binding out, or add one" : there));
  }
  if (found->gestures) return;
  const std::string flag = handAt(static_cast<std::size_t>(found - hands.begin())) + "/gestures";
  loaded.addFinding(at, fmt::format("is \"{}\", and {} is false: set it to true, or leave the "
                                    "binding out",
                                    excerpt(text), flag));
}

// Adds a finding if no device with the name `name` has a driver that names keys. `text`: the input,
// as the binding names it.
void checkKey(const std::string& text, const std::string& name, const std::string& at,
              LoadedSettings& loaded) {
  std::string there, known;
  const auto add = [](std::string& list, const std::string& word) {
    list += (list.empty() ? "" : ", ") + word;
  };
  for (const DeviceSettings& device : loaded.settings.devices.list) {
    const DriverEntry* const driver = findDriver(device.line.driver);
    if (!driver || !driver->has_keys) continue;
    if (device.name == name) return;
    add(there, device.name);
  }
  for (const DriverEntry& driver : drivers()) {
    if (driver.has_keys) add(known, driver.name);
  }
  loaded.addFinding(
      at, fmt::format("is \"{}\", and \"{}\" is not the name of a device whose keys have names, "
                      "which are those of the drivers {}; /devices has {}",
                      excerpt(text), excerpt(name), known,
                      there.empty() ? "none: leave the binding out, or add one" : there));
}

// Adds a finding if the input names a device that does not exist or is of another kind. An input
// without a device is valid for any device. Texts that are not inputs are reported by the check of
// the bindings, not here.
void checkInputAt(const std::string& text, const std::string& at, LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  const auto input = actions::parseInput(text);
  if (!input || input->device.empty()) return;
  if (input->kind == actions::Input::Kind::kGesture)
    return checkGesture(text, input->device, at, loaded);
  if (input->kind == actions::Input::Kind::kKey) return checkKey(text, input->device, at, loaded);
  if (findDevice(d, kindOf(*input), input->device)) return;
  const bool touch = kindOf(*input) == SampleKind::kTouch;
  const char* const kind = touch ? "touch surface" : kindName(kindOf(*input));
  const std::string there = namesOf(d, kindOf(*input));
  loaded.addFinding(
      at, fmt::format("is \"{}\", and \"{}\" is not the name of a {}; /devices has {}",
                      excerpt(text), excerpt(input->device), kind,
                      there.empty() ? fmt::format("no {}: leave the binding out, or add one", kind)
                                    : there));
}

void checkInputs(LoadedSettings& loaded) {
  const std::vector<Binding>& bindings = loaded.settings.devices.bindings;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    checkInputAt(bindings[i].input, fmt::format("/bindings/{}/input", i), loaded);
    checkInputAt(bindings[i].with, fmt::format("/bindings/{}/with", i), loaded);
  }
}

// Returns the name of the tracker that `name` means: the first tracker if it is empty.
std::string trackerNamed(const DevicesSettings& d, const std::string& name) {
  const DeviceSettings* const first = findDevice(d, SampleKind::kTracker, name);
  return first ? first->name : name;
}

// Checks that the gloves of the hands exist, and that no glove is on two hands.
void checkGloves(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  std::map<const DeviceSettings*, std::size_t> worn;
  for (std::size_t i = 0; i < d.hands.size(); ++i) {
    if (!d.hands[i].wearsGlove()) continue;
    checkNamed(d.hands[i].glove, SampleKind::kGlove, handAt(i) + "/glove", loaded);
    const DeviceSettings* const glove = findDevice(d, SampleKind::kGlove, d.hands[i].glove);
    if (!glove) continue;
    const auto [first, fresh] = worn.emplace(glove, i);
    if (!fresh)
      loaded.addFinding(handAt(i) + "/glove",
                        fmt::format("is {}, the glove of the hand at {}; name another one, or "
                                    "\"none\" for a hand without a glove",
                                    glove->name, handAt(first->second)));
  }
}

// Checks that the devices in the hands' setting "buttons" exist, that no device is in two hands,
// and that device and hand belong to the same person.
void checkButtons(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  std::map<std::string, std::size_t> held;
  for (std::size_t i = 0; i < d.hands.size(); ++i) {
    const std::string& buttons = d.hands[i].buttons;
    if (buttons.empty()) continue;
    checkNamed(buttons, SampleKind::kBall, handAt(i) + "/buttons", loaded);
    const auto [first, fresh] = held.emplace(buttons, i);
    if (!fresh)
      loaded.addFinding(
          handAt(i) + "/buttons",
          fmt::format("is \"{}\", whose buttons the hand at {} holds; a device is in one hand",
                      excerpt(buttons), handAt(first->second)));
    // With different persons, the buttons would reserve the wall for one person, and the hand of
    // the other could not act.
    const DeviceSettings* const device = findDevice(d, SampleKind::kBall, buttons);
    if (device && device->person != d.hands[i].person)
      loaded.addFinding(
          handAt(i) + "/buttons",
          fmt::format("is \"{}\", whose \"person\" is \"{}\", and the hand's is \"{}\"; give both "
                      "the same",
                      excerpt(buttons), excerpt(device->person), excerpt(d.hands[i].person)));
  }
}

// Adds a finding if the tracker's driver never reports poses of this station, so that whatever
// wears it would never be seen.
void checkStationComes(const std::string& tracker, int station, const std::string& at,
                       LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  const DeviceSettings* const device = findDevice(d, SampleKind::kTracker, tracker);
  const DriverEntry* const driver = device ? findDriver(device->line.driver) : nullptr;
  const bool known = station >= 1 && station <= static_cast<int>(kStations);
  if (!driver || !driver->has_station || !known || driver->has_station(device->own, station))
    return;
  loaded.addFinding(
      at,
      fmt::format("is {}, and the tracker \"{}\" has no such station: name it in {}/{}/stations",
                  station, device->name, deviceAt(static_cast<std::size_t>(device - d.list.data())),
                  driver->name));
}

// Checks that the stations on the hands and on the head can report poses, and that no station is
// worn twice.
void checkStations(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  const auto& head = loaded.settings.wall.stereo.head;
  std::map<std::pair<std::string, int>, std::size_t> worn;
  for (std::size_t i = 0; i < d.hands.size(); ++i) {
    checkStationComes(d.hands[i].tracker, d.hands[i].station, handAt(i) + "/station", loaded);
    const auto [first, fresh] =
        worn.emplace(std::pair(trackerNamed(d, d.hands[i].tracker), d.hands[i].station), i);
    if (fresh) continue;
    loaded.addFinding(
        handAt(i) + "/station",
        fmt::format("is {}, the station of the hand {} too; each hand needs its own station",
                    d.hands[i].station, handAt(first->second)));
  }
  checkNamed(head.tracker, SampleKind::kTracker, "/wall/stereo/head/tracker", loaded);
  checkStationComes(head.tracker, head.station, "/wall/stereo/head/station", loaded);
  const auto found = worn.find({trackerNamed(d, head.tracker), head.station});
  if (head.station == 0 || found == worn.end()) return;
  loaded.addFinding(
      "/wall/stereo/head/station",
      fmt::format("is {}, the station of the hand {} too; the head needs its own station",
                  head.station, handAt(found->second)));
}

}  // namespace

bool isOwnVrpnServer(const PortAddress& port, const ServeSettings& serve) {
  const bool here = port.path == "localhost" || port.path == "::1" || port.path.starts_with("127.");
  return port.kind == PortKind::kTcp && here && port.service == std::to_string(serve.vrpn_port);
}

void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix) {
  for (const auto& [pointer, what, other] : faults) {
    const std::string at = group + other;
    const std::string before =
        other.empty() ? "" : fmt::format("conflicts with {} ({}): ", at, loaded.placeText(at));
    loaded.addFinding(group + pointer, fmt::format("{}{}{}", prefix, before, what));
  }
}

void checkDevices(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  if (!checkNumbers(d, loaded)) return;
  checkNames(d, loaded);
  checkPortsDiffer(d, loaded);
  for (std::size_t i = 0; i < d.list.size(); ++i) checkDevice(d.list[i], deviceAt(i), loaded);
  for (std::size_t i = 0; i < d.hands.size(); ++i) {
    checkNamed(d.hands[i].tracker, SampleKind::kTracker, handAt(i) + "/tracker", loaded);
  }
  checkGloves(loaded);
  checkButtons(loaded);
  checkInputs(loaded);
  checkStations(loaded);
}

}  // namespace merlin
