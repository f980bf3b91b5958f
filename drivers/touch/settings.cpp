#include "drivers/touch/settings.h"

#include <fmt/format.h>

namespace merlin {

SettingFaults validate(const TouchSettings&, const LineSettings& line) {
  const auto port = parsePort(line.port);
  const bool fits = !port || port->kind == PortKind::kEvdev || port->kind == PortKind::kPty ||
                    port->kind == PortKind::kReplay;
  if (line.driver != "touch" || fits) return {};
  return {
      {"/port", fmt::format("is \"{}\", which is not an input device; the driver \"touch\" needs "
                            "evdev:/dev/input/..., which `merlin devices` prints",
                            line.port)}};
}

}  // namespace merlin
