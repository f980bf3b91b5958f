// StatusServer: one role's pair of ZeroMQ sockets. PUB: one JSON document a topic. REP: commands.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/status/curve.h"

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
  std::string status_endpoint, command_endpoint;  // "ipc://..."
  // Where the same topics are published for other machines, encrypted, to those whose keys it
  // knows; commands are not taken from there.
  CurveServer network;
  std::vector<Publication> publications;
  std::vector<Command> commands;
  // Asked ten times a second; what it returns is published under "event", in order.
  std::function<std::vector<std::string>()> events;
};

// Owns its thread. Requests: {"command": NAME, "argument": TEXT}, the
// latter only where a command wants one; at most 4 KiB. Replies: {"ok": true, "result": ...}
// or {"ok": false, "error": "..."}. A socket file that a dead daemon left is replaced: the caller
// holds the role's shared memory, so no living daemon has it.
class StatusServer {
 public:
  // Errors: kIo, naming the endpoint.
  static Result<std::unique_ptr<StatusServer>> start(StatusServerSettings settings,
                                                     const Clock& clock);
  ~StatusServer();
  StatusServer(const StatusServer&) = delete;
  StatusServer& operator=(const StatusServer&) = delete;

  // Rounds of its loop, ten a second or more: for the watchdog. Thread-safe.
  std::uint64_t rounds() const noexcept { return rounds_.load(std::memory_order_relaxed); }

 private:
  struct Sockets;
  StatusServer(StatusServerSettings settings, const Clock& clock, std::unique_ptr<Sockets> sockets);
  void run(const std::stop_token& stop);
  void publishDue();
  Duration untilDue() const;
  void admit();  // answers ZeroMQ's question whether a client's key is known
  void answer();
  std::string reply(std::string_view request);

  StatusServerSettings settings_;
  const Clock& clock_;
  std::unique_ptr<Sockets> sockets_;
  std::vector<Timestamp> due_;
  std::atomic<std::uint64_t> rounds_{0};
  std::jthread thread_;
};

}  // namespace merlin::status
