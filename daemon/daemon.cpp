#include "daemon/daemon.h"

#include <cerrno>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "daemon/base/log.h"
#include "daemon/role_signals.h"
#include "daemon/state/state_folder.h"
#include "daemon/status/documents.h"
#include "daemon/status/run_directory.h"

namespace merlin {
namespace {

constexpr Duration kSignalWait = std::chrono::milliseconds(100);
constexpr Duration kSummary = std::chrono::seconds(5);
constexpr Duration kMendInterval = std::chrono::seconds(1);
constexpr const char* kLongWatchdog = "WATCHDOG_USEC=600000000";

sigset_t takenSignals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) ::sigaddset(&set, s);
  return set;
}

// Notifies systemd that the service is ready, and resets the watchdog time to that of the unit,
// because tellEnd() has lengthened it if this program has restarted itself.
void tellReady() {
  std::uint64_t usec = 0;
  const bool watched = ::sd_watchdog_enabled(0, &usec) > 0;
  ::sd_notify(0, watched ? fmt::format("READY=1\nWATCHDOG_USEC={}", usec).c_str() : "READY=1");
}

// Makes an alarm end the process in 20 s, because a thread that hangs, for example in a file system
// that does not answer, cannot be joined.
void limitStop() {
  constexpr unsigned kSeconds = 20;  // less than systemd's stop time-out
  ::signal(SIGALRM, [](int) {
    constexpr std::string_view kWhy = "merlind: a thread does not stop; the process ends now\n";
    const auto written = ::write(STDERR_FILENO, kWhy.data(), kWhy.size());
    ::_exit(written > 0 ? 1 : 2);
  });
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGALRM);
  ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  ::alarm(kSeconds);
}

// Returns the error kBusy if a running daemon owns the segment of one of these roles. To be called
// before the emulators start, because they would replace the links to another daemon's
// pseudo-terminals.
Result<Ok> checkNotRunning(const std::string& instance, const DaemonOptions& roles) {
  for (const auto& [role, wanted] :
       {std::pair{"devices", roles.devices}, std::pair{"wall", roles.wall}}) {
    const std::string name = shm::segmentName(instance, role);
    if (!wanted || !SharedMemory::owned(name)) continue;
    return Error{
        Errc::kBusy,
        fmt::format("another merlind already runs as \"{}\" (it owns shared memory {}); stop it, "
                    "or set another \"instance\"",
                    instance, name)};
  }
  return Ok{};
}

wall::ProjectorsSeen seenOf(const pjlink::ProjectorState& state) {
  return wall::projectorSeen(pjlink::powerName(state.power), state.wanted);
}

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::make(Configuration configuration,
                                             const DaemonOptions& options, Clock& clock) {
  std::unique_ptr<Daemon> daemon(new Daemon(std::move(configuration), options, clock));
  auto directory = status::runDirectory(daemon->settings_.run_directory);
  if (!directory) return directory.error();
  daemon->settings_.run_directory = *std::move(directory);
  if (const auto made = daemon->makeRoles(); !made) return made.error();
  return daemon;
}

Daemon::Daemon(Configuration configuration, const DaemonOptions& options, Clock& clock)
    : settings_(configuration.loaded.settings),
      configured_{std::move(configuration.loaded.settings), {}},
      file_(std::move(configuration.file)),
      instead_of_(std::move(configuration.instead_of)),
      contents_(std::move(configuration.contents)),
      options_(options),
      clock_(clock),
      watchdog_(watchdogInterval()) {
  configured_.named = readNamedFiles(configured_.settings);  // before any part reads them
}

Daemon::~Daemon() { limitStop(); }

// Creates the shared-memory segments before the sockets: whoever holds the segments' locks knows
// that no other daemon of this name runs, and may replace the sockets' files. Starts the emulators
// before any thread, because they are forked.
Result<Ok> Daemon::makeRoles() {
  const std::uint64_t generation = shm::newGeneration();
  if (const auto free = checkNotRunning(settings_.instance, options_); !free) return free;
  if (options_.emulate && options_.devices) {
    auto started = EmulatorChildren::start(settings_, settings_.run_directory);
    if (!started) return started.error();
    emulators_ = std::make_unique<EmulatorChildren>(*std::move(started));
  }
  if (options_.devices) {
    auto role = devices::DevicesRole::make(settings_, generation, endpointsOf(settings_, "devices"),
                                           threads_, clock_);
    if (!role) return role.error();
    devices_ = *std::move(role);
  }
  makeKeeper();
  if (options_.wall && !settings_.wall.input.endpoint.empty()) {
    auto remote = RemoteDevices::make(settings_, generation, services_, threads_, clock_);
    if (!remote) return remote.error();
    remote_devices_ = *std::move(remote);
  }
  if (options_.wall) {
    keepCrashFrame();
    auto role = wall::WallRole::make(settings_, std::move(contents_), generation,
                                     endpointsOf(settings_, "wall"), *keeper_, kept_files_,
                                     threads_, clock_);
    if (!role) return role.error();
    wall_ = *std::move(role);
    const std::string& uncorrected = wall_->outputs().uncorrected();
    if (!uncorrected.empty()) services_.failed("correction", uncorrected);
    if (keeper_->state().playlist_off) wall_->attendance().switchPlaylist(false);
  }
  connectRoles();
  return Ok{};
}

// Makes the keeper of the state file if this process has a wall or projectors.
void Daemon::makeKeeper() {
  devices::Projectors* const projectors = devices_ ? devices_->projectors() : nullptr;
  if (!options_.wall && !projectors) return;
  const std::string file =
      state::stateFile(settings_.state_file, settings_.instance, options_.wall);
  keeper_ = std::make_unique<state::StateKeeper>(
      file.empty() ? nullptr : std::make_unique<state::StateFolder>(file), threads_);
  settings_.wall.shown.folder =
      state::shownFolder(settings_.wall.shown.folder, file, settings_.instance);
  if (!projectors) return;
  std::optional<devices::PersonsSwitch> last;
  if (const auto kept = keeper_->state().projectors) last = {kept->on, kept->local_minute};
  projectors->remember(last, [this](const devices::PersonsSwitch& person) {
    keeper_->change([&](state::State& s) { s.projectors = {person.on, person.at}; });
  });
}

// Saves the last frame of a run that crashed, beside the devices' flight recordings. To be called
// before the wall makes its own frame buffer.
void Daemon::keepCrashFrame() {
  auto frame = wall::frameOfCrash(shm::segmentName(settings_.instance, "framebuffer"));
  if (!frame) return;
  constexpr std::size_t kKept = 8;
  crash_frame_ = std::make_unique<wall::CrashFrame>(
      *std::move(frame),
      DatedFiles(settings_.run_directory + "/flight", settings_.instance + "-wall", ".png", kKept),
      threads_);
}

// Makes the parts that execute the roles' commands, and the servers that receive them.
void Daemon::connectRoles() {
  if (wall_ && !settings_.wall.snapshots.empty()) {
    snapshots_ = std::make_unique<wall::SnapshotWriter>(
        shm::segmentName(settings_.instance, "framebuffer"),
        DatedFiles(settings_.wall.snapshots, settings_.instance, ".png",
                   static_cast<std::size_t>(settings_.wall.snapshots_kept)),
        threads_);
    wall_->onSnapshot([this] { snapshots_->take(); }, [this] { return snapshots_->written(); });
  }
  // The main loop waits for SIGCHLD anyway; sending it starts a round of the loop.
  const auto wake = [main = ::pthread_self()] { ::pthread_kill(main, SIGCHLD); };
  const GpioSettings& gpio = settings_.devices.gpio;
  if (devices_ && devices_->panel() && gpio.lamp_line >= 0 && gpio.lamp_warns)
    wall_fault_ = std::make_unique<devices::WallFault>(settings_.instance);
  if (wall_ && !devices_ && !remote_devices_)
    devices_beside_ = std::make_unique<DevicesBeside>(settings_.instance);
  reloader_.emplace(file_, options_, std::move(configured_), settings_,
                    Reloader::Parts{devices_.get(), wall_.get(), services_, threads_, clock_, wake,
                                    keeper_.get()});
  commands_.emplace(RoleCommands::Parts{devices_.get(), wall_.get(), snapshots_.get(),
                                        keeper_.get(), &*reloader_, devices_beside_.get()},
                    clock_);
  servers_.emplace(RoleServers::Parts{settings_, *commands_, services_, devices_.get(),
                                      remote_devices_.get(), wall_.get(), keeper_.get()},
                   threads_, clock_);
}

// Lets a person at a window send the same commands as clients of the sockets, and stop merlind by
// closing the window.
void Daemon::serveWindows() {
  wall_->onWindow({[this](const std::string& name, const std::string& argument) {
                     return commands_->run(name, argument);
                   },
                   [this](const std::string& why) {
                     logInfo("{}", why);
                     closed_ = true;
                   }});
}

// Executes the bound actions that belong to the role devices and its control panel. Each wall
// executes its own actions.
void Daemon::executeActions() {
  for (const std::size_t action : device_actions_.read(devices_->slots()).in_order) {
    if (action >= kActions.size()) continue;  // shared memory may be written by other processes
    const CommandInfo* const command = findCommand(kActions[action]);
    if (command->role == CommandOf::kWall) continue;
    const auto done = commands_->run(command->name);
    if (!done) logWarning("an action bound to an input failed: {}", done.error().what);
  }
}

// Switches the warning of the control panel's lamp on while the wall needs somebody, and off again.
void Daemon::tendLamp(Timestamp now) {
  std::string why = wall_fault_->look(now);
  devices_->panel()->warn(!why.empty());
  if (why.empty() != warned_of_.empty())
    logInfo("the panel's lamp {}", why.empty() ? "warns no longer" : "warns: " + why);
  warned_of_ = std::move(why);
}

// Executes the commands that the ball has requested on the operator's panel, and passes the state
// of the projectors to the panel.
void Daemon::tendPanel() {
  commands_->runPanel();
  if (devices_beside_) {
    devices_beside_->update(clock_.now(),
                            [this](const std::string& why) { wall_->panel()->refuse(why); });
    return wall_->panel()->report(wall::together(devices_beside_->projectors()));
  }
  if (!devices_ || !devices_->projectors()) return;
  std::vector<wall::ProjectorsSeen> all;
  for (const pjlink::ProjectorState& state : devices_->projectors()->states())
    all.push_back(seenOf(state));
  if (const auto at_line = devices_->panelProjectors()) all.push_back(seenOf(*at_line));
  wall_->panel()->report(wall::together(all));
}

Result<Ok> Daemon::run() {
  const Timestamp now = clock_.now();
  if (devices_) {
    devices_->writeHeartbeat(now);
    devices_->start();
    if (auto started = servers_->startDevices(); !started) return started;
  }
  if (wall_) {
    wall_->writeHeartbeat(now);
    if (remote_devices_) remote_devices_->writeHeartbeat(now);
    if (auto started = servers_->startWall(); !started) return started;
    serveWindows();
    if (auto shown = awaitFirstFrame(wall_->start()); !shown) return shown;
  }
  kept_files_.forgetUntaken();  // the cards that are used were opened before the first frame
  tellReady();
  was_ready_ = true;
  logInfo("ready");
  keepLastGood();
  while (!starts_again_ && !stopAsked(kSignalWait)) {
    housekeeping();
    tendReload();
    // Not before READY=1: a ping arms systemd's watchdog, and the first frame may take longer.
    if (watchdog_.ping(clock_.now(), threads_.threads())) ::sd_notify(0, "WATCHDOG=1");
    if (const auto ended = ended_threads_.check(clock_.now())) return *ended;
  }
  tellEnd();
  return Ok{};
}

void Daemon::tendReload() {
  const Reloader::Done done = reloader_->tend();
  if (done == Reloader::Done::kSwapped && last_good_) last_good_->keep(reloader_->configured());
  starts_again_ = done == Reloader::Done::kRestart;
}

// To systemd, a program that starts itself again has not stopped; its watchdog time is lengthened,
// because reading a large model takes long.
void Daemon::tellEnd() const {
  ::sd_notify(0, starts_again_ ? kLongWatchdog : "STOPPING=1");
  logInfo("{}", starts_again_ ? "starting again" : "stopping");
}

// Keeps the configuration as the last good one, now that merlind runs with it.
void Daemon::keepLastGood() {
  if (!instead_of_.empty()) services_.failed("configuration", instead_of_);
  if (options_.last_good.empty()) return;
  last_good_ = std::make_unique<LastGoodKeeper>(options_.last_good, file_, threads_);
  if (instead_of_.empty()) last_good_->keep(reloader_->configured());
}

Result<Ok> Daemon::awaitFirstFrame(std::future<Result<std::string>> ready) {
  while (ready.wait_for(std::chrono::milliseconds(0)) != std::future_status::ready) {
    if (stopAsked(kSignalWait)) return Error{Errc::kClosed, "stopped before the first frame"};
    housekeeping();
    if (ready.wait_for(std::chrono::milliseconds(0)) == std::future_status::ready) break;
    if (const auto ended = ended_threads_.check(clock_.now())) return *ended;
  }
  const auto first = ready.get();
  if (!first) return first.error();
  logInfo("the first frame is shown, drawn by {}; {} levels of detail", *first,
          wall_->segment().stats.read()->detail_steps);
  return Ok{};
}

// Waits up to `wait` for a signal; true for SIGTERM and SIGINT, and once a window was closed whose
// on_close is "stop". An ended emulator (SIGCHLD) is reported by housekeeping().
bool Daemon::stopAsked(Duration wait) {
  const sigset_t set = takenSignals();
  const timespec limit{0, wait.count()};
  const int signal = ::sigtimedwait(&set, nullptr, &limit);
  if (signal == SIGHUP) reloader_->request();
  return signal == SIGTERM || signal == SIGINT || closed_;
}

void Daemon::housekeeping() {
  const Timestamp now = clock_.now();
  if (devices_) devices_->writeHeartbeat(now);
  if (wall_) wall_->writeHeartbeat(now);
  if (wall_) wall_->tend(now);
  if (keeper_) tendState();
  if (remote_devices_) remote_devices_->writeHeartbeat(now);
  if (devices_) executeActions();
  if (wall_ && wall_->panel()) tendPanel();
  if (devices_ && devices_->projectors()) devices_->projectors()->tend();
  servers_->tend(now);
  if (emulators_) {
    for (const auto& [device, driver] : emulators_->takeEnded()) {
      logWarning("the emulated {} has ended; start it again with: merlin emulate {} --link ...",
                 device, driver);
    }
  }
  if (now - mended_ >= kMendInterval) {
    mended_ = now;
    mendSharedMemory();
    if (wall_fault_) tendLamp(now);
  }
  if (now - summarised_ >= kSummary) {
    summarised_ = now;
    ::sd_notify(0, ("STATUS=" + summary(now)).c_str());
  }
}

void Daemon::tendState() {
  if (const std::string fault = keeper_->fault(); fault.empty())
    services_.ok("state");
  else
    services_.failed("state", fault);
}

// Restores shared memory that was removed by an administrator, or by logind when its user logs out.
void Daemon::mendSharedMemory() {
  std::string happened;
  const auto look = [&happened](const Result<std::string>& mended) {
    const std::string& what = mended ? *mended : mended.error().what;
    if (!what.empty()) happened = what;
  };
  if (devices_) look(devices_->mend());
  if (remote_devices_) look(remote_devices_->mend());
  if (wall_) look(wall_->mend());
  happened.empty() ? services_.ok("shared memory") : services_.failed("shared memory", happened);
}

std::string Daemon::summary(Timestamp now) const {
  std::string text;
  if (wall_) {
    const auto s = wall_->segment().stats.read().value_or(shm::WallStats{});
    text = fmt::format("{:.1f} of {:.0f} Hz, {} {}, {:.1f} % late", s.rate_held_hz, s.rate_asked_hz,
                       s.cost, std::string_view(s.cost_unit), 100 * s.late_share_1min);
  }
  if (!devices_) return text;
  for (const auto& [device, slot] : devices_->slots().health) {
    const auto health = slot->read();
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", device,
                        health ? shm::healthName(*health, now) : "absent");
  }
  return text;
}

}  // namespace merlin
