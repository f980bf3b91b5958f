// ActionReader: reads from shared memory which actions have begun since the last read, and which
// are held.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/shm/device_slots.h"

namespace merlin::actions {

// State of actions, indexed like kActions (daemon/base/commands.h).
struct ActionCounts {
  // How often each action has begun since the last read().
  std::array<std::uint32_t, shm::kMostActions> begun{};
  std::array<bool, shm::kMostActions> held{};

  void add(const ActionCounts& other);
};

struct Actions {
  ActionCounts all;
  // The summands of `all`, indexed like DeviceSlots::actions.
  std::vector<ActionCounts> by_source;
  // The actions that have begun, source by source, in the order in which they began; at most the
  // last twelve of each source.
  std::vector<std::size_t> in_order;
  // The parts of in_order, by source.
  std::vector<std::vector<std::size_t>> in_order_by_source;
};

// Thread-bound. Never waits.
class ActionReader {
 public:
  // Actions that began before the first read, or before the first one after a restart of the daemon
  // that counts them, are not reported.
  Actions read(const shm::DeviceSlots& devices);

 private:
  std::vector<std::optional<shm::ActionState>> last_;  // by source
};

}  // namespace merlin::actions
