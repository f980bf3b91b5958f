// EndedThreads: finds threads that have ended though nobody stopped them. Such an end is reported
// as an event and as the health of a service; then the daemon has to end, so that systemd restarts
// it.
#pragma once

#include <optional>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/status/services.h"

namespace merlin::status {

// Thread-bound.
class EndedThreads {
 public:
  // `watch` and `services` must outlive this object.
  EndedThreads(const ThreadWatch& watch, Services& services) : watch_(watch), services_(services) {}

  // To be called several times a second. Reports an ended thread at once; half a second later, when
  // clients have received the report, returns the error with which the daemon must end. Otherwise
  // returns nothing.
  std::optional<Error> check(Timestamp now);

 private:
  const ThreadWatch& watch_;
  Services& services_;
  std::optional<Timestamp> seen_;
};

}  // namespace merlin::status
