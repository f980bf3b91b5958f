// The process of `merlind --role alarms`: starts the programs of /alarms when something happens. It
// has no other role, so that it stays, and tells of it, when a merlind ends.
#pragma once

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin {

// Runs until SIGTERM or SIGINT; notifies systemd of its start and of progress. Events before its
// start are not told. REQUIRES: these signals and SIGHUP are blocked.
Result<Ok> runAlarms(const Settings& settings, Clock& clock);

}  // namespace merlin
