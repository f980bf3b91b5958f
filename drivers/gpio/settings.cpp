#include "drivers/gpio/settings.h"

#include <set>

#include <fmt/format.h>

namespace merlin {

SettingFaults validate(const GpioSettings& g) {
  SettingFaults faults;
  std::set<int> seen;
  for (const int line : {g.projector_line, g.video_line, g.lamp_line, g.button_line}) {
    if (line >= 0 && !seen.insert(line).second)
      faults.push_back(
          {"", fmt::format("uses line {} twice; each line has only one purpose", line)});
  }
  return faults;
}

}  // namespace merlin
