// merlind: the daemon's main(): reads the configuration, makes the Daemon, runs it.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "config/loader.h"
#include "config/manual_page.h"
#include "config/usual_file.h"
#include "config/writer.h"
#include "daemon/alarms_process.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/version.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/parse_arguments.h"
#include "daemon/configuration.h"
#include "daemon/daemon.h"
#include "daemon/last_good.h"
#include "daemon/page_process.h"
#include "daemon/program_restart.h"
#include "daemon/state/state_folder.h"
#include "render/gl/gl_context.h"

namespace merlin {
namespace {

struct Options {
  std::string config = kUsualConfig;
  std::string check;
  std::string role = "all";
  bool emulate = false;
  bool last_good = false;
  bool print_config = false;
  bool print_schema = false;
  bool print_config_manual = false;
};

manual::PageSettings page() {
  return {.name = "merlind",
          .summary = "daemon of the display wall MERLIN",
          .section = 8,
          .files = {{kUsualConfig, "the configuration, described in merlin.json(5)"},
                    {"/etc/merlin/conf.d/*.json",
                     "merged over the configuration in the order of their names"},
                    {"/usr/share/merlin/merlin-devices.service.d, merlin-wall.service.d, "
                     "merlin-alarms.service.d",
                     "drop-ins for these services; each one gives its service one more permission"},
                    {"/var/lib/merlin",
                     "models, what people changed while the wall ran, and the last good settings"},
                    {"/run/merlin", "sockets for status and commands, usable by the group merlin"}},
          .see_also = {"merlin(1)", "merlin.json(5)", "systemctl(1)"}};
}

void printFindings(const std::string& file, const LoadedSettings& loaded) {
  for (const std::string& line : findingLines(file, loaded)) printError("{}\n", line);
}

DaemonOptions daemonOptions(const Options& options) {
  const bool all = options.role == "all";
  return {all || options.role == "devices",
          all || options.role == "wall",
          options.emulate,
          options.role == "page",
          options.role == "alarms",
          options.last_good ? state::lastGoodFile(options.config, options.role) : std::string()};
}

// Returns the settings to start with when the configuration is invalid. The page and the alarms,
// which save no settings, take those of the processes that they follow.
std::optional<Configuration> lastGood(const Options& options, const Configuration& broken) {
  const DaemonOptions with = daemonOptions(options);
  if (!options.last_good) return std::nullopt;
  if (!with.page && !with.alarms) return readLastGood(with.last_good, broken, with);
  for (const char* role : {"wall", "devices", "all"}) {
    auto kept = readLastGood(state::lastGoodFile(options.config, role), broken, with);
    if (kept) return kept;
  }
  return std::nullopt;
}

// Waits 5 s under systemd, because restarts in quick succession would only fill the journal.
void delayRestart() {
  if (::getenv("NOTIFY_SOCKET") == nullptr) return;  // NOLINT(concurrency-mt-unsafe)
  constexpr timespec kDelay{5, 0};
  sigset_t stop;
  ::sigemptyset(&stop);
  ::sigaddset(&stop, SIGTERM);
  ::sigaddset(&stop, SIGINT);
  ::sigtimedwait(&stop, nullptr, &kDelay);
}

Configuration checkedConfiguration(const std::string& file, const Options& options) {
  Configuration configuration = readConfiguration(file, daemonOptions(options));
  printFindings(file, configuration.loaded);
  return configuration;
}

int checkConfig(const Options& options) {
  const std::string file = oneLine(options.check);
  const LoadedSettings loaded = checkedConfiguration(options.check, options).loaded;
  const std::size_t findings = loaded.findings.size() + loaded.left_out;
  switch (loaded.verdict()) {
    case LoadedSettings::Verdict::kValid: fmt::print("{}: valid\n", file); return 0;
    case LoadedSettings::Verdict::kAdjusted:
      fmt::print("{}: valid after {} adjustments\n", file, findings);
      return 1;
    case LoadedSettings::Verdict::kInvalid: break;
  }
  fmt::print("{}: invalid, {} finding{}\n", file, findings, findings == 1 ? "" : "s");
  return kExitBadInput;
}

int printConfig(const Options& options) {
  LoadedSettings loaded = loadSettingsFile(options.config);
  printFindings(options.config, loaded);
  if (loaded.verdict() == LoadedSettings::Verdict::kInvalid) return kExitBadInput;
  fmt::print("{}", settingsText(loaded.settings));
  return kExitDone;
}

// Blocks the signals that the main loop waits for; every thread inherits the mask.
void blockSignals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) ::sigaddset(&set, s);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // If the program that started merlind ignored SIGCHLD, merlind could not wait for the end of a
  // child, and would report no alarm after the first one.
  ::signal(SIGCHLD, SIG_DFL);
  // Signals that have no meaning for merlind are ignored. With SIGXFSZ ignored, write() returns an
  // error when a file-size limit is exceeded.
  for (const int s : {SIGPIPE, SIGXFSZ, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU,
                      SIGIO, SIGPWR, SIGSTKFLT, SIGTSTP, SIGTTIN, SIGTTOU})
    ::signal(s, SIG_IGN);
  for (int s = SIGRTMIN; s <= SIGRTMAX; ++s) ::signal(s, SIG_IGN);
}

// Raises the limit on open files, so that the servers can accept all connections that they allow.
void raiseDescriptorLimit() {
  constexpr rlim_t kEnough = 8192;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kEnough) return;
  limit.rlim_cur = std::min(limit.rlim_max, kEnough);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

int exitStatusOf(const Result<Ok>& ran) {
  if (ran) return kExitDone;
  logError("{}", ran.error().what);
  return ran.error().code == Errc::kClosed ? kExitDone : exitStatus(ran.error());
}

// Runs the role page or alarms. To apply a changed configuration, these roles start the program
// again.
int runBeside(const Options& options, const Settings& settings, const ProgramRestart& restart) {
  const auto is_valid = [&] {
    const Configuration fresh = checkedConfiguration(options.config, options);
    if (fresh.loaded.verdict() != LoadedSettings::Verdict::kInvalid) return true;
    logWarning("{} is invalid; the previous settings stay in effect", options.config);
    return false;
  };
  SystemClock clock;
  const Result<Asked> asked = options.role == "alarms"
                                  ? Result<Asked>(runAlarms(settings, clock, is_valid))
                                  : runPage(settings, clock, is_valid);
  if (!asked) return exitStatusOf(asked.error());
  return *asked == Asked::kStartAgain ? exitStatusOf(restart.now({})) : kExitDone;
}

int runDaemon(const Options& options, const ProgramRestart& restart) {
  blockSignals();  // first, because reading a large model takes long and a signal may arrive
  Configuration configuration = checkedConfiguration(options.config, options);
  if (configuration.loaded.verdict() == LoadedSettings::Verdict::kInvalid) {
    auto kept = lastGood(options, configuration);
    if (!kept) {
      delayRestart();
      return kExitBadInput;
    }
    configuration = *std::move(kept);
    logError("{}", configuration.instead_of);
  }
  raiseDescriptorLimit();
  if (options.role == "alarms" || options.role == "page")
    return runBeside(options, configuration.loaded.settings, restart);
  const render::gl::GlSettings& gl = configuration.loaded.settings.wall.render.gl;
  render::gl::prepareSoftwareGl(gl.raster_threads, gl.gpu == render::gl::kNoGpu);
  SystemClock clock;
  auto daemon = Daemon::make(std::move(configuration), daemonOptions(options), clock);
  if (!daemon) {
    logError("{}", daemon.error().what);
    delayRestart();
    return exitStatus(daemon.error());
  }
  const Result<Ok> ran = (*daemon)->run();
  if (!ran || !(*daemon)->startsAgain()) {
    const int status = exitStatusOf(ran);
    // No delay after a fault of a process that was ready, so that its successor starts at once.
    const bool waits = !ran && !(*daemon)->wasReady() && ran.error().code != Errc::kClosed;
    daemon->reset();  // releases all lines and sockets before the delay
    if (waits) delayRestart();
    return status;
  }
  const auto kept = (*daemon)->handOver();
  daemon->reset();
  return exitStatusOf(restart.now(kept));
}

int runProgram(int argc, char** argv) {
  const ProgramRestart restart(argc, argv);
  Options options;
  CLI::App app(
      "MERLIN's daemon: reads the devices and draws the wall.\n\nExample: merlind --config "
      "config/demo.json --emulate");
  // Refuses an empty file name, for example from an unset shell variable: such a --check-config
  // must never start the daemon instead of checking a file.
  const CLI::Validator named(
      [](const std::string& file) { return std::string(file.empty() ? "names no file" : ""); }, "");
  app.add_option(
         "--config", options.config,
         "The configuration file (JSON). SIGHUP or `merlin reload` makes merlind read it again")
      ->check(named)
      ->capture_default_str();
  const CLI::Option* check =
      app.add_option(
             "--check-config", options.check,
             "Only check FILE and the files that it names, as needed for this --role. Exit "
             "status: 0 valid, 1 valid after adjustments, 2 invalid or not checked completely")
          ->check(named)
          ->type_name("FILE");
  app.add_option("--role", options.role,
                 "Role of this process: it reads the devices, draws the wall, or does both; or, "
                 "beside such a merlind, it serves the operator's web page or starts the programs "
                 "of the alarms. SIGUSR1 makes the role alarms send a test event to every alarm")
      ->check(CLI::IsMember({"devices", "wall", "all", "page", "alarms"}))
      ->capture_default_str();
  app.add_flag("--emulate", options.emulate,
               "Start an emulator for each device, on a pseudo-terminal");
  app.add_flag("--last-good", options.last_good,
               "Save the settings that merlind runs with, and start with the saved ones if the "
               "configuration is invalid; an event then says so. The roles page and alarms start "
               "with the settings that the wall or the devices saved. Wherever /state_file is, "
               "they are saved in the folder that systemd sets (StateDirectory=), else in "
               "/var/lib/merlin for root, else in $XDG_STATE_HOME/merlin or "
               "~/.local/state/merlin");
  app.add_flag("--print-config", options.print_config,
               "Print the configuration with every setting, including defaults, and exit");
  app.add_flag("--print-schema", options.print_schema,
               "Print the JSON Schema of configuration files, and exit");
  app.add_flag("--print-config-manual", options.print_config_manual,
               "Print the manual page of configuration files, merlin.json(5), and exit");
  app.set_version_flag("--version", programVersion());
  if (const auto status = parseArguments(app, argc, argv, page())) return *status;
  initLog(LogLevel::kInfo);
  if (options.print_schema || options.print_config_manual) {
    fmt::print("{}", options.print_schema ? settingsSchema() : settingsManual(programVersion()));
    return kExitDone;
  }
  if (options.print_config) return printConfig(options);
  if (check->count() == 0) return runDaemon(options, restart);
  return runGuarded(
      "merlind", [&] { return checkConfig(options); }, kExitBadInput);
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  merlin::openStandardStreams();
  return merlin::runGuarded("merlind", [&] { return merlin::runProgram(argc, argv); });
}
