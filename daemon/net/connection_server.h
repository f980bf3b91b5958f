// ConnectionServer: the connections of one server, with limits on all resources that a client uses.
//
// Every server of merlind that untrusted clients can reach uses this class. It accepts connections,
// assigns places (admission.h), closes clients that do not complete the handshake in time, and
// limits the buffered input and output of each client and its messages per round and per second.
// The protocol is a Session. So no client can use memory, descriptors, time or places beyond these
// limits, whatever it sends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/token_bucket.h"
#include "daemon/base/unique_fd.h"
#include "daemon/net/admission.h"

struct pollfd;

namespace merlin::net {

struct ServerLimits {
  Places places;
  Duration opening = std::chrono::seconds(2);  // maximum duration of a client's handshake
  std::size_t input_bytes = 8192;              // buffered input; a longer message closes the client
  std::size_t output_bytes = 65536;            // buffered output; more closes the client
  std::size_t messages_per_round = 16;         // from one client, before the next client's turn
  double messages_per_s = 500, messages_burst = 500;  // from one client; more wait in the socket
  // Accepted connections of all listeners together; more wait in the system's queue. Without this
  // limit a client that connects and is closed in a loop would take a third of a processor core.
  double accepts_per_s = 1000, accepts_burst = 200;
  double bytes_per_s = 65536, bytes_burst = 65536;  // read from one client; more wait in the socket
};

// One client's side of a protocol. Thread-bound to the server's thread.
class Session {
 public:
  struct Taken {
    std::size_t bytes = 0;     // number of bytes taken off the front of the input
    std::size_t messages = 0;  // number of complete messages in them, at most as many as allowed
  };

  virtual ~Session() = default;

  // Appends what the server sends first, before the client has sent anything.
  virtual void open(std::string& /*output*/) {}

  // Takes at most `most` complete messages off the front of `input` and appends the answers to
  // `output`. Bytes that it leaves are passed again, with more after them. An error closes the
  // connection; its text is the reason.
  virtual Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) = 0;

  // Whether the client has completed the protocol's handshake.
  virtual bool established() const noexcept = 0;

  // For a relay: the descriptor of the connection on its other side; -1: none. It is polled for
  // reading and, while farPending(), for writing.
  virtual int farFd() const noexcept { return -1; }
  // Whether bytes wait to be written to farFd(); while they do, receive() is not called.
  virtual bool farPending() const noexcept { return false; }
  // Called when farFd() is writable.
  virtual Result<Ok> writeFar() { return Ok{}; }
  // Called when farFd() is readable: appends at most `room` bytes from it to `output`.
  virtual Result<Ok> readFar(std::size_t /*room*/, std::string& /*output*/) { return Ok{}; }
};

// Counters of a server, for the status.
struct ServerReport {
  std::string name;
  std::size_t connections = 0;  // at present
  std::uint64_t accepted = 0;   // since the start, as all below
  std::uint64_t refused = 0;    // there was no place
  std::uint64_t replaced = 0;   // closed because a new connection needed the place
  std::uint64_t silent = 0;     // closed: did not complete the handshake in time
  std::uint64_t broken = 0;     // closed: violated the protocol
  std::uint64_t slow = 0;       // closed: did not read
  std::string last;             // sentence about the last of these; empty: none

  // Number of connections that were refused or closed by the server.
  std::uint64_t sentAway() const noexcept { return refused + replaced + silent + broken + slow; }
};

// Thread-bound except for report().
class ConnectionServer {
 public:
  // Makes the Session of a new client; null: the client is not accepted.
  using MakeSession = std::function<std::unique_ptr<Session>(const Peer&)>;

  // `name`: for reports, "VRPN". `clock` must outlive the server.
  ConnectionServer(std::string name, const ServerLimits& limits, const Clock& clock);
  ~ConnectionServer();
  ConnectionServer(const ConnectionServer&) = delete;
  ConnectionServer& operator=(const ConnectionServer&) = delete;

  // Adds a listening socket. REQUIRES: it is non-blocking.
  void listen(UniqueFd listener, MakeSession make);
  // Closes the listening sockets; connections stay.
  void stopListening() { listeners_.clear(); }

  // Adds a connection that was not accepted here, but made by connect(). It needs a place too.
  // Returns false if there is none or `make` returns null; the connection is then closed. REQUIRES:
  // it is non-blocking; it may still be connecting.
  bool add(UniqueFd fd, const Peer& peer, const MakeSession& make);

  // Waits at most `at_most`, or until a client is ready or one of `wakers` (descriptors) is
  // readable; then serves every client once.
  void round(Duration at_most, std::span<const int> wakers = {});

  // Calls `append` for every established client, to append output, and sends what can be sent at
  // once.
  void sendToAll(const std::function<void(Session& session, std::string& output)>& append);

  std::size_t connections() const noexcept { return clients_.size(); }

  // Thread-safe.
  ServerReport report() const;

 private:
  struct Client;
  struct Listener {
    UniqueFd fd;
    MakeSession make;
  };
  enum class End { kGone, kRefused, kReplaced, kSilent, kBroken, kSlow };

  std::vector<pollfd> pollSet(std::span<const int> wakers, Timestamp now, Duration& wait) const;
  void accept(Listener& listener);
  void serve(Client& client, const pollfd& own, const pollfd* far, Timestamp now);
  bool serveFar(Client& client, const pollfd& far);
  bool read(Client& client, Timestamp now);
  void process(Client& client, Timestamp now);
  void write(Client& client, Timestamp now);
  void end(Client& client, End why, const std::string& reason);
  // `peer`: nothing if the client is unknown.
  void count(End why, const std::optional<Peer>& peer, const std::string& reason);
  void removeEnded();
  std::vector<Occupant> occupants() const;

  std::string name_;
  ServerLimits limits_;
  const Clock& clock_;
  std::vector<Listener> listeners_;
  std::vector<std::unique_ptr<Client>> clients_;
  TokenBucket accepts_;
  // Nothing is accepted before this time: descriptors ran out, or the rate limit was reached.
  Timestamp accept_from_{};
  mutable std::mutex mutex_;
  ServerReport report_;  // guarded by mutex_
};

// Makes a local socket that listens at `path`. A socket that a dead program left there is replaced;
// anything else stays. `mode`: permissions of the socket's file. Errors: kBusy (another program
// serves it), kInvalidArgument (the path is too long, or not a socket), kIo.
Result<UniqueFd> listenLocal(const std::string& path, unsigned mode);

// Makes a TCP socket that listens at an IPv4 address ("127.0.0.1", "0.0.0.0"); port 0 takes a free
// one. Errors: kInvalidArgument (not an IPv4 address), kBusy (the port is in use), kUnsupported
// (this process may not use network sockets), kIo.
Result<UniqueFd> listenTcp(const std::string& address, int port);
// Returns the port to which an IPv4 socket is bound; 0 if it is not bound.
int portOf(int fd);

}  // namespace merlin::net
