// EndedThreads: a thread that serves others ends on nothing but its stop. One that ended all the
// same is said, as an event and as the health of a service, and then the daemon has to end, so that
// systemd starts it again.
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
  // Both outlive this.
  EndedThreads(const ThreadWatch& watch, Services& services) : watch_(watch), services_(services) {}

  // To be called several times a second. Says at once which thread has ended; half a second later,
  // when whoever listens has heard it, the error that the daemon ends with.
  std::optional<Error> check(Timestamp now);

 private:
  const ThreadWatch& watch_;
  Services& services_;
  std::optional<Timestamp> seen_;
};

}  // namespace merlin::status
