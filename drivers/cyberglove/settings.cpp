#include "drivers/cyberglove/settings.h"

#include <cmath>

#include <fmt/format.h>

namespace merlin {

// A byte takes 10 bits on the line (8N1); the longest record has 22 sensors.
SettingFaults validate(const CybergloveSettings& glove, const LineSettings& line) {
  const bool text = glove.dialogue == CybergloveSettings::Dialogue::kText;
  const int stamp = glove.time_stamps ? (text ? 11 : 5) : 0;
  const int bytes = (text ? 96 : 25) + stamp;
  const double most = line.baud / 10.0 / bytes;
  const auto address = parsePort(line.port);
  if (!address || !address->hasSpeed() || glove.rate_hz <= most) return {};
  return {{"/rate_hz",
           fmt::format("is {:g}, but a line of {} baud carries {:.0f} records of {} bytes per "
                       "second: lower the rate or raise the speed",
                       glove.rate_hz, line.baud, std::floor(most), bytes)}};
}

}  // namespace merlin
