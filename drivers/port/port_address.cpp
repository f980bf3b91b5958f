#include "drivers/port/port_address.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/tcp_address.h"

namespace merlin {
namespace {

constexpr int kSpeeds[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
constexpr const char* kForms =
    "serial:/dev/..., pty:PATH, tcp://HOST:PORT, unix:PATH, evdev:/dev/input/... and replay:FILE";

constexpr std::string_view kEvdevDriver = "evdev";

}  // namespace

std::span<const int> lineSpeeds() { return kSpeeds; }

Result<PortAddress> parsePort(std::string_view text) {
  constexpr std::pair<std::string_view, PortKind> kPrefixes[] = {{"serial:", PortKind::kSerial},
                                                                 {"pty:", PortKind::kPty},
                                                                 {"unix:", PortKind::kUnix},
                                                                 {"evdev:", PortKind::kEvdev},
                                                                 {"replay:", PortKind::kReplay}};
  for (const auto& [prefix, kind] : kPrefixes) {
    if (text.starts_with(prefix) && text.size() > prefix.size())
      return PortAddress{kind, std::string(text.substr(prefix.size())), {}};
  }
  if (auto tcp = parseTcpAddress(text); tcp && tcp->host != "*")
    return PortAddress{PortKind::kTcp, std::move(tcp->host), std::move(tcp->port)};
  return Error{Errc::kInvalidArgument,
               fmt::format("\"{}\" is not a valid port; ports are {}", text, kForms)};
}

SettingFaults validate(const LineSettings& line) {
  SettingFaults faults;
  const auto port = parsePort(line.port);
  if (port && (port->kind == PortKind::kEvdev) && line.driver != kEvdevDriver) {
    faults.push_back({"/port", fmt::format("is \"{}\", an input device of the kernel, which the "
                                           "driver \"{}\" does not read; set \"driver\": \"{}\"",
                                           line.port, line.driver, kEvdevDriver)});
  }
  if (!line.port.empty() && !port) {
    faults.push_back({"/port", fmt::format("is \"{}\"; allowed are {}, or \"\" for no device",
                                           line.port, kForms)});
  }
  const bool known =
      std::find(std::begin(kSpeeds), std::end(kSpeeds), line.baud) != std::end(kSpeeds);
  if (line.baud != 0 && !known) {
    faults.push_back({"/baud", fmt::format("is {}; allowed are {}, and 0 for the driver's usual "
                                           "speed",
                                           line.baud, fmt::join(kSpeeds, ", "))});
  }
  return faults;
}

}  // namespace merlin
