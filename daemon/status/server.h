// StatusServer: one role's two ZeroMQ sockets. PUB publishes JSON documents by topic; REP answers
// commands.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/status/command.h"
#include "daemon/status/curve.h"
#include "daemon/status/relay.h"

namespace merlin::status {

// One topic that is published periodically.
struct Publication {
  std::string topic;  // "status", "metrics", "sample"
  Duration interval;
  std::function<std::string()> document;  // called in the server's thread
};

struct StatusServerSettings {
  std::string name;                               // the role, "wall", for reports and threads
  std::string status_endpoint, command_endpoint;  // "ipc://..."
  // Address at which the topics are also published, encrypted, for clients on other machines whose
  // keys are listed; no commands are accepted there.
  CurveServer network;
  std::string network_name, network_setting;  // of the relay for `network`: its name in reports,
                                              // and the JSON pointer of its setting
  // Address at which requests are answered, encrypted, from clients on other machines whose keys
  // are listed: all commands for clients that may command, only `status` and `events` for clients
  // that may read.
  CurveServer network_commands;
  std::vector<Publication> publications;
  std::vector<Command> commands;
  // Called at least ten times a second; the documents it returns are published under "event", in
  // order.
  std::function<std::vector<std::string>()> events;
};

// Requests: {"command": NAME, "argument": TEXT} (the argument only if the command needs one), one
// part, at most 4 KiB. Replies: {"ok": true, "result": ...} or {"ok": false, "error": "..."}.
// Besides its settings' commands the server knows `events`: a list of the last 50 documents that
// were published under "event", oldest first.
//
// Clients connect to relays (relay.h), which limit what each may use; libzmq's own sockets are
// behind them. The thread that publishes and answers only ends when it is stopped: an error in a
// round is logged, and the next round follows.
class StatusServer {
 public:
  // Errors, with the endpoint: kBusy (another program serves it), kIo. `watch` and `clock` must
  // outlive the server.
  static Result<std::unique_ptr<StatusServer>> start(StatusServerSettings settings,
                                                     ThreadWatch& watch, const Clock& clock);
  ~StatusServer();
  StatusServer(const StatusServer&) = delete;
  StatusServer& operator=(const StatusServer&) = delete;

  // Starts the relay at the encrypted address of `network`. It is separate because it may fail
  // alone (the port is in use) and be tried again. REQUIRES: that address is set. Errors: those of
  // Relay::start().
  Result<std::unique_ptr<net::Server>> startNetworkTopics(ThreadWatch& watch) const;
  // Starts the relay at the encrypted address of `network_commands`. REQUIRES: that address is set.
  // Errors: those of Relay::start().
  Result<std::unique_ptr<net::Server>> startNetworkCommands(ThreadWatch& watch) const;

  // Reports of the relays: counters of accepted and refused connections. Thread-safe.
  std::vector<net::ServerReport> reports() const;

 private:
  struct Sockets;
  StatusServer(StatusServerSettings settings, const Clock& clock);
  Result<Ok> openSockets();
  Result<Ok> startRelays(ThreadWatch& watch);
  RelaySettings topicsRelay() const;
  void run(const std::stop_token& stop, Progress& progress);
  void round();
  void bindAgainWhereGone();
  void publishDue();
  Duration untilDue() const;
  void admit();  // answers libzmq's authentication request: is the client's key listed?
  void answer();
  void answerNetwork();
  std::string answerFor(Grant grant, std::string_view request) const;

  StatusServerSettings settings_;
  const Clock& clock_;
  std::unique_ptr<Sockets> sockets_;
  Doors doors_;
  std::deque<std::string> last_events_, unsent_events_;
  std::vector<Timestamp> due_;
  Timestamp followed_from_;  // events are held back until then: followers subscribe first
  Timestamp checked_{};      // when the inner sockets' files were last checked
  Timestamp said_{};         // when an error was last logged
  std::vector<std::unique_ptr<Relay>> relays_;
  WatchedThread thread_;
};

}  // namespace merlin::status
