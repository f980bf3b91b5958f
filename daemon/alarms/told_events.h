// ToldEvents: decides which events are still to be reported. An event may arrive twice: when a role
// publishes it, and in the role's answer to the command `events`. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "daemon/alarms/alarm_queue.h"

namespace merlin::alarms {

// Returns the events in a role's answer to the command `events`, the oldest first, without
// malformed ones.
std::vector<AlarmEvent> eventsOf(const std::string& role, const std::string& answer);

// Thread-bound.
class ToldEvents {
 public:
  // Returns whether the event is to be reported; from then on it counts as reported. `works`: the
  // event says only that a device works. Such an event is reported only if the last reported event
  // of the device was a different one, since otherwise every start would report every device. The
  // sentence of a device's event begins with the device's name. O(kKept).
  bool take(const AlarmEvent& event, bool works);

  // Number of events that are remembered; a role answers with at most 50.
  static constexpr std::size_t kKept = 200;

 private:
  std::deque<std::string> last_;
  std::set<std::string> complained_;  // devices whose last reported event is not that they work
};

}  // namespace merlin::alarms
