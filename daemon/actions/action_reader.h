// ActionReader: reads from shared memory which actions have begun since its last read, and which
// are held.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/shm/device_slots.h"

namespace merlin::actions {

// State of all actions. The arrays are indexed like kActions (daemon/base/commands.h).
struct ActionCounts {
  // How often each action has begun since the last ActionReader::read().
  std::array<std::uint32_t, shm::kMostActions> begun{};
  std::array<bool, shm::kMostActions> held{};

  void add(const ActionCounts& other);
};

struct Actions {
  ActionCounts all;
  // The state by source, indexed like DeviceSlots::actions; `all` is the sum of these.
  std::vector<ActionCounts> by_source;
  // Indexes (into kActions) of the actions that have begun since the last read(): those of the
  // first source in the order in which they began, then those of the second source, and so on. At
  // most the last twelve of each source are listed.
  std::vector<std::size_t> in_order;
  // The part of in_order that belongs to each source, indexed like by_source.
  std::vector<std::vector<std::size_t>> in_order_by_source;
};

// Thread-bound; read() never waits. Use one ActionReader for each consumer.
class ActionReader {
 public:
  // Reads the state of the actions of all sources. Actions that began before the first read() are
  // not counted as begun, nor are those before the first read() after a restart of the daemon that
  // writes the state. Held actions are always reported.
  Actions read(const shm::DeviceSlots& devices);

 private:
  std::vector<std::optional<shm::ActionState>> last_;  // the last state read, by source
};

}  // namespace merlin::actions
