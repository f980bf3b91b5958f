#include "daemon/status/relay.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "daemon/base/log.h"

namespace merlin::status {
namespace {

constexpr Duration kRound = std::chrono::milliseconds(200);
constexpr Duration kCheckPeriod = std::chrono::seconds(1);
constexpr std::size_t kMostToFar = 16384;  // buffered for libzmq, which usually takes all at once
constexpr unsigned kMode = 0660;           // the daemon's user and group
constexpr std::string_view kIpc = "ipc://", kTcp = "tcp://";

UniqueFd connectTo(const std::string& path) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return UniqueFd();
  path.copy(address.sun_path, path.size());
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(fd.get(), generic, sizeof address) != 0) fd.reset();
  return fd;
}

// One client and its connection to libzmq.
class RelaySession final : public net::Session {
 public:
  RelaySession(UniqueFd far, const ZmtpLimits& limits)
      : far_(std::move(far)),
        from_client_(limits),
        from_far_({~std::size_t{0}, ~std::size_t{0}, 0}) {}

  Result<Taken> receive(std::string_view input, std::size_t most, std::string&) override {
    const auto accepted = from_client_.follow(input, most);
    if (!accepted) return accepted.error();
    to_far_ += input.substr(0, accepted->bytes);
    if (const auto written = writeFar(); !written) return written.error();
    return Taken{accepted->bytes, accepted->frames};
  }
  // Whether the handshake is complete; it never is for a client that only connects.
  bool established() const noexcept override { return from_far_.ready(); }

  int farFd() const noexcept override { return far_.get(); }
  bool farPending() const noexcept override { return !to_far_.empty(); }
  Result<Ok> writeFar() override {
    const ssize_t n =
        ::send(far_.get(), to_far_.data(), to_far_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n > 0) to_far_.erase(0, static_cast<std::size_t>(n));
    const bool gone = n < 0 && errno != EAGAIN && errno != EINTR;
    if (gone || to_far_.size() > kMostToFar)
      return Error{Errc::kClosed, "libzmq closed the connection"};
    return Ok{};
  }
  Result<Ok> readFar(std::size_t room, std::string& output) override {
    const std::size_t held = output.size();
    output.resize(held + room);
    const ssize_t n = room == 0 ? -1 : ::recv(far_.get(), output.data() + held, room, MSG_DONTWAIT);
    output.resize(held + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n == 0 || (n < 0 && room > 0 && errno != EAGAIN && errno != EINTR))
      return Error{Errc::kClosed, "libzmq closed the connection"};
    if (!from_far_.ready()) {
      if (const auto followed =
              from_far_.follow(std::string_view(output).substr(held), ~std::size_t{0});
          !followed)
        return followed.error();
    }
    return Ok{};
  }

 private:
  UniqueFd far_;
  ZmtpGuard from_client_, from_far_;
  std::string to_far_;
};

struct TcpAddress {
  std::string host;
  int port = 0;
};

Result<TcpAddress> parseTcp(const std::string& endpoint) {
  const std::string rest = endpoint.substr(kTcp.size());
  const std::size_t colon = rest.rfind(':');
  TcpAddress address;
  if (colon != std::string::npos) {
    address.host = rest.substr(0, colon) == "*" ? "0.0.0.0" : rest.substr(0, colon);
    const char* end = rest.data() + rest.size();
    const auto [stopped, error] = std::from_chars(rest.data() + colon + 1, end, address.port);
    if (error == std::errc{} && stopped == end && address.port >= 0 && address.port <= 65535)
      return address;
  }
  return Error{Errc::kInvalidArgument,
               endpoint + ": is not tcp://ADDRESS:PORT, where ADDRESS is an IPv4 address or '*'"};
}

std::uint64_t inodeOf(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

}  // namespace

Result<std::unique_ptr<Relay>> Relay::start(RelaySettings settings, ThreadWatch& watch,
                                            const Clock& clock) {
  std::unique_ptr<Relay> relay(new Relay(std::move(settings), clock));
  if (const auto listening = relay->listen(); !listening) return listening.error();
  relay->thread_ = WatchedThread(
      watch, relay->settings_.name,
      [r = relay.get()](const std::stop_token& stop, Progress& p) { r->run(stop, p); });
  return relay;
}

Relay::Relay(RelaySettings settings, const Clock& clock)
    : settings_(std::move(settings)),
      clock_(clock),
      server_(settings_.name, settings_.limits, clock) {}

Relay::~Relay() {
  thread_.stop();
  if (isThere()) ::unlink(path().c_str());
}

std::string Relay::path() const {
  return settings_.endpoint.starts_with(kIpc) ? settings_.endpoint.substr(kIpc.size()) : "";
}

bool Relay::isThere() const { return !path().empty() && file_ != 0 && inodeOf(path()) == file_; }

Result<Ok> Relay::listen() {
  Result<UniqueFd> listener =
      Error{Errc::kInvalidArgument, settings_.endpoint + ": is neither ipc:// nor tcp://"};
  if (!path().empty()) {
    listener = net::listenLocal(path(), kMode);
    file_ = listener ? inodeOf(path()) : 0;  // 0: a file there is not ours
  } else if (settings_.endpoint.starts_with(kTcp)) {
    const auto address = parseTcp(settings_.endpoint);
    if (!address) return address.error();
    listener = net::listenTcp(address->host, address->port);
  }
  if (!listener) return listener.error();
  server_.listen(*std::move(listener), [this](const net::Peer&) -> std::unique_ptr<net::Session> {
    UniqueFd far = connectTo(settings_.inner);
    if (!far.valid()) return nullptr;
    return std::make_unique<RelaySession>(std::move(far), settings_.zmtp);
  });
  return Ok{};
}

void Relay::run(const std::stop_token& stop, Progress& progress) {
  while (!stop.stop_requested()) {
    server_.round(kRound);
    listenAgainWhereGone();
    progress.step();
  }
}

// If the socket's file (or its folder) was removed, creates it again, so that clients can connect.
// If that fails, for example because only root can create the folder, it is tried again every
// second.
void Relay::listenAgainWhereGone() {
  const Timestamp now = clock_.now();
  if (path().empty() || now - checked_ < kCheckPeriod) return;
  checked_ = now;
  if (isThere()) return;
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path()).parent_path(), error);
  server_.stopListening();
  const auto listening = listen();
  const std::string why = listening ? std::string() : listening.error().what;
  if (listening) {
    logWarning("{}: its socket {} was removed and has been created again", settings_.name, path());
  } else if (why != failure_) {
    logWarning("{}: its socket {} was removed and cannot be created again: {}; tried every second",
               settings_.name, path(), why);
  }
  failure_ = why;
}

}  // namespace merlin::status
