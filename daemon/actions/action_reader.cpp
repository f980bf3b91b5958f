#include "daemon/actions/action_reader.h"

#include <algorithm>
#include <iterator>

namespace merlin::actions {

Actions ActionReader::read(const shm::DeviceSlots& devices,
                           const std::array<bool, shm::kActionSources>& held_by) {
  Actions actions;
  for (std::size_t source = 0; source < shm::kActionSources; ++source) {
    const auto state = devices.actions[source]->read();
    if (!state) continue;
    auto& last = last_[source];
    const bool same = last && last->generation == state->generation;
    for (std::size_t i = 0; i < shm::kMostActions; ++i) {
      if (same) actions.begun_by[source][i] = state->begun[i] - last->begun[i];
      actions.begun[i] += actions.begun_by[source][i];
      actions.held[i] = actions.held[i] || (held_by[source] && state->held[i] != 0);
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
