#include "drivers/spacenav/settings.h"

namespace merlin {

SettingFaults validate(const SpacenavSettings& settings) {
  return validateAxisMap(settings.axis_map);
}

}  // namespace merlin
