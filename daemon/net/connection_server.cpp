#include "daemon/net/connection_server.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

namespace merlin::net {
namespace {

constexpr int kAcceptedPerRound = 64;
constexpr double kAcceptedAfterWait =
    10;  // at least this many at once, to limit wake-ups in a flood
constexpr Duration kWithoutDescriptors = std::chrono::milliseconds(100);

short hung(const pollfd& p) { return p.revents & (POLLHUP | POLLERR | POLLNVAL); }

}  // namespace

struct ConnectionServer::Client {
  UniqueFd fd;
  Occupant occupant;
  std::unique_ptr<Session> session;
  std::string input, output;
  TokenBucket messages, bytes;
  bool more = false;  // complete messages may be left for the next round
  bool ended = false;

  Client(UniqueFd f, const Peer& peer, std::unique_ptr<Session> s, const ServerLimits& limits,
         Timestamp now)
      : fd(std::move(f)),
        session(std::move(s)),
        messages(limits.messages_per_s, limits.messages_burst),
        bytes(limits.bytes_per_s, limits.bytes_burst) {
    occupant = {peer, now, now, false};
  }
};

ConnectionServer::ConnectionServer(std::string name, const ServerLimits& limits, const Clock& clock)
    : name_(std::move(name)),
      limits_(limits),
      clock_(clock),
      accepts_(limits.accepts_per_s, limits.accepts_burst) {
  report_.name = name_;
}

ConnectionServer::~ConnectionServer() = default;

void ConnectionServer::listen(UniqueFd listener, MakeSession make) {
  listeners_.push_back({std::move(listener), std::move(make)});
}

std::vector<Occupant> ConnectionServer::occupants() const {
  std::vector<Occupant> all;
  all.reserve(clients_.size());
  for (const auto& client : clients_) all.push_back(client->occupant);
  return all;
}

bool ConnectionServer::add(UniqueFd fd, const Peer& peer, const MakeSession& make) {
  const Timestamp now = clock_.now();
  const Decision decision = decide(occupants(), peer, limits_.places, now);
  if (decision.kind == Decision::Kind::kRefuse) {
    count(End::kRefused, peer, "all places that it could have are in use");
    return false;
  }
  if (decision.kind == Decision::Kind::kReplace) {
    end(*clients_[decision.victim], End::kReplaced, "its place was needed for a new connection");
    removeEnded();
  }
  auto session = make(peer);
  if (!session) return false;
  clients_.push_back(
      std::make_unique<Client>(std::move(fd), peer, std::move(session), limits_, now));
  clients_.back()->session->open(clients_.back()->output);
  const std::lock_guard lock(mutex_);
  ++report_.accepted;
  report_.connections = clients_.size();
  return true;
}

void ConnectionServer::accept(Listener& listener) {
  for (int i = 0; i < kAcceptedPerRound; ++i) {
    const Timestamp now = clock_.now();
    if (!accepts_.take(1, now)) {
      accept_from_ = now + accepts_.waitFor(kAcceptedAfterWait, now);
      return;
    }
    UniqueFd fd(::accept4(listener.fd.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd.valid()) {
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
        accept_from_ = now + kWithoutDescriptors;
        count(End::kRefused, std::nullopt, std::strerror(errno));
      }
      return;
    }
    const Peer peer = peerOf(fd.get());
    const int yes = 1;  // output consists of complete messages: do not delay
    if (peer.user < 0) ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    add(std::move(fd), peer, listener.make);
  }
}

// Returns the descriptors to poll, in this order: listeners, wakers, then each client followed by
// its farFd() if it has one. Shortens `wait` to the next time at which something is due.
std::vector<pollfd> ConnectionServer::pollSet(std::span<const int> wakers, Timestamp now,
                                              Duration& wait) const {
  std::vector<pollfd> set;
  const bool accepting = now >= accept_from_;
  if (!accepting) wait = std::min(wait, accept_from_ - now);
  for (const Listener& l : listeners_) set.push_back({accepting ? l.fd.get() : -1, POLLIN, 0});
  for (const int fd : wakers) set.push_back({fd, POLLIN, 0});
  for (const auto& client : clients_) {
    Client& c = *client;
    const Duration bytes = c.bytes.waitFor(1, now), messages = c.messages.waitFor(1, now);
    const bool room = c.input.size() < limits_.input_bytes;
    if (room && bytes > Duration::zero()) wait = std::min(wait, bytes);
    if (c.more) wait = std::min(wait, messages);
    if (!c.occupant.established)
      wait = std::min(wait, std::max<Duration>(c.occupant.since + limits_.opening - now, {}));
    const bool reads = room && bytes == Duration::zero();
    set.push_back({c.fd.get(),
                   static_cast<short>((reads ? POLLIN : 0) | (c.output.empty() ? 0 : POLLOUT)), 0});
    if (const int far = c.session->farFd(); far >= 0) {
      const bool takes = c.output.size() < limits_.output_bytes / 2;
      set.push_back(
          {far, static_cast<short>((takes ? POLLIN : 0) | (c.session->farPending() ? POLLOUT : 0)),
           0});
    }
  }
  return set;
}

void ConnectionServer::round(Duration at_most, std::span<const int> wakers) {
  std::vector<pollfd> set = pollSet(wakers, clock_.now(), at_most);
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(std::max<Duration>(at_most, {}));
  if (::poll(set.data(), set.size(), static_cast<int>(ms.count())) < 0) return;  // a signal
  const Timestamp now = clock_.now();
  std::size_t at = listeners_.size() + wakers.size();
  for (const auto& client : clients_) {
    const pollfd& own = set[at++];
    const pollfd* far = client->session->farFd() >= 0 ? &set[at++] : nullptr;
    serve(*client, own, far, now);
  }
  removeEnded();
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    if (set[i].revents != 0) accept(listeners_[i]);
  }
}

void ConnectionServer::serve(Client& c, const pollfd& own, const pollfd* far, Timestamp now) {
  if ((own.revents & POLLIN) != 0 && !read(c, now)) return;
  if (hung(own) && (own.revents & POLLIN) == 0) return end(c, End::kGone, "");
  if (far && !serveFar(c, *far)) return;
  if (!c.input.empty() && !c.session->farPending()) process(c, now);
  if (c.ended) return;
  c.occupant.established = c.session->established();
  if (!c.occupant.established && now - c.occupant.since >= limits_.opening) {
    return end(c, End::kSilent,
               fmt::format("it did not complete the handshake within {:.1f} s",
                           toSeconds(limits_.opening)));
  }
  write(c, now);
}

// Returns false if the client was closed.
bool ConnectionServer::serveFar(Client& c, const pollfd& far) {
  Result<Ok> done = Ok{};
  if (far.revents & POLLOUT) done = c.session->writeFar();
  if (done && (far.revents & (POLLIN | POLLHUP | POLLERR))) {
    const std::size_t held = std::min(c.output.size(), limits_.output_bytes);
    done = c.session->readFar(limits_.output_bytes - held, c.output);
  }
  if (done) return true;
  const bool gone = done.error().code == Errc::kClosed;
  end(c, gone ? End::kGone : End::kBroken, done.error().what);
  return false;
}

// Returns false if the client was closed.
bool ConnectionServer::read(Client& c, Timestamp now) {
  const std::size_t held = c.input.size();
  const auto allowed = static_cast<std::size_t>(std::max(1.0, c.bytes.available(now)));
  const std::size_t room = std::min(limits_.input_bytes - held, allowed);
  c.input.resize(held + room);
  const ssize_t n = ::recv(c.fd.get(), c.input.data() + held, room, MSG_DONTWAIT);
  c.input.resize(held + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  if (n > 0) {
    c.bytes.charge(static_cast<double>(n), now);
    c.occupant.active = now;
    return true;
  }
  if (n < 0 && (errno == EAGAIN || errno == EINTR || errno == ENOTCONN)) return true;
  end(c, End::kGone, "");
  return false;
}

void ConnectionServer::process(Client& c, Timestamp now) {
  const auto allowed = static_cast<std::size_t>(std::max(0.0, c.messages.available(now)));
  const std::size_t most = std::min(limits_.messages_per_round, allowed);
  c.more = most == 0;
  if (most == 0) return;
  const auto taken = c.session->receive(c.input, most, c.output);
  if (!taken) return end(c, End::kBroken, taken.error().what);
  c.messages.charge(static_cast<double>(taken->messages), now);
  c.input.erase(0, taken->bytes);
  c.more = taken->messages >= most && !c.input.empty();
  if (taken->bytes == 0 && c.input.size() >= limits_.input_bytes && !c.session->farPending()) {
    end(c, End::kBroken,
        fmt::format("it sent a message of more than {} bytes", limits_.input_bytes));
  }
}

void ConnectionServer::write(Client& c, Timestamp now) {
  if (!c.output.empty()) {
    const ssize_t n =
        ::send(c.fd.get(), c.output.data(), c.output.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n > 0) {
      c.output.erase(0, static_cast<std::size_t>(n));
      c.occupant.active = now;
    } else if (n < 0 && errno != EAGAIN && errno != EINTR && errno != ENOTCONN) {
      return end(c, End::kGone, "");
    }
  }
  if (c.output.size() > limits_.output_bytes) {
    end(c, End::kSlow, fmt::format("it did not read, and {} bytes were waiting", c.output.size()));
  }
}

void ConnectionServer::sendToAll(
    const std::function<void(Session& session, std::string& output)>& append) {
  const Timestamp now = clock_.now();
  for (const auto& client : clients_) {
    if (!client->session->established()) continue;
    append(*client->session, client->output);
    write(*client, now);
  }
  removeEnded();
}

void ConnectionServer::end(Client& c, End why, const std::string& reason) {
  if (c.ended) return;
  c.ended = true;
  if (why != End::kGone) count(why, c.occupant.peer, reason);
}

void ConnectionServer::count(End why, const std::optional<Peer>& peer, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  switch (why) {
    case End::kGone: return;
    case End::kRefused: ++report_.refused; break;
    case End::kReplaced: ++report_.replaced; break;
    case End::kSilent: ++report_.silent; break;
    case End::kBroken: ++report_.broken; break;
    case End::kSlow: ++report_.slow; break;
  }
  report_.last = fmt::format("{} a connection{}: {}", why == End::kRefused ? "refused" : "closed",
                             peer ? " of " + peerName(*peer) : "", reason);
}

void ConnectionServer::removeEnded() {
  if (std::erase_if(clients_, [](const auto& client) { return client->ended; }) == 0) return;
  const std::lock_guard lock(mutex_);
  report_.connections = clients_.size();
}

ServerReport ConnectionServer::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

}  // namespace merlin::net
