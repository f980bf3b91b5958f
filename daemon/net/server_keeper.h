// ServerKeeper: a server that the configuration asks for, kept running: one that cannot start is
// tried again every few seconds, and so is one that ends; the rest of the daemon runs.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/net/connection_server.h"

namespace merlin::net {

// Anything that serves clients by a ConnectionServer.
class Server {
 public:
  virtual ~Server() = default;
  virtual ServerReport report() const = 0;  // thread-safe
  // Why it serves no more; empty while it does. Thread-safe.
  virtual std::string failure() const { return {}; }
};

// How a server is, for the status.
struct ServerHealth {
  std::string name;     // "VRPN"
  std::string failure;  // why it does not serve; empty: it does
  ServerReport report;
};

// tend() and takeEvents() are for one thread each; health() is thread-safe.
class ServerKeeper {
 public:
  using Start = std::function<Result<std::unique_ptr<Server>>()>;

  // `name` is what events and the status call it.
  ServerKeeper(std::string name, Start start);

  // Starts the server where none runs and a try is due; ends one that serves no more. Cost: that of
  // a start or an end.
  void tend(Timestamp now);

  ServerHealth health() const;

  // What has changed, as sentences: that it failed and why, that it serves again, and, at most
  // every five seconds, how many clients were sent away.
  std::vector<std::string> takeEvents(Timestamp now);

 private:
  std::string name_;
  Start start_;
  mutable std::mutex mutex_;
  std::unique_ptr<Server> server_;  // guarded by mutex_, as all below
  std::string failure_, told_failure_;
  bool told_ = false;  // how it is, once
  Timestamp next_try_{}, told_at_{};
  std::uint64_t told_sent_away_ = 0;
};

// The same sentence for any server: "VRPN: 154 connections were sent away in the last 5 s; the
// last: refused ..."; empty where there is none since `told`, which is brought up to date.
std::string sentAwaySentence(const ServerReport& report, std::uint64_t& told);

}  // namespace merlin::net
