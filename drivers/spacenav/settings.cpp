#include "drivers/spacenav/settings.h"

#include <fmt/format.h>

namespace merlin {

SettingFaults validate(const SpacenavSettings& settings, const LineSettings& line) {
  SettingFaults faults = validateAxisMap(settings.axis_map);
  for (SettingFault& fault : faults) fault.pointer = "/spacenav" + fault.pointer;
  const auto port = parsePort(line.port);
  const bool fits = !port || port->kind == PortKind::kUnix || port->kind == PortKind::kPty ||
                    port->kind == PortKind::kReplay;
  if (line.driver == "spacenav" && !fits) {
    faults.push_back({"/port", fmt::format("is \"{}\", at which no spacenavd can be; the driver "
                                           "\"spacenav\" needs unix:PATH, usually "
                                           "unix:/run/spnav.sock",
                                           line.port)});
  }
  return faults;
}

}  // namespace merlin
