// The process of `merlind --role alarms`: starts the programs of /alarms when something happens. It
// has no other role, so that it stays, and tells of it, when a merlind ends.
#pragma once

#include <functional>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/role_signals.h"

namespace merlin {

// Runs until it is asked to stop or to start again, as askedBySignal() says, and returns which;
// notifies systemd of its start and of progress. Events before its start are not told. REQUIRES:
// SIGTERM, SIGINT and SIGHUP are blocked.
Asked runAlarms(const Settings& settings, Clock& clock, const std::function<bool()>& is_valid);

}  // namespace merlin
