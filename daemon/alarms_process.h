// The process of `merlind --role alarms`: starts the programs that the setting /alarms names when
// an event occurs. It has no other role, so that it keeps running when another merlind ends, and
// can report that.
#pragma once

#include <functional>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/role_signals.h"

namespace merlin {

// Runs the role until a signal asks it to stop or to start again (see askedBySignal()), and returns
// Asked::kStop or Asked::kStartAgain. Notifies systemd of its start and its progress. Events that a
// role published before this process started raise alarms only if that role itself started less
// than 10 minutes ago. REQUIRES: SIGTERM, SIGINT and SIGHUP are blocked.
Asked runAlarms(const Settings& settings, Clock& clock, const std::function<bool()>& is_valid);

}  // namespace merlin
