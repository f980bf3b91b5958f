#include "daemon/rfb/client_process.h"

#include <algorithm>
#include <csignal>
#include <optional>

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/sanitizer.h"
#include "daemon/rfb/input_map.h"
#include "daemon/rfb/rfb_screen.h"
#include "daemon/rfb/shown_picture.h"
#include "daemon/status/client.h"

namespace merlin::rfb {
namespace {

constexpr Duration kActiveEvery = std::chrono::seconds(1);

void limitProcess() {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const auto limit = [](auto what, rlim_t most) {
    const rlimit both{most, most};
    ::setrlimit(what, &both);
  };
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_NOFILE, 64);
#if !defined(MERLIN_ANY_SANITIZER)  // sanitizers reserve terabytes
  limit(RLIMIT_DATA, rlim_t{1} << 30);
#endif
}

// Makes the kernel notice within a minute that the client's machine was switched off.
void keepAlive(int socket) {
  const int yes = 1, idle_s = 30, every_s = 10, probes = 3;
  ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
  ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
  ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &every_s, sizeof every_s);
  ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof probes);
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

// Sends the client's input to the wall, one command at a time.
class InputLink {
 public:
  InputMap& map() noexcept { return map_; }

  void tend(const std::string& endpoint, Timestamp now) {
    if (const auto answer = sender_.answer(now); answer && !*answer)
      logWarning("a client's input: {}", oneLine(answer->error().what));
    if (!sender_.isReady()) return;
    const auto request = next(now);
    if (!request || endpoint.empty()) return;  // while no wall runs, input is lost
    const auto sent = sender_.send(endpoint, request->command, request->argument, now);
    if (!sent) logWarning("a client's input: {}", oneLine(sent.error().what));
  }

 private:
  std::optional<Request> next(Timestamp now) {
    if (const auto told = map_.panel().take(now)) return Request{"operator_pointer", *told};
    return map_.take();
  }

  InputMap map_;
  status::CommandSender sender_;
};

// Tells the parent process of the client's progress.
class Reporter {
 public:
  explicit Reporter(int fd) : fd_(fd) {}

  void tend(const RfbScreen& screen, Timestamp now) {
    if (!screen.isEstablished()) return;
    if (!established_) {
      established_ = true;
      write(Report::kEstablished);
    }
    ::alarm(kMessageLimit_s);
    if (!screen.wantsPicture() || now - active_ < kActiveEvery) return;
    active_ = now;
    write(Report::kActive);
  }

 private:
  void write(Report report) const {
    const char byte = static_cast<char>(report);
    (void)!::write(fd_, &byte, 1);
  }

  int fd_;
  bool established_ = false;
  Timestamp active_{};
};

void show(ShownPicture& picture, RfbScreen& screen, Timestamp now) {
  const ShownPicture::Change change = picture.update(now);
  if (change.resized) screen.setPixels(picture.pixels(), picture.width(), picture.height());
  for (const Rectangle& rectangle : change.changed) screen.markChanged(rectangle);
}

}  // namespace

int serveClient(const RfbSettings& settings, int client, int report) {
  limitProcess();
  ::alarm(handshakeLimit_s(settings));
  keepAlive(client);
  const SystemClock clock;
  ShownPicture picture(settings.instance, settings.view, SharedMemory::From::kOwnGroup);
  picture.update(clock.now());
  std::optional<InputLink> input;
  if (settings.allow_input) input.emplace();
  RfbScreen screen(
      client,
      {fmt::format("MERLIN {}: {}", settings.instance, viewName(settings.view)), settings.password},
      input ? &input->map() : nullptr, picture.pixels(), picture.width(), picture.height());
  Reporter reporter(report);
  const Duration period = std::chrono::seconds(1) / settings.rate_hz;
  for (Timestamp next = clock.now(); !screen.isGone();) {
    const Timestamp now = clock.now();
    if (now >= next) {
      next = now + period;
      if (screen.wantsPicture()) show(picture, screen, now);
      reporter.tend(screen, now);
    }
    if (input) input->map().panel().place(picture.panel());
    if (input) input->tend(picture.commandEndpoint(), now);
    screen.process(std::clamp(next - clock.now(), Duration::zero(), period));
  }
  return screen.gaveWrongPassword() ? kWrongPassword : kClientLeft;
}

}  // namespace merlin::rfb
