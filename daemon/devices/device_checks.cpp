#include "daemon/devices/device_checks.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "daemon/actions/input.h"
#include "daemon/base/did_you_mean.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/transcript.h"
#include "drivers/pjlink/password.h"
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

}  // namespace

void checkPostures(LoadedSettings& loaded) {
  const std::string& path = loaded.settings.devices.postures;
  if (path.empty()) return;
  const auto file = nn::loadNetwork(path);
  if (!file) return loaded.addFinding("/postures/file", "cannot be used: " + file.error().what);
  if (!loaded.lines.contains("/bindings")) return;
  const std::vector<std::string> names = namesOf(file->network.postures);
  const auto& bindings = loaded.settings.devices.bindings;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const std::string& input = bindings[i].input;
    const auto parsed = actions::parseInput(input);
    if (!parsed || parsed->kind != actions::Input::Kind::kPosture) continue;
    const std::string& name = parsed->posture;
    if (file->network.postures.code(name)) continue;
    const std::string near = nearestWord(name, names);
    loaded.addFinding(
        fmt::format("/bindings/{}/input", i),
        fmt::format("is \"{}\", which is not a posture of {}; {}it knows {}", input, path,
                    near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                    fmt::join(names, ", ")));
  }
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
