#include "daemon/actions/action_reader.h"

#include <algorithm>
#include <iterator>

namespace merlin::actions {

void ActionCounts::add(const ActionCounts& other) {
  for (std::size_t i = 0; i < shm::kMostActions; ++i) {
    begun[i] += other.begun[i];
    held[i] = held[i] || other.held[i];
  }
}

Actions ActionReader::read(const shm::DeviceSlots& devices) {
  Actions actions;
  const std::size_t sources = devices.actions.size();
  actions.by_source.resize(sources);
  actions.in_order_by_source.resize(sources);
  last_.resize(sources);
  for (std::size_t source = 0; source < sources; ++source) {
    const auto state = devices.actions[source].slot->read();
    if (!state) continue;
    ActionCounts& counts = actions.by_source[source];
    auto& last = last_[source];
    const bool same = last && last->generation == state->generation;
    for (std::size_t i = 0; i < shm::kMostActions; ++i) {
      if (same) counts.begun[i] = state->begun[i] - last->begun[i];
      counts.held[i] = state->held[i] != 0;
    }
    actions.all.add(counts);
    constexpr auto kKept = static_cast<std::uint32_t>(sizeof(shm::ActionState::recent));
    const std::uint32_t fresh = same ? std::min(state->sequence - last->sequence, kKept) : 0;
    std::vector<std::size_t>& in_order = actions.in_order_by_source[source];
    for (std::uint32_t n = state->sequence - fresh; n != state->sequence; ++n)
      in_order.push_back(state->recent[n % kKept]);
    actions.in_order.insert(actions.in_order.end(), in_order.begin(), in_order.end());
    last = *state;
  }
  return actions;
}

}  // namespace merlin::actions
