#include "daemon/page_process.h"

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <systemd/sd-daemon.h>

#include "daemon/base/event_logger.h"
#include "daemon/base/log.h"
#include "daemon/base/version.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/page/event_log.h"
#include "daemon/page/page_server.h"
#include "daemon/page/token.h"
#include "daemon/page_contents.h"
#include "daemon/role_signals.h"
#include "daemon/status/ended_threads.h"
#include "daemon/status/run_directory.h"
#include "daemon/status/services.h"
#include "daemon/status/watchdog.h"

namespace merlin {
namespace {

// Nice value of this process, so that the wall's threads take precedence on a busy machine.
constexpr int kNice = 10;

std::uint64_t milliseconds1970(Timestamp now) {
  return static_cast<std::uint64_t>((toNanoseconds(now) + realtimeOffset().count()) / 1'000'000);
}

// Returns the folder for the models' thumbnails: the unit's cache folder, which survives a restart
// of the machine, or else the run directory.
std::string thumbnailFolder(const Settings& settings) {
  const char* const cache = std::getenv("CACHE_DIRECTORY");
  return cache && *cache == '/' ? cache : settings.run_directory;
}

class PageProcess {
 public:
  PageProcess(const Settings& settings, const page::TokenFile& token, Clock& clock)
      : clock_(clock),
        watchdog_(watchdogInterval()),
        events_(milliseconds1970(clock.now())),
        keeper_("page",
                [this, settings = serverSettings(settings, token)] { return start(settings); }) {}

  Result<Asked> run(const std::function<bool()>& is_valid) {
    tend();
    ::sd_notify(0, "READY=1");
    logInfo("ready");
    Asked asked = Asked::kNothing;
    while ((asked = askedBySignal(kSignalBeat, is_valid)) == Asked::kNothing) {
      tend();
      if (const auto ended = ended_threads_.check(clock_.now())) return *ended;
      if (watchdog_.ping(clock_.now(), threads_.threads())) ::sd_notify(0, "WATCHDOG=1");
    }
    tellEnd(asked);
    return asked;
  }

 private:
  static page::PageServerSettings serverSettings(const Settings& s, const page::TokenFile& token) {
    return {s.page,       s.instance,           programVersion(),  token.token(),
            token.path(), pageContents(s.wall), thumbnailFolder(s)};
  }

  Result<std::unique_ptr<net::Server>> start(const page::PageServerSettings& settings) {
    auto server = page::PageServer::start(settings, events_, threads_, clock_);
    if (!server) {
      return Error{server.error().code,
                   fmt::format("/page/port {}: {}", settings.page.port, server.error().what)};
    }
    const PageSettings& p = settings.page;
    logInfo("{} of merlind \"{}\" at http://{}:{}/{}; the token for commands is in {}",
            p.enabled ? "the page" : "metrics", settings.instance, p.address, (*server)->port(),
            p.enabled ? "" : "metrics", settings.token_file);
    return std::unique_ptr<net::Server>(*std::move(server));
  }

  void tend() {
    const Timestamp now = clock_.now();
    keeper_.tend(now);
    for (const Event& event : keeper_.takeEvents(now)) {
      logger_.log(kServerEvent, event, now);
      events_.add("page", kServerEvent.name, event.what);
    }
    logger_.tellLeftOut(now);
    const net::ServerHealth health = keeper_.health();
    const std::string status = health.failure.empty()
                                   ? fmt::format("{} connections", health.report.connections)
                                   : health.failure;
    if (status != std::exchange(told_status_, status)) ::sd_notify(0, ("STATUS=" + status).c_str());
  }

  Clock& clock_;
  ThreadWatch threads_;  // declared before all members that have threads
  status::Services services_;
  status::EndedThreads ended_threads_{threads_, services_};
  status::Watchdog watchdog_;
  page::EventLog events_;
  EventLogger logger_{"page"};
  std::string told_status_;
  net::ServerKeeper keeper_;  // uses everything above
};

// Waits until the configuration has a page or metrics again, or until the process is to end.
Asked serveNothing(const std::function<bool()>& is_valid) {
  ::sd_notify(0, "READY=1\nSTATUS=switched off by the configuration");
  logInfo("ready: the page is switched off by the configuration, and so are the metrics");
  Asked asked = Asked::kNothing;
  while ((asked = askedBySignal(kSignalBeat, is_valid)) == Asked::kNothing)
    ::sd_notify(0, "WATCHDOG=1");
  tellEnd(asked);
  return asked;
}

}  // namespace

Result<Asked> runPage(Settings settings, Clock& clock, const std::function<bool()>& is_valid) {
  if (!settings.page.enabled && !settings.page.metrics) return serveNothing(is_valid);
  auto directory = status::runDirectory(settings.run_directory);
  if (!directory) return directory.error();
  settings.run_directory = *std::move(directory);
  const auto token = page::TokenFile::open(
      fmt::format("{}/{}-page.token", settings.run_directory, settings.instance));
  if (!token) return token.error();
  ::setpriority(PRIO_PROCESS, 0, kNice);
  return PageProcess(settings, *token, clock).run(is_valid);
}

}  // namespace merlin
