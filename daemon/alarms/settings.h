// Settings of alarms: programs that `merlind --role alarms` starts when an event occurs.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin {

struct AlarmSettings {
  std::vector<std::string> run;  // a program, as an absolute path, and its arguments
  std::vector<std::string>
      kinds;                 // kinds of events that start the program (event_kinds.h); empty: all
  int most_per_hour = 12;    // maximum number of starts in an hour
  double time_limit_s = 30;  // the program is ended after this time
};

// Finds an alarm without a program, a program that is no absolute path, and kinds that no event
// has. Pointers: "/INDEX/run" ...
SettingFaults validate(const std::vector<AlarmSettings>& alarms);

}  // namespace merlin
