// Services: health of the servers and outputs that the daemon can run without; a failure is
// reported, and the daemon continues.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"

namespace merlin::status {

// Thread-safe.
class Services {
 public:
  // Set the state of a service. `service`: its name, such as "samples". A change becomes an event.
  void ok(const std::string& service) { set(service, {}); }
  void failed(const std::string& service, const std::string& reason) { set(service, reason); }

  // Returns an event for each change since the last call.
  std::vector<Event> takeEvents();

  // Returns `document`, a JSON object, with the member "services" added if there are any:
  // {"samples": {"health": "failed", "reason": "..."}}.
  std::string addTo(const std::string& document) const;

 private:
  struct Service {
    std::string name, reason;  // reason: why it failed; empty: it works
  };
  void set(const std::string& service, std::string reason);

  mutable std::mutex mutex_;
  std::vector<Service> services_;
  std::vector<Event> events_;
};

}  // namespace merlin::status
