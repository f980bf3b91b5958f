// ServerKeeper: keeps a configured server running. If the server cannot start, or ends, the keeper
// tries to start it again every few seconds; the rest of the daemon continues.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/result.h"
#include "daemon/net/connection_server.h"

namespace merlin::net {

// Interface of a server that uses a ConnectionServer.
class Server {
 public:
  virtual ~Server() = default;
  virtual ServerReport report() const = 0;  // thread-safe
  // Why it has stopped serving; empty while it serves. Thread-safe.
  virtual std::string failure() const { return {}; }
};

// Health of a server, for the status.
struct ServerHealth {
  std::string name;     // "VRPN"
  std::string failure;  // why it does not serve; empty while it does
  ServerReport report;
};

// tend() and takeEvents() must be called from one thread each; health() is thread-safe.
class ServerKeeper {
 public:
  using Start = std::function<Result<std::unique_ptr<Server>>()>;

  // `name`: the server's name in events and the status.
  ServerKeeper(std::string name, Start start);

  // Starts the server if it does not run and a try is due; destroys it if it has stopped serving.
  // Cost: that of starting or destroying it.
  void tend(Timestamp now);

  ServerHealth health() const;

  // Returns the changes since the last call as events: that the server failed and why, that it runs
  // again, and, at most every five seconds, how many connections were refused or closed.
  std::vector<Event> takeEvents(Timestamp now);

 private:
  std::string name_;
  Start start_;
  mutable std::mutex mutex_;
  std::unique_ptr<Server> server_;  // guarded by mutex_, like everything below
  std::string failure_, told_failure_;
  bool told_ = false;  // whether its state has been reported yet
  Timestamp next_try_{}, told_at_{};
  std::uint64_t told_sent_away_ = 0;
};

// Returns a sentence about the connections that a server has refused or closed since the last call:
// "VRPN: 154 connections were refused or closed; the last: refused ...". `told`: their total number
// at the last call, which is updated. Returns an empty text if there are no new ones.
std::string sentAwaySentence(const ServerReport& report, std::uint64_t& told);

}  // namespace merlin::net
