// The tables that describe the segments to readers without a header: every field by name, type,
// offset and unit. Written into the segments, printed by `merlin shm dump`.
#pragma once

#include <vector>

#include "daemon/shm/layout.h"

namespace merlin::shm {

std::vector<Field> devicesFields();
std::vector<Field> wallFields();

}  // namespace merlin::shm
