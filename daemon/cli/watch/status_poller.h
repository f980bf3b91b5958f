// StatusPoller: asks every role of a daemon for its status and its last events, once a second, and
// never waits.
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

// Thread-bound. Uses a thread of ZeroMQ's for each role.
class StatusPoller {
 public:
  explicit StatusPoller(DaemonAddress daemon);

  // Sends what is due and takes the answers that have arrived; to be called at least ten times a
  // second. True if `state` has changed. While no daemon runs, or none of its roles answers,
  // state.absent says why, and a second without a frame time is added each second; once one answers
  // again, also after a restart, the state is the current one.
  bool poll(Timestamp now, WatchedState& state);

  static constexpr Duration kPeriod = std::chrono::seconds(1);

 private:
  struct Role {
    status::CommandAddress at{""};
    std::unique_ptr<status::CommandSender> sender;
    bool asked_events = false;  // what the outstanding request is for
    std::string status, events, fault;
  };

  void beginRound(Timestamp now);
  void findAgain();
  bool takeAnswer(Role& role, Timestamp now);
  bool isDone() const;
  void publish(WatchedState& state) const;

  DaemonAddress daemon_;
  std::map<std::string, Role> roles_;  // by their endpoints
  std::string fault_;                  // why there are no roles
  Timestamp next_{};
  bool waiting_ = false;  // a round has begun whose answers have not all arrived
};

}  // namespace merlin::cli
