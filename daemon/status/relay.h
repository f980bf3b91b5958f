// Relay: accepts clients at a public address and connects them to a ZeroMQ socket behind it.
//
// libzmq accepts connections by itself, without a limit on their number or memory; the relay
// applies these limits before libzmq (README.md, "Why a relay"). libzmq's own socket is bound to an
// inner address that only the daemon's user may open.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/status/zmtp_guard.h"

namespace merlin::status {

struct RelaySettings {
  std::string name;      // for reports: "status of the wall"
  std::string endpoint;  // public: "ipc://PATH" or "tcp://ADDRESS:PORT"; ADDRESS: IPv4 or '*'
  std::string inner;     // path of the local socket to which libzmq is bound
  net::ServerLimits limits;
  ZmtpLimits zmtp;
};

// Owns its thread.
class Relay final : public net::Server {
 public:
  // Errors: those of listenLocal() and listenTcp(); kInvalidArgument (an invalid endpoint).
  static Result<std::unique_ptr<Relay>> start(RelaySettings settings, ThreadWatch& watch,
                                              const Clock& clock);
  ~Relay() override;  // removes its socket's file
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  // Thread-safe.
  net::ServerReport report() const override { return server_.report(); }
  const std::string& endpoint() const noexcept { return settings_.endpoint; }

 private:
  Relay(RelaySettings settings, const Clock& clock);
  Result<Ok> listen();
  void run(const std::stop_token& stop, Progress& progress);
  void listenAgainWhereGone();
  std::string path() const;  // path of a local public address; empty for TCP
  bool isThere() const;      // whether the file at path() is the socket that listens

  RelaySettings settings_;
  const Clock& clock_;
  net::ConnectionServer server_;
  std::uint64_t file_ = 0;  // inode of the public socket's file; 0: it does not listen
  Timestamp checked_{};     // when the file was last checked
  std::string failure_;     // why the file could not be created again; empty: no failure
  WatchedThread thread_;
};

}  // namespace merlin::status
