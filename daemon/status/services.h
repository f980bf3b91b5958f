// Services: how the servers of a daemon fare that it can do without: one that cannot start is said,
// and the wall runs.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::status {

// Thread-safe.
class Services {
 public:
  // `service`: a word, "samples". It works, or has failed for this reason. What changes is an
  // event.
  void ok(const std::string& service) { set(service, {}); }
  void failed(const std::string& service, const std::string& reason) { set(service, reason); }

  // What has changed since the last call, a sentence each.
  std::vector<std::string> takeEvents();

  // `document`, a JSON object, with the member "services" where there are any:
  // {"samples": {"health": "failed", "reason": "..."}}.
  std::string addTo(const std::string& document) const;

 private:
  struct Service {
    std::string name, reason;  // empty: it works
  };
  void set(const std::string& service, std::string reason);

  mutable std::mutex mutex_;
  std::vector<Service> services_;
  std::vector<std::string> events_;
};

}  // namespace merlin::status
