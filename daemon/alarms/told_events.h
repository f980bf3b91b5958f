// ToldEvents: decides which events are still to be told. One event may come twice: a role publishes
// it, and includes it in its answer when it is asked for its last events. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "daemon/alarms/alarm_queue.h"

namespace merlin::alarms {

// The events in a role's answer to the command `events`, the oldest first; malformed ones are left
// out.
std::vector<AlarmEvent> eventsOf(const std::string& role, const std::string& answer);

// Thread-bound.
class ToldEvents {
 public:
  // Returns whether the event is to be told; if so, it counts as told. `works`: the event only says
  // that a device works, whose name begins the sentence. It is told only if something else was told
  // of the device before, since otherwise every start would report every device. O(kKept).
  bool take(const AlarmEvent& event, bool works);

  // Number of events that are remembered; a role answers with at most 50.
  static constexpr std::size_t kKept = 200;

 private:
  std::deque<std::string> last_;
  std::set<std::string> complained_;  // devices of which something else was told last
};

}  // namespace merlin::alarms
