#include "daemon/actions/action_reader.h"

#include <algorithm>
#include <iterator>

namespace merlin::actions {

Actions ActionReader::read(const shm::DeviceSlots& devices, const std::vector<bool>* held_by) {
  Actions actions;
  const std::size_t sources = devices.actions.size();
  actions.begun_by.resize(sources);
  last_.resize(sources);
  for (std::size_t source = 0; source < sources; ++source) {
    const auto state = devices.actions[source].slot->read();
    if (!state) continue;
    const bool counts = !held_by || source >= held_by->size() || (*held_by)[source];
    auto& last = last_[source];
    const bool same = last && last->generation == state->generation;
    for (std::size_t i = 0; i < shm::kMostActions; ++i) {
      if (same) actions.begun_by[source][i] = state->begun[i] - last->begun[i];
      actions.begun[i] += actions.begun_by[source][i];
      actions.held[i] = actions.held[i] || (counts && state->held[i] != 0);
    }
    constexpr auto kKept = static_cast<std::uint32_t>(sizeof(shm::ActionState::recent));
    const std::uint32_t fresh = same ? std::min(state->sequence - last->sequence, kKept) : 0;
    for (std::uint32_t n = state->sequence - fresh; n != state->sequence; ++n)
      actions.in_order.push_back(state->recent[n % kKept]);
    last = *state;
  }
  return actions;
}

}  // namespace merlin::actions
