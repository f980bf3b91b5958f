// The process of `merlind --role alarms`: starts the programs of /alarms when something happens. It
// has no other role, so that it keeps running when another merlind ends, and can report that.
#pragma once

#include <functional>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/role_signals.h"

namespace merlin {

// Runs until it is asked to stop or to start again, as askedBySignal() says, and returns which of
// the two; notifies systemd of its start and its progress. Events before its start raise no alarm.
// REQUIRES: SIGTERM, SIGINT and SIGHUP are blocked.
Asked runAlarms(const Settings& settings, Clock& clock, const std::function<bool()>& is_valid);

}  // namespace merlin
