// StatusServer: one role's pair of ZeroMQ sockets. PUB: one JSON document a topic. REP: commands.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/status/curve.h"
#include "daemon/status/relay.h"

namespace merlin::status {

// One topic that is published by itself.
struct Publication {
  std::string topic;  // "status", "metrics", "sample"
  Duration interval;
  std::function<std::string()> document;  // thread: the server's
};

// A command's answer, JSON without the outer braces' "ok"; an Error becomes
// {"ok":false,"error":...}.
struct Command {
  std::string name, help;
  std::function<Result<std::string>()> run;  // thread: the server's; returns a JSON value
  // In place of `run`, of a command that wants the request's "argument", a text.
  std::function<Result<std::string>(const std::string& argument)> run_with = nullptr;
};

struct StatusServerSettings {
  std::string name;                               // of the role, "wall": for reports and threads
  std::string status_endpoint, command_endpoint;  // "ipc://..."
  // Where the same topics are published for other machines, encrypted, to those whose keys it
  // knows; commands are not taken from there.
  CurveServer network;
  std::vector<Publication> publications;
  std::vector<Command> commands;
  // Asked ten times a second; what it returns is published under "event", in order.
  std::function<std::vector<std::string>()> events;
};

// Requests: {"command": NAME, "argument": TEXT}, the latter only where a command wants one, one
// part, at most 4 KiB. Replies: {"ok": true, "result": ...} or {"ok": false, "error": "..."}.
//
// Clients connect to relays (relay.h), which bound what each may take; libzmq's own sockets lie
// behind them. The thread that publishes and answers ends on nothing but its stop: whatever goes
// wrong in a round is logged, and the next round goes on.
class StatusServer {
 public:
  // Errors: kBusy (another program serves the endpoint), kIo; they name the endpoint. `watch` and
  // `clock` outlive this.
  static Result<std::unique_ptr<StatusServer>> start(StatusServerSettings settings,
                                                     ThreadWatch& watch, const Clock& clock);
  ~StatusServer();
  StatusServer(const StatusServer&) = delete;
  StatusServer& operator=(const StatusServer&) = delete;

  // The relay at the encrypted address of `network`: it may fail where the others do not (a port
  // that is taken), and be tried again. REQUIRES: such an address is set. Errors: Relay::start()'s.
  Result<std::unique_ptr<net::Server>> startSamples(ThreadWatch& watch) const;

  // Of the relays: who was let in, and who was not. Thread-safe.
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
  void admit();  // answers ZeroMQ's question whether a client's key is known
  void answer();
  std::string reply(std::string_view request);

  StatusServerSettings settings_;
  const Clock& clock_;
  std::unique_ptr<Sockets> sockets_;
  std::vector<Timestamp> due_;
  Timestamp looked_{};  // whether the inner sockets' files are there
  Timestamp said_{};    // that something went wrong
  std::vector<std::unique_ptr<Relay>> relays_;
  WatchedThread thread_;
};

}  // namespace merlin::status
