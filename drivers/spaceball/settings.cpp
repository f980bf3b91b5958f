#include "drivers/spaceball/settings.h"

namespace merlin {

SettingFaults validate(const SpaceballSettings& ball) { return validateAxisMap(ball.axis_map); }

}  // namespace merlin
