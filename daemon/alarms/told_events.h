// ToldEvents: which events are still to be told, since one event may come twice: a role publishes
// it, and answers it when it is asked for its last events. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "daemon/alarms/alarm_queue.h"

namespace merlin::alarms {

// The events of a role's answer to the command `events`, the oldest first; what is malformed is
// left out.
std::vector<AlarmEvent> eventsOf(const std::string& role, const std::string& answer);

// Thread-bound.
class ToldEvents {
 public:
  // Whether the event is to be told; then it counts as told. `works`: it says of a device, whose
  // name begins the sentence, nothing but that it works: that is told only if something else was
  // told of the device before, since otherwise every start would tell of every device. O(kKept).
  bool take(const AlarmEvent& event, bool works);

  // So many of the last events are remembered: a role answers at most 50.
  static constexpr std::size_t kKept = 200;

 private:
  std::deque<std::string> last_;
  std::set<std::string> complained_;  // devices of which something else was told last
};

}  // namespace merlin::alarms
