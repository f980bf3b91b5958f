// merlin watch: shows the status of the daemon continuously, as a table on a terminal or as lines.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/remote.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/status_text.h"
#include "daemon/cli/watch/curses_screen.h"
#include "daemon/cli/watch/status_poller.h"
#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

constexpr int kRound_ms = 50;
constexpr Duration kWatchPatience = std::chrono::seconds(3);

struct WatchOptions {
  std::string instance = "merlin";
  double seconds = 0;
  bool json = false, lines = false;
};

bool isOver(const WatchOptions& options, Timestamp began, Timestamp now) {
  return options.seconds > 0 && toSeconds(now - began) >= options.seconds;
}

void printStatus(const WatchOptions& options, const nlohmann::ordered_json& status) {
  printOut("{}\n", options.json ? jsonText(status) : statusLine(status));
  std::fflush(stdout);
}

// Prints a status line each second for a daemon on this machine. Each role publishes its status
// every second; a line is printed after every N documents, where N is the number of roles.
int watchLines(const WatchOptions& options) {
  const auto roles = findRoles(options.instance);
  if (!roles) return fail(roles.error());
  std::vector<std::string> endpoints;
  for (const FoundRole& role : *roles) {
    const auto allowed = checkMayAsk(role.endpoints.status);
    if (!allowed) return fail(allowed.error());
    endpoints.push_back(role.endpoints.status);
  }
  const SystemClock clock;
  const Timestamp began = clock.now();
  nlohmann::ordered_json both = nlohmann::ordered_json::object();
  std::size_t documents = 0;
  const auto followed = status::follow(endpoints, {"status"}, kWatchPatience,
                                       [&](const std::string&, const std::string& document) {
                                         mergeStatus(both, document);
                                         if (++documents % roles->size() == 0)
                                           printStatus(options, both);
                                         return !isOver(options, began, clock.now());
                                       });
  if (!followed)
    return fail({followed.error().code, "the daemon has ended: " + followed.error().what});
  return kExitDone;
}

// Prints a status line each second for a daemon on another machine, which is asked for its status
// each time.
int askLines(const WatchOptions& options, const DaemonAddress& daemon) {
  SystemClock clock;
  const Timestamp began = clock.now();
  for (Timestamp due = began; !isOver(options, began, clock.now());) {
    const auto status = askStatus(daemon);
    if (!status) return fail(status.error());
    printStatus(options, *status);
    due = std::max(due + StatusPoller::kPeriod, clock.now());
    clock.sleepUntil(due, {});
  }
  return kExitDone;
}

// Shows the table until the person quits, even while no daemon runs.
int watchScreen(const WatchOptions& options, const DaemonAddress& daemon) {
  const auto possible = findRoles(daemon);
  // Missing or wrong keys end the command, because waiting would not help. After kIo, it goes on,
  // because a daemon may still start.
  if (!possible && possible.error().code != Errc::kIo) return fail(possible.error());
  const SystemClock clock;
  const Timestamp began = clock.now();
  WatchedState state;
  state.name = daemon.name();
  state.absent = "asking the daemon ...";
  StatusPoller poller(daemon);
  CursesScreen screen;
  if (const auto opened = screen.opened(); !opened) return fail(opened.error());
  for (auto key = CursesScreen::Key::kResized; key != CursesScreen::Key::kQuit;) {
    const bool changed = poller.poll(clock.now(), state);
    if (changed || key == CursesScreen::Key::kResized)
      screen.show(layOut(state, screen.size(), screen.hasUnicode()));
    if (isOver(options, began, clock.now())) break;
    key = screen.key(kRound_ms);
  }
  return kExitDone;
}

int watch(const WatchOptions& options, const DaemonAddress& daemon) {
  if (!options.json && !options.lines && CursesScreen::isPossible())
    return watchScreen(options, daemon);
  return daemon.isRemote() ? askLines(options, daemon) : watchLines(options);
}

}  // namespace

void addWatch(Command app, Run& run, RemoteOptions& remote) {
  const auto options = std::make_shared<WatchOptions>();
  Command command = app.subcommand(
      "watch",
      "Show rate, late frames, detail, content, devices, outputs, a chart of the frame times and "
      "the last events, as a table that is renewed every second; q quits. It continues when "
      "merlind is restarted. Where standard output is no terminal: one line per second.\n"
      "Example: merlin watch --lines --for 20");
  addInstance(command, options->instance);
  command.option("--for", options->seconds, "Duration in seconds; the default is until interrupted")
      .seconds();
  command.flag("--lines", options->lines, "Print one line per second, also on a terminal");
  command.flag("--json", options->json, "Print one JSON document per line");
  command.callback([options, &run, &remote] {
    run = [options, daemon = remote.daemon(options->instance)] { return watch(*options, daemon); };
  });
}

}  // namespace merlin::cli
