// The tables that describe the segments to readers that do not include layout.h: name, type, offset
// and unit of every field. They are stored in the segments and printed by `merlin shm dump`.
#pragma once

#include <string>
#include <vector>

#include "daemon/shm/layout.h"

namespace merlin::shm {

std::vector<Field> devicesFields();
std::vector<Field> wallFields();

// The fields of one slot with the name `name` at `offset` in a segment, as the tables above have
// them: slotFields() of a SeqSlot<T>, channelFields() of a Channel<T>. T is a type that the
// devices' segment contains.
template <typename T>
std::vector<Field> slotFields(const std::string& name, std::size_t offset);
template <typename T>
std::vector<Field> channelFields(const std::string& name, std::size_t offset);

}  // namespace merlin::shm
