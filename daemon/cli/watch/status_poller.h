// StatusPoller: asks every role of a daemon for its status and its last events, once a second,
// without blocking.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/watch/watch_view.h"
#include "daemon/status/client.h"

namespace merlin::cli {

// Thread-bound. ZeroMQ runs a thread for each role.
class StatusPoller {
 public:
  explicit StatusPoller(DaemonAddress daemon);

  // Sends the requests that are due and processes the answers that have arrived; to be called at
  // least ten times a second. Returns whether `state` has changed. While no daemon runs or no role
  // answers, state.absent says why, and each second an entry without a value is added to the frame
  // times. Once a role answers again, also after a restart, the state is current again.
  bool poll(Timestamp now, WatchedState& state);

  static constexpr Duration kPeriod = std::chrono::seconds(1);

 private:
  struct Role {
    status::CommandAddress at{""};
    std::unique_ptr<status::CommandSender> sender;
    bool asked_events = false;  // whether the request in progress is for the events
    std::string status, events, fault;
  };

  void beginRound(Timestamp now);
  void findAgain();
  bool takeAnswer(Role& role, Timestamp now);
  bool isDone() const;
  void publish(WatchedState& state) const;

  DaemonAddress daemon_;
  std::map<std::string, Role> roles_;  // by endpoint
  std::string fault_;                  // why no role was found
  Timestamp next_{};
  bool waiting_ = false;  // not all answers of the current round have arrived
};

}  // namespace merlin::cli
