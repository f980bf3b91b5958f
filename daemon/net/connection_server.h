// ConnectionServer: the connections of one server, each bounded in everything that it can take.
//
// Every server of merlind that strangers can reach stands on this: it accepts by itself, counts
// places (admission.h), closes who does not say in time what the protocol opens with, holds at most
// so many bytes of each client's input and output, and gives each client so many messages a round
// and a second. The protocol is a Session. So no client can take memory, descriptors, time or
// places from others beyond these limits, whatever it sends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
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
  Duration opening = std::chrono::seconds(2);  // until a client is established; else it is closed
  std::size_t input_bytes = 8192;              // held of one client; a longer message closes it
  std::size_t output_bytes = 65536;            // for a client that does not read; more closes it
  std::size_t messages_per_round = 16;         // of one client, before the next one's turn
  double messages_per_s = 500, messages_burst = 500;  // of one client; more wait in the socket
  // Newcomers of all listeners together; more wait in the system's queue. Who connects and is sent
  // away in a loop would take a third of a processor core without it.
  double accepts_per_s = 1000, accepts_burst = 200;
  double bytes_per_s = 65536, bytes_burst = 65536;  // read from one client; likewise
};

// One client's side of a protocol. Thread-bound to the server's thread.
class Session {
 public:
  struct Taken {
    std::size_t bytes = 0;     // of the front of the input
    std::size_t messages = 0;  // whole ones; at most as many as were allowed
  };

  virtual ~Session() = default;

  // What the server says first, before the client has said anything.
  virtual void open(std::string& /*output*/) {}

  // Takes at most `most` whole messages off the front of `input`, and appends what is to be sent
  // back to `output`. What it leaves is offered again, with more behind it. An error closes the
  // connection; its text is the reason.
  virtual Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) = 0;

  // Whether the client has said what the protocol opens with.
  virtual bool established() const noexcept = 0;

  // For a relay, the descriptor of the far side; -1: none. It is polled for bytes to be read, and,
  // while farPending(), for room to write.
  virtual int farFd() const noexcept { return -1; }
  // Whether something waits until the far side takes it; receive() is not called meanwhile.
  virtual bool farPending() const noexcept { return false; }
  // The far side takes more.
  virtual Result<Ok> writeFar() { return Ok{}; }
  // The far side has something: at most `room` bytes of it are appended to `output`.
  virtual Result<Ok> readFar(std::size_t /*room*/, std::string& /*output*/) { return Ok{}; }
};

// What a server has done so far, for the status.
struct ServerReport {
  std::string name;
  std::size_t connections = 0;  // now
  std::uint64_t accepted = 0;   // since the start, as all below
  std::uint64_t refused = 0;    // no place
  std::uint64_t replaced = 0;   // gave up an idle place for a newcomer
  std::uint64_t silent = 0;     // did not say in time what the protocol opens with
  std::uint64_t broken = 0;     // did not follow the protocol
  std::uint64_t slow = 0;       // did not read
  std::string last;             // of these, as a sentence; empty: none

  // Those who were sent away, for whatever reason.
  std::uint64_t sentAway() const noexcept { return refused + replaced + silent + broken + slow; }
};

// Thread-bound but for report().
class ConnectionServer {
 public:
  // Makes the protocol's side for a new client.
  using MakeSession = std::function<std::unique_ptr<Session>(const Peer&)>;

  // `name`: for reports, "VRPN". `clock` outlives this.
  ConnectionServer(std::string name, const ServerLimits& limits, const Clock& clock);
  ~ConnectionServer();
  ConnectionServer(const ConnectionServer&) = delete;
  ConnectionServer& operator=(const ConnectionServer&) = delete;

  // Takes a socket that listens. REQUIRES: it is non-blocking.
  void listen(UniqueFd listener, MakeSession make);
  // Closes what listens; those who are connected stay.
  void stopListening() { listeners_.clear(); }

  // A connection that was made in another way (connected from here). The same places hold for it;
  // false where there is none. REQUIRES: non-blocking; it may still be connecting.
  bool add(UniqueFd fd, const Peer& peer, const MakeSession& make);

  // Waits for at most `at_most`, or until a client or one of `wakers` (descriptors that become
  // readable) has something; then serves every client once.
  void round(Duration at_most, std::span<const int> wakers = {});

  // Offers every established client something to be sent, and sends what can be sent at once.
  void tell(const std::function<void(Session& session, std::string& output)>& append);

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
  void count(End why, const Peer& peer, const std::string& reason);
  void removeEnded();
  std::vector<Occupant> occupants() const;

  std::string name_;
  ServerLimits limits_;
  const Clock& clock_;
  std::vector<Listener> listeners_;
  std::vector<std::unique_ptr<Client>> clients_;
  TokenBucket accepts_;
  Timestamp accept_from_{};  // no descriptor was left, or enough have come: not before this
  mutable std::mutex mutex_;
  ServerReport report_;  // guarded by mutex_
};

// A local socket that listens under `path`, made anew. A socket that a dead program left there is
// replaced; anything else that is there stays. `mode`: of the socket's file. Errors: kBusy (another
// program answers there), kInvalidArgument (too long, or something that is not a socket is there),
// kIo.
Result<UniqueFd> listenLocal(const std::string& path, unsigned mode);

// A TCP socket that listens at an IPv4 address ("127.0.0.1", "0.0.0.0"); port 0 takes a free one.
// Errors: kBusy (the port is taken), kUnsupported (this process may not use network sockets), kIo.
Result<UniqueFd> listenTcp(const std::string& address, int port);
int portOf(int fd);

}  // namespace merlin::net
