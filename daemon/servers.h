// Servers: the sockets that each role of a daemon has for its status, and the servers for other
// programs, which are kept running. What they did is told in the status and as events.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/status/server.h"

namespace merlin {

class Servers {
 public:
  // `host`: the role whose status and events tell of the servers for other programs. `watch` and
  // `clock` outlive this.
  Servers(std::string host, ThreadWatch& watch, const Clock& clock)
      : host_(std::move(host)), watch_(watch), clock_(clock) {}
  ~Servers();
  Servers(const Servers&) = delete;
  Servers& operator=(const Servers&) = delete;

  // A role's own sockets, and the samples for other machines where `settings` asks for them. From
  // the main thread. Errors: StatusServer::start()'s.
  Result<Ok> startRole(const std::string& role, status::StatusServerSettings settings);
  // A server for other programs: from here on it is started again where it ends or cannot start.
  // From the main thread.
  void keep(const std::string& name, net::ServerKeeper::Start start);
  // Some ten times a second, from the main thread.
  void tend(Timestamp now);

  // What the status of a role says of its servers. Thread-safe.
  std::vector<net::ServerHealth> health(const std::string& role) const;
  // Who was sent away, and which server failed or works again, since the last call for that role; a
  // sentence each. Thread-safe.
  std::vector<std::string> events(const std::string& role);

 private:
  struct Role {
    std::unique_ptr<status::StatusServer> server;
    std::map<std::string, std::uint64_t> told_sent_away;  // by relay, when events told of it last
    Timestamp told{};
  };

  std::string host_;
  ThreadWatch& watch_;
  const Clock& clock_;
  mutable std::mutex mutex_;  // of the next two: status threads look at them
  std::map<std::string, Role> roles_;
  std::vector<std::unique_ptr<net::ServerKeeper>> kept_;
};

}  // namespace merlin
