#include "drivers/vrpn/server_checks.h"

#include <fmt/format.h>

namespace merlin::vrpn {
namespace {

constexpr std::size_t kLongestName = 99;  // VRPN's limit

bool canBeServer(PortKind kind) {
  return kind == PortKind::kTcp || kind == PortKind::kPty || kind == PortKind::kReplay;
}

}  // namespace

void checkPort(const LineSettings& line, const char* driver, SettingFaults& faults) {
  const auto port = parsePort(line.port);
  if (line.driver != driver || !port || canBeServer(port->kind)) return;
  faults.push_back({"/port", fmt::format("is \"{}\", at which no VRPN server can be; the driver "
                                         "\"{}\" needs tcp://HOST:PORT, usually port 3883",
                                         line.port, driver)});
}

void checkName(const std::string& name, const char* pointer, SettingFaults& faults) {
  const std::size_t at = name.find('@');
  if (at != std::string::npos) {
    faults.push_back({pointer, fmt::format("is \"{}\"; needed is the name alone, \"{}\": the host "
                                           "belongs in the port, tcp://HOST:3883",
                                           name, name.substr(0, at))});
  } else if (name.empty() || name.size() > kLongestName) {
    faults.push_back({pointer, fmt::format("has {} characters; allowed are 1 to {}", name.size(),
                                           kLongestName)});
  }
}

}  // namespace merlin::vrpn
