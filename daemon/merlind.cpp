// merlind: the daemon. The only place where an adapter meets a port: read the configuration, make
// everything, run, stop.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "config/loader.h"
#include "config/writer.h"
#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/daemon.h"
#include "daemon/devices/posture_bindings.h"
#include "render/gl/gl_context.h"

namespace merlin {
namespace {

struct Options {
  std::string config = "/etc/merlin/merlin.json";
  std::string check;
  std::string role = "all";
  bool emulate = false;
  bool print_config = false;
  bool print_schema = false;
};

void printFindings(const std::string& file, const LoadedSettings& loaded) {
  for (const Finding& finding : loaded.findings) fmt::print(stderr, "{}\n", toText(file, finding));
}

// With what other files have to say; a process that draws the wall alone reads no postures.
LoadedSettings loadConfig(const std::string& file, const std::string& role) {
  LoadedSettings loaded = loadSettingsFile(file);
  if (role != "wall") devices::checkPostures(loaded);
  printFindings(file, loaded);
  return loaded;
}

int checkConfig(const std::string& file, const std::string& role) {
  const LoadedSettings loaded = loadConfig(file, role);
  switch (loaded.verdict()) {
    case LoadedSettings::Verdict::kValid: fmt::print("{}: valid\n", file); return 0;
    case LoadedSettings::Verdict::kAdjusted:
      fmt::print("{}: valid after {} adjustments\n", file, loaded.findings.size());
      return 1;
    case LoadedSettings::Verdict::kInvalid: break;
  }
  fmt::print("{}: invalid, {} findings\n", file, loaded.findings.size());
  return 2;
}

// Every thread inherits this mask; the main loop takes the signals one by one.
void blockSignals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) ::sigaddset(&set, s);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // None of these means anything to merlind; SIGXFSZ: a file's limit is an error of the write.
  for (const int s : {SIGPIPE, SIGXFSZ, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF})
    ::signal(s, SIG_IGN);
}

// Servers bound their connections; what is needed for all of them together must not be missing.
void raiseDescriptorLimit() {
  constexpr rlim_t kEnough = 8192;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kEnough) return;
  limit.rlim_cur = std::min(limit.rlim_max, kEnough);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

int runDaemon(const Options& options) {
  LoadedSettings loaded = loadConfig(options.config, options.role);
  if (loaded.verdict() == LoadedSettings::Verdict::kInvalid) return kExitBadInput;
  if (options.print_config) {
    fmt::print("{}", settingsText(loaded.settings));
    return kExitDone;
  }
  blockSignals();
  raiseDescriptorLimit();
  render::prepareSoftwareGl(loaded.settings.wall.render.raster_threads);
  SystemClock clock;
  DaemonOptions daemon_options;
  daemon_options.devices = options.role != "wall";
  daemon_options.wall = options.role != "devices";
  daemon_options.emulate = options.emulate;
  const auto daemon = Daemon::make(std::move(loaded.settings), daemon_options, clock);
  if (!daemon) {
    logError("{}", daemon.error().what);
    return exitStatus(daemon.error());
  }
  const auto ran = (*daemon)->run();
  if (ran) return kExitDone;
  logError("{}", ran.error().what);
  return ran.error().code == Errc::kClosed ? kExitDone : exitStatus(ran.error());
}

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "MERLIN's daemon: reads the devices, draws the wall.\n\nExample: merlind --config "
      "config/demo.json --emulate");
  app.add_option("--config", options.config, "The configuration, JSON")->capture_default_str();
  app.add_option("--check-config", options.check,
                 "Only check FILE: exits 0 valid, 1 adjusted, 2 invalid")
      ->type_name("FILE");
  app.add_option("--role", options.role, "What this process does")
      ->check(CLI::IsMember({"devices", "wall", "all"}))
      ->capture_default_str();
  app.add_flag("--emulate", options.emulate,
               "Start an emulator for each device, on pseudo-terminals");
  app.add_flag("--print-config", options.print_config,
               "Print every setting that the configuration gives, and end");
  app.add_flag("--print-schema", options.print_schema,
               "Print the JSON Schema of configurations, and end");
  app.set_version_flag("--version", MERLIN_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kExitDone : kExitBadInput;
  }
  initLog(LogLevel::kInfo);
  if (options.print_schema) {
    fmt::print("{}", settingsSchema());
    return kExitDone;
  }
  return options.check.empty() ? runDaemon(options) : checkConfig(options.check, options.role);
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  return merlin::guarded("merlind", [&] { return merlin::main(argc, argv); });
}
