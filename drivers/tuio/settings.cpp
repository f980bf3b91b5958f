#include "drivers/tuio/settings.h"

#include <fmt/format.h>

namespace merlin {

SettingFaults validate(const TuioSettings&, const LineSettings& line) {
  const auto port = parsePort(line.port);
  const bool fits = !port || port->kind == PortKind::kUdp || port->kind == PortKind::kPty ||
                    port->kind == PortKind::kReplay;
  if (line.driver != "tuio" || fits) return {};
  return {{"/port", fmt::format("is \"{}\", at which no TUIO arrives; the driver \"tuio\" needs "
                                "udp:PORT, usually udp:3333, or udp://ADDRESS:PORT",
                                line.port)}};
}

}  // namespace merlin
