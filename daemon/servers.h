// Servers: each role's sockets for status and commands, and the servers for other programs, which
// are restarted if they fail. Status and events report their health and their refused connections.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/status/server.h"

namespace merlin {

class Servers {
 public:
  // `host`: the role whose status and events include the servers for other programs. `watch` and
  // `clock` must outlive this object.
  Servers(std::string host, ThreadWatch& watch, const Clock& clock)
      : host_(std::move(host)), watch_(watch), clock_(clock) {}
  ~Servers();
  Servers(const Servers&) = delete;
  Servers& operator=(const Servers&) = delete;

  // Starts a role's own sockets and the servers for other machines that have an address:
  // settings.network publishes topics, settings.network_commands answers requests. To be called
  // from the main thread. Errors: those of StatusServer::start(). A server for other machines that
  // cannot start is not an error: tend() tries again.
  Result<Ok> startRole(const std::string& role, status::StatusServerSettings settings);
  // Adds a server for other programs and starts it. If it cannot start, or has ended, tend() tries
  // again. To be called from the main thread.
  void keep(const std::string& name, net::ServerKeeper::Start start);
  // Restarts servers; to be called about ten times a second from the main thread.
  void tend(Timestamp now);

  // Health of a role's servers, for its status. Thread-safe.
  std::vector<net::ServerHealth> health(const std::string& role) const;
  // Events since the last call for that role, one sentence each: connections that were refused or
  // closed, servers that failed or run again. Thread-safe.
  std::vector<Event> events(const std::string& role);

 private:
  struct Role {
    std::unique_ptr<status::StatusServer> server;
    // Number of refused and closed connections that events have reported, by name of the relay.
    std::map<std::string, std::uint64_t> reported_sent_away;
    Timestamp reported{};
  };

  std::string host_;
  ThreadWatch& watch_;
  const Clock& clock_;
  mutable std::mutex mutex_;  // guards roles_ and kept_, which the status threads read
  std::map<std::string, Role> roles_;
  std::vector<std::unique_ptr<net::ServerKeeper>> kept_;
};

}  // namespace merlin
