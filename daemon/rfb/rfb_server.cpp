#include "daemon/rfb/rfb_server.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/base/token_bucket.h"
#include "daemon/net/connection_server.h"
#include "daemon/rfb/client_process.h"
#include "daemon/rfb/client_table.h"

namespace merlin::rfb {
namespace {

// Limits how fast connections are accepted, since each costs a process; the others wait in the
// system's queue.
constexpr double kAccepts_per_s = 20, kAcceptsBurst = 20;

// Waits until a descriptor of the set is ready; while `accepts` is empty, it ignores the listener,
// set[0], at most until a token is available. Returns false if poll() fails.
bool wait(std::vector<pollfd>& set, TokenBucket& accepts, Timestamp now) {
  const Duration pause = accepts.waitFor(1, now);
  int timeout_ms = -1;
  if (pause > Duration::zero()) {
    set[0].fd = -1;
    timeout_ms = static_cast<int>(pause / std::chrono::milliseconds(1)) + 1;
  }
  return ::poll(set.data(), set.size(), timeout_ms) >= 0 || errno == EINTR;
}

}  // namespace

Result<RfbServer> RfbServer::make(const RfbSettings& settings) {
  if (const auto valid = validate(settings); !valid) return valid.error();
  auto listener = net::listenTcp(settings.listen.address, settings.listen.port);
  if (listener) return RfbServer(settings, *std::move(listener));
  const Error& error = listener.error();
  if (error.code != Errc::kBusy) return error;
  return Error{Errc::kBusy,
               fmt::format("--listen {}:{}: another program listens there (perhaps another VNC "
                           "server); choose another port",
                           settings.listen.address, settings.listen.port)};
}

int RfbServer::port() const { return net::portOf(listener_.get()); }

Result<Ok> RfbServer::run(const UniqueFd& stop) {
  const SystemClock clock;
  TokenBucket accepts(kAccepts_per_s, kAcceptsBurst);
  ClientTable clients(settings_.clients, [this](int client, int report) {
    listener_.reset();
    return serveClient(settings_, client, report);
  });
  for (;;) {
    std::vector<pollfd> set = {{listener_.get(), POLLIN, 0}, {stop.get(), POLLIN, 0}};
    clients.appendTo(set);
    if (!wait(set, accepts, clock.now()))
      return Error{Errc::kIo, fmt::format("poll: {}", std::strerror(errno))};
    const Timestamp now = clock.now();
    if (set[1].revents != 0) return Ok{};
    for (std::size_t i = 2; i < set.size(); ++i)
      if (set[i].revents != 0) clients.read(set[i].fd, now);
    if (set[0].fd < 0 || set[0].revents == 0 || !accepts.take(1, now)) continue;
    UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (client.valid()) clients.add(std::move(client), now);
  }
}

}  // namespace merlin::rfb
