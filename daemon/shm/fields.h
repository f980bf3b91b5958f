// The tables that describe the segments to readers that do not include layout.h: name, type, offset
// and unit of every field. They are stored in the segments and printed by `merlin shm dump`.
#pragma once

#include <vector>

#include "daemon/shm/layout.h"

namespace merlin::shm {

std::vector<Field> devicesFields();
std::vector<Field> wallFields();

}  // namespace merlin::shm
