// The process of `merlind --role page`: serves the operator's web page. It has no other role, so
// that it keeps running while the wall is restarted, and a fault in one cannot stop the other.
#pragma once

#include <functional>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/role_signals.h"

namespace merlin {

// Runs the role until a signal asks it to stop or to start again (see askedBySignal()), and returns
// Asked::kStop or Asked::kStartAgain. Notifies systemd of its start and its progress. A port that
// is in use is no error: the server is started again every five seconds until it succeeds. If the
// page and the metrics are switched off, it only waits for a signal. REQUIRES: SIGTERM, SIGINT and
// SIGHUP are blocked; no thread has been started. Errors: kBusy (another process serves the page of
// this instance), kIo (the run directory or the token's file), a thread has ended unexpectedly.
Result<Asked> runPage(Settings settings, Clock& clock, const std::function<bool()>& is_valid);

}  // namespace merlin
