#include "daemon/devices/device_checks.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

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
  if (!file) return loaded.addFinding("/devices/postures", "cannot be used: " + file.error().what);
  if (!loaded.lines.contains("/devices/bindings")) return;
  const std::vector<std::string> names = namesOf(file->network.postures);
  constexpr std::string_view kPosture = "posture.";
  const auto& bindings = loaded.settings.devices.bindings;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const std::string& input = bindings[i].input;
    if (!input.starts_with(kPosture) || input.size() == kPosture.size()) continue;
    const std::string name = input.substr(kPosture.size());
    if (file->network.postures.code(name)) continue;
    const std::string near = nearestWord(name, names);
    loaded.addFinding(
        fmt::format("/devices/bindings/{}/input", i),
        fmt::format("is \"{}\", which is not a posture of {}; {}it knows {}", input, path,
                    near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
                    fmt::join(names, ", ")));
  }
}

void checkPorts(LoadedSettings& loaded) {
  const DevicesSettings& d = loaded.settings.devices;
  const std::pair<const char*, const std::string&> ports[] = {
      {"glove", d.glove_line.port}, {"tracker", d.tracker_line.port}, {"ball", d.ball_line.port}};
  for (const auto& [device, port] : ports) {
    if (port.empty()) continue;
    const std::string at = fmt::format("/devices/{}/port", device);
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
    loaded.addFinding(fmt::format("/devices/projectors/{}/password_file", i),
                      "cannot be used: " + password.error().what);
  }
}

}  // namespace merlin::devices
