#include "daemon/devices/device_checks.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "daemon/actions/input.h"
#include "daemon/base/did_you_mean.h"
#include "drivers/io/evdev_stream.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/transcript.h"
#include "drivers/pjlink/password.h"
#include "nn/io/gesture_file.h"
#include "nn/io/network_file.h"

namespace merlin::devices {
namespace {

std::vector<std::string> namesOf(const nn::PostureTable& postures) {
  std::vector<std::string> names;
  for (std::uint32_t code = 0; code < nn::kCodes; ++code) {
    if (!postures.name(code).empty()) names.emplace_back(postures.name(code));
  }
  return names;
}

// The names that inputs of one kind may use.
struct KnownNames {
  const char* what;  // "posture"
  std::string file;
  std::vector<std::string> names;
};

// Calls each(pointer, input, name) for each input of this kind in the bindings of the configuration
// file, also for second inputs of chords. `pointer`: JSON pointer of the input; `input`: its text;
// `name`: the name of the posture, gesture or key in it.
template <typename Each>
void forBindings(const LoadedSettings& loaded, actions::Input::Kind kind, const Each& each) {
  if (!loaded.lines.contains("/bindings")) return;
  const auto& bindings = loaded.settings.devices.bindings;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    for (const auto& [text, key] :
         {std::pair{&bindings[i].input, "input"}, {&bindings[i].with, "with"}}) {
      const auto input = actions::parseInput(*text);
      if (input && input->kind == kind)
        each(fmt::format("/bindings/{}/{}", i, key), *text, input->name);
    }
  }
}

void checkNames(LoadedSettings& loaded, actions::Input::Kind kind, const KnownNames& known) {
  forBindings(
      loaded, kind, [&](const std::string& at, const std::string& input, const std::string& name) {
        if (std::ranges::find(known.names, name) != known.names.end()) return;
        const std::string near = nearestWord(name, known.names);
        loaded.addFinding(
            at,
            fmt::format("is \"{}\", which is not a {} of {}; {}it knows {}", input, known.what,
                        known.file, near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                        fmt::join(known.names, ", ")));
      });
}

void checkNoGestures(LoadedSettings& loaded) {
  forBindings(loaded, actions::Input::Kind::kGesture,
              [&](const std::string& at, const std::string& input, const std::string&) {
                loaded.addFinding(
                    at, fmt::format("is \"{}\", but no gesture is recognised: name a file of "
                                    "gestures in /gestures/file, such as the shipped "
                                    "gestures.json",
                                    input));
              });
}

constexpr std::string_view kButtonPrefix = "btn_";  // has the same length as "key_"

bool isButton(std::string_view key) { return key.starts_with(kButtonPrefix); }

// Returns the input that is most similar to the unknown key `name`, e.g. "button.south" for
// "btn_sout"; empty if none is similar.
std::string nearestKey(const std::string& name) {
  std::vector<std::string> names;
  for (std::uint16_t code = 0; code < io::kKeyCodes; ++code) {
    const std::string known = io::keyNameOf(code);
    if (!known.empty() && isButton(known) == isButton(name))
      names.push_back(known.substr(kButtonPrefix.size()));
  }
  const std::string near = nearestWord(name.substr(kButtonPrefix.size()), names);
  if (near.empty()) return near;
  return (isButton(name) ? "button." : "key.") + near;
}

// Returns the kernel's name of a key in lower case without KEY_ or BTN_, which is the form that an
// opened input device reports.
std::string shortKeyName(std::uint16_t code) {
  std::string name = io::keyRecord(code).text.data();
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

// Returns the name that the list "buttons" expects for another name of the same key ("btn_south",
// or "a" for BTN_A); for an unknown name, the most similar name; empty if there is none.
std::string nearestButton(const std::string& name, const std::vector<std::string>& names) {
  for (const char* const prefix : {"", "btn_", "key_"}) {
    if (const auto code = io::keyCode(prefix + name)) return shortKeyName(*code);
  }
  return nearestWord(name, names);
}

void checkButtons(LoadedSettings& loaded) {
  std::vector<std::string> names;
  for (std::uint16_t code = 0; code < io::kKeyCodes; ++code) names.push_back(shortKeyName(code));
  const auto& list = loaded.settings.devices.list;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::vector<std::string>& buttons = list[i].own.evdev.buttons;
    for (std::size_t k = 0; k < buttons.size(); ++k) {
      if (std::ranges::find(names, buttons[k]) != names.end()) continue;
      const std::string near = nearestButton(buttons[k], names);
      loaded.addFinding(
          fmt::format("/devices/{}/evdev/buttons/{}", i, k),
          fmt::format("is \"{}\", and the kernel knows no key of that name{}", buttons[k],
                      near.empty() ? "; `merlin devices` lists those of what is plugged in"
                                   : fmt::format("; did you mean \"{}\"?", near)));
    }
  }
}

// Returns the address with symbolic links resolved. The path of a device that is not present does
// not change; such a device is compared when it is opened.
PortAddress withoutLinks(PortAddress address) {
  if (!address.service.empty()) return address;
  std::error_code unreadable;
  const auto path = std::filesystem::weakly_canonical(address.path, unreadable);
  if (!unreadable) address.path = path.string();
  return address;
}

// Adds a finding for each port that names the same device as an earlier one in another way, e.g. by
// a link in by-id and by its number. The loader has already reported ports with equal text.
void checkLinks(LoadedSettings& loaded) {
  const auto& list = loaded.settings.devices.list;
  if (list.size() > kMostDevices) return;  // the loader has reported this
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto port = parsePort(list[i].line.port);
    for (std::size_t j = 0; port && j < i; ++j) {
      const auto other = parsePort(list[j].line.port);
      if (!other || sameLine(*port, *other)) continue;
      const PortAddress real = withoutLinks(*port);
      if (!sameLine(real, withoutLinks(*other))) continue;
      loaded.addFinding(
          fmt::format("/devices/{}/port", i),
          fmt::format("is \"{}\", which is {}, the port of the device \"{}\" at /devices/{}, "
                      "\"{}\"; each device needs its own",
                      list[i].line.port, real.path, list[j].name, j, list[j].line.port));
      break;
    }
  }
}

}  // namespace

void checkPostures(LoadedSettings& loaded) {
  const std::string& path = loaded.settings.devices.postures;
  if (path.empty()) return;
  const auto file = nn::loadNetwork(path);
  if (!file) return loaded.addFinding("/postures/file", "cannot be used: " + file.error().what);
  checkNames(loaded, actions::Input::Kind::kPosture,
             {"posture", path, namesOf(file->network.postures)});
}

void checkGestures(LoadedSettings& loaded) {
  const std::string& path = loaded.settings.devices.gestures;
  if (path.empty()) return checkNoGestures(loaded);
  const auto file = nn::loadGestures(path);
  if (!file) return loaded.addFinding("/gestures/file", "cannot be used: " + file.error().what);
  std::vector<std::string> names;
  for (const nn::TrainedGesture& gesture : file->model.gestures) names.push_back(gesture.name);
  checkNames(loaded, actions::Input::Kind::kGesture, {"gesture", path, std::move(names)});
}

void checkKeys(LoadedSettings& loaded) {
  checkButtons(loaded);
  forBindings(loaded, actions::Input::Kind::kKey,
              [&](const std::string& at, const std::string& input, const std::string& name) {
                if (io::keyCode(name)) return;
                const std::string near = nearestKey(name);
                loaded.addFinding(
                    at, fmt::format("is \"{}\", and the kernel knows no {} of that name{}", input,
                                    isButton(name) ? "button" : "key",
                                    near.empty() ? "; `merlin devices` lists those of what is "
                                                   "plugged in"
                                                 : fmt::format("; did you mean \"{}\"?", near)));
              });
}

void checkPorts(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  for (std::size_t i = 0; i < d.list.size(); ++i) {
    const std::string& port = d.list[i].line.port;
    if (port.empty()) continue;
    const std::string at = fmt::format("/devices/{}/port", i);
    const auto address = parsePort(port);
    if (!address) {
      loaded.addFinding(at, "cannot be used: " + address.error().what);
    } else if (address->kind == PortKind::kReplay) {
      const auto transcript = io::readTranscript(address->path);
      if (!transcript) loaded.addFinding(at, "cannot be used: " + transcript.error().what);
    }
  }
  checkLinks(loaded);
}

void checkPasswords(LoadedSettings& loaded) {
  const auto& projectors = loaded.settings.devices.projectors;
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const auto password = pjlink::readPassword(projectors[i].password_file);
    if (password) continue;
    loaded.addFinding(fmt::format("/projectors/{}/password_file", i),
                      "cannot be used: " + password.error().what);
  }
}

}  // namespace merlin::devices
