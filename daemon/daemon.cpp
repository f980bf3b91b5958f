#include "daemon/daemon.h"

#include <cerrno>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "daemon/base/log.h"
#include "daemon/net/network_allowed.h"
#include "daemon/serve/spnav_server.h"
#include "daemon/serve/vrpn_server.h"
#include "daemon/shm/fields.h"
#include "daemon/state/state_folder.h"
#include "daemon/status/documents.h"
#include "daemon/status/health_events.h"
#include "daemon/status/run_directory.h"
#include "daemon/status/wall_events.h"

namespace merlin {
namespace {

constexpr Duration kBeat = std::chrono::milliseconds(100);
constexpr Duration kSummary = std::chrono::seconds(5);
constexpr Duration kOnceASecond = std::chrono::seconds(1);
constexpr Duration kSixtyASecond = std::chrono::microseconds(16'667);

sigset_t takenSignals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int s : {SIGTERM, SIGINT, SIGHUP, SIGCHLD}) ::sigaddset(&set, s);
  return set;
}

// Half of systemd's watchdog time; zero if there is no watchdog.
Duration watchdogInterval() {
  std::uint64_t usec = 0;
  return ::sd_watchdog_enabled(0, &usec) > 0 ? Duration(std::chrono::microseconds(usec / 2))
                                             : Duration{};
}

// Ends the process after 20 s: a thread that hangs, for example in a file system that does not
// answer, cannot be joined.
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

// Puts the JSON pointer of a setting before an error's text.
Error errorAt(const char* pointer, const Error& error) {
  return {error.code, fmt::format("{}: {}", pointer, error.what)};
}

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::make(Configuration configuration,
                                             const DaemonOptions& options, Clock& clock) {
  std::unique_ptr<Daemon> daemon(new Daemon(std::move(configuration), options, clock));
  auto directory = status::runDirectory(daemon->settings_.run_directory);
  if (!directory) return directory.error();
  daemon->run_directory_ = *std::move(directory);
  daemon->settings_.run_directory = daemon->run_directory_;
  if (const auto made = daemon->makeRoles(); !made) return made.error();
  return daemon;
}

Daemon::Daemon(Configuration configuration, const DaemonOptions& options, Clock& clock)
    : settings_(std::move(configuration.loaded.settings)),
      models_(std::move(configuration.models)),
      options_(options),
      clock_(clock),
      watchdog_(watchdogInterval()),
      servers_(std::in_place, options.devices ? "devices" : "wall", threads_, clock) {}

Daemon::~Daemon() { limitStop(); }

shm::Endpoints Daemon::endpoints(const std::string& role) const {
  const std::string at = fmt::format("ipc://{}/{}-{}", run_directory_, settings_.instance, role);
  return {at + ".status", at + ".command"};
}

// Creates the shared-memory segments before the sockets: whoever holds the segments' locks knows
// that no other daemon of this name runs, and may replace the sockets' files. Starts the emulators
// before any thread, because they are forked.
Result<Ok> Daemon::makeRoles() {
  const std::uint64_t generation = shm::newGeneration();
  for (const char* role : {"devices", "wall"}) {
    // Checked before the emulators start, because they would replace the links to another daemon's
    // pseudo-terminals.
    const std::string name = shm::segmentName(settings_.instance, role);
    if ((role[0] == 'd' ? options_.devices : options_.wall) && SharedMemory::owned(name)) {
      return Error{
          Errc::kBusy,
          fmt::format(
              "another merlind already runs as \"{}\" (it owns shared memory {}); stop it, or "
              "set another \"instance\"",
              settings_.instance, name)};
    }
  }
  if (options_.emulate && options_.devices) {
    auto started = EmulatorChildren::start(settings_, run_directory_);
    if (!started) return started.error();
    emulators_ = std::make_unique<EmulatorChildren>(*std::move(started));
  }
  if (options_.devices) {
    auto role =
        devices::DevicesRole::make(settings_, generation, endpoints("devices"), threads_, clock_);
    if (!role) return role.error();
    devices_ = *std::move(role);
  }
  if (options_.wall && !settings_.wall.input.endpoint.empty()) {
    if (auto mirrored = mirrorDevices(generation); !mirrored) return mirrored;
  }
  if (options_.wall) {
    makeKeeper();
    auto role = wall::WallRole::make(settings_, std::move(models_), generation, endpoints("wall"),
                                     *keeper_, threads_, clock_);
    if (!role) return role.error();
    wall_ = *std::move(role);
  }
  makeSnapshots();
  return Ok{};
}

// Creates a shared-memory segment for devices on this machine and fills it with the samples of
// another machine; the wall reads it like the segment of local devices.
Result<Ok> Daemon::mirrorDevices(std::uint64_t generation) {
  const InputSettings& input = settings_.wall.input;
  auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(settings_.instance, "devices"), shm::devicesFields(), generation,
      clock_.now(), {});
  if (!segment) return segment.error();
  mirror_.emplace(*std::move(segment));
  if (const auto allowed = net::networkAllowed(); !allowed) {
    services_.failed("input", "/wall/input/endpoint: " + allowed.error().what);
    return Ok{};
  }
  auto keys = status::readKeyPair(input.keys);
  if (!keys) return keys.error();
  auto link = status::SampleLink::start({input.endpoint, input.server_key, *std::move(keys)},
                                        **mirror_, threads_, clock_);
  if (!link) return link.error();
  link_ = *std::move(link);
  return Ok{};
}

void Daemon::makeKeeper() {
  const std::string file = state::stateFile(settings_.state_file, settings_.instance);
  keeper_ = std::make_unique<state::StateKeeper>(
      file.empty() ? nullptr : std::make_unique<state::StateFolder>(file), threads_);
}

void Daemon::serveOthers(const shm::DevicesSegment& segment) {
  const ServeSettings& s = settings_.serve;
  if (!s.spnav_socket.empty()) {
    servers_->keep("space mouse", [this, &segment]() -> Result<std::unique_ptr<net::Server>> {
      auto server =
          serve::SpnavServer::start(settings_.serve.spnav_socket, segment, threads_, clock_);
      if (!server) return errorAt("/serve/spnav_socket", server.error());
      return std::unique_ptr<net::Server>(*std::move(server));
    });
  }
  if (s.vrpn_port > 0) {
    servers_->keep("VRPN", [this, &segment]() -> Result<std::unique_ptr<net::Server>> {
      auto server = serve::VrpnServer::start(settings_.serve.vrpn_port, segment, threads_, clock_);
      if (!server) return errorAt("/serve/vrpn_port", server.error());
      return std::unique_ptr<net::Server>(*std::move(server));
    });
  }
}

Result<status::CurveServer> Daemon::network() const {
  const ServeSettings& s = settings_.serve;
  if (s.samples_endpoint.empty()) return status::CurveServer{};
  auto keys = status::readKeyPair(s.samples_keys);
  if (!keys) return keys.error();
  auto clients = status::readPublicKeys(s.samples_clients);
  if (!clients) return clients.error();
  return status::CurveServer{s.samples_endpoint, *std::move(keys), *std::move(clients)};
}

void Daemon::makeSnapshots() {
  if (wall_ && !settings_.wall.snapshots.empty()) {
    snapshots_ = std::make_unique<wall::SnapshotWriter>(
        shm::segmentName(settings_.instance, "framebuffer"),
        DatedFiles(settings_.wall.snapshots, settings_.instance, ".png",
                   static_cast<std::size_t>(settings_.wall.snapshots_kept)),
        threads_);
    wall_->onSnapshot([this] { snapshots_->take(); });
  }
  commands_.emplace(
      RoleCommands::Parts{devices_.get(), wall_.get(), snapshots_.get(), keeper_.get()});
}

// A person at a window gives commands, as clients of the sockets do.
void Daemon::serveWindows() {
  wall_->onWindow({[this](const std::string& name, const std::string& argument) {
                     return commands_->run(name, argument);
                   },
                   [this](const std::string& why) {
                     logInfo("{}", why);
                     closed_ = true;
                   }});
}

// Executes the actions that the role devices and the panel are responsible for. Actions for walls
// are executed by the walls.
void Daemon::executeActions() {
  for (const std::size_t action : device_actions_.read(devices_->segment()).in_order) {
    const CommandInfo* const command = findCommand(kActions[action]);
    if (command->role == CommandOf::kWall) continue;
    const auto done = commands_->run(command->name);
    if (!done) logWarning("an input's action failed: {}", done.error().what);
  }
}

Result<Ok> Daemon::run() {
  const Timestamp now = clock_.now();
  if (devices_) {
    devices_->beat(now);
    devices_->start();
    if (auto served = serveDevices(); !served) return served;
    serveOthers(devices_->segment());
  }
  if (wall_) {
    wall_->beat(now);
    if (mirror_) {
      mirror_->beat(now);
    }
    if (auto served = serveWall(); !served) return served;
    if (mirror_) serveOthers(**mirror_);
    serveWindows();
    if (auto shown = awaitFirstFrame(wall_->start()); !shown) return shown;
  }
  ::sd_notify(0, "READY=1");
  logInfo("ready");
  while (!stopAsked(kBeat)) {
    housekeeping();
    if (const auto ended = ended_threads_.check(clock_.now())) return *ended;
  }
  ::sd_notify(0, "STOPPING=1");
  logInfo("stopping");
  return Ok{};
}

Result<Ok> Daemon::awaitFirstFrame(std::future<Result<std::string>> ready) {
  while (ready.wait_for(std::chrono::milliseconds(0)) != std::future_status::ready) {
    if (stopAsked(kBeat)) return Error{Errc::kClosed, "stopped before the first frame"};
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
// on_close is "stop". An ended emulator (SIGCHLD) is
// reported by housekeeping().
bool Daemon::stopAsked(Duration wait) {
  const sigset_t set = takenSignals();
  const timespec limit{0, wait.count()};
  const int signal = ::sigtimedwait(&set, nullptr, &limit);
  if (signal == SIGHUP)
    logInfo("SIGHUP is ignored: restart merlind to read a changed configuration");
  return signal == SIGTERM || signal == SIGINT || closed_;
}

void Daemon::housekeeping() {
  const Timestamp now = clock_.now();
  if (devices_) devices_->beat(now);
  if (wall_) tendWall(now);
  if (mirror_) mirror_->beat(now);
  if (devices_) executeActions();
  servers_->tend(now);
  if (emulators_) {
    for (const std::string& device : emulators_->takeEnded()) {
      logWarning("the emulated {} has ended; start it again with: merlin emulate {} --link ...",
                 device, device);
    }
  }
  if (now - mended_ >= kOnceASecond) {
    mended_ = now;
    mendSharedMemory();
  }
  if (now - summarised_ >= kSummary) {
    summarised_ = now;
    ::sd_notify(0, ("STATUS=" + summary(now)).c_str());
  }
  pingWatchdog(now);
}

void Daemon::tendWall(Timestamp now) {
  wall_->beat(now);
  wall_->tend(now);
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
  if (mirror_) look(mirror_->mend());
  if (wall_) look(wall_->mend());
  happened.empty() ? services_.ok("shared memory") : services_.failed("shared memory", happened);
}

void Daemon::pingWatchdog(Timestamp now) {
  if (watchdog_.ping(now, threads_.threads())) ::sd_notify(0, "WATCHDOG=1");
}

std::string Daemon::summary(Timestamp now) const {
  std::string text;
  if (wall_) {
    const auto s = wall_->segment().stats.read().value_or(shm::WallStats{});
    text = fmt::format("{:.1f} of {:.0f} Hz, {} {}, {:.1f} % late", s.rate_held_hz, s.rate_asked_hz,
                       s.cost, std::string_view(s.cost_unit), 100 * s.late_share_1min);
  }
  for (std::size_t i = 0; devices_ && i < shm::kDevices; ++i) {
    const auto health = devices_->segment().health[i].read();
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", status::kDeviceNames[i],
                        health ? status::healthName(*health, now) : "absent");
  }
  return text;
}

Result<Ok> Daemon::serveStatus(const std::string& role, CommandOf commands,
                               status::StatusServerSettings settings) {
  const shm::Endpoints at = endpoints(role);
  settings.status_endpoint = at.status;
  settings.command_endpoint = at.command;
  const auto status = settings.publications[0].document;
  settings.commands = commands_->of(commands);
  if (commands == CommandOf::kDevices) {
    for (auto& command : commands_->of(CommandOf::kPanel))
      settings.commands.push_back(std::move(command));
  }
  settings.commands.insert(settings.commands.begin(),
                           {"status", std::string(findCommand("status")->help),
                            [status]() -> Result<std::string> { return status(); }});
  return servers_->startRole(role, std::move(settings));
}

Result<Ok> Daemon::serveDevices() {
  const shm::DevicesSegment& segment = devices_->segment();
  status::StatusServerSettings s;
  const auto statusNow = [this, &segment] {
    return services_.addTo(
        status::devicesStatus(segment, clock_.now(), servers_->health("devices")));
  };
  s.publications = {
      {"status", kOnceASecond, statusNow},
      {"metrics", kOnceASecond, [&segment] { return status::devicesMetrics(segment); }},
      {"sample", kSixtyASecond,
       [this, &segment] { return status::newestSamples(segment, clock_.now()); }}};
  auto network_settings = network();
  if (!network_settings) return network_settings.error();
  s.network = *std::move(network_settings);
  // Shared because a std::function must be copyable.
  auto events = std::make_shared<status::HealthEvents>(segment);
  s.events = [this, events] {
    std::vector<std::string> documents;
    const Timestamp now = clock_.now();
    for (const std::string& sentence : events->take(now)) {
      logInfo("{}", sentence);
      documents.push_back(status::event("device", sentence, now));
    }
    for (const std::string& sentence : devices_->flight().check()) {
      logInfo("{}", sentence);
      documents.push_back(status::event("flight", sentence, now));
    }
    for (const std::string& sentence : servers_->events("devices")) {
      logInfo("{}", sentence);
      documents.push_back(status::event("server", sentence, now));
    }
    tellServices(documents);
    return documents;
  };
  return serveStatus("devices", CommandOf::kDevices, std::move(s));
}

// Logs the services' events and adds them to `documents`. Each event is delivered once, to the role
// whose server asks first.
void Daemon::tellServices(std::vector<std::string>& documents) {
  for (const std::string& sentence : services_.takeEvents()) {
    logWarning("{}", sentence);
    documents.push_back(status::event("service", sentence, clock_.now()));
  }
}

// Returns the function that collects the events of the role wall: those of the wall, its models and
// its servers, and, if the wall uses another machine's devices, those of the devices.
std::function<std::vector<std::string>()> Daemon::wallEvents() {
  // Shared because a std::function must be copyable.
  auto events = std::make_shared<status::WallEvents>(wall_->segment());
  auto health = mirror_ ? std::make_shared<status::HealthEvents>(**mirror_) : nullptr;
  return [this, events, health] {
    std::vector<std::string> documents;
    const auto tell = [&](const char* kind, const std::vector<std::string>& sentences) {
      for (const std::string& sentence : sentences) {
        logInfo("{}", sentence);
        documents.push_back(status::event(kind, sentence, clock_.now()));
      }
    };
    tell("wall", events->take());
    tell("wall", wall_->viewerEvents());
    tell("model", wall_->modelEvents());
    tell("state", keeper_->takeNotices());
    if (health) tell("device", health->take(clock_.now()));
    tell("server", servers_->events("wall"));
    tellServices(documents);
    return documents;
  };
}

Result<Ok> Daemon::serveWall() {
  const shm::WallSegment& segment = wall_->segment();
  status::StatusServerSettings s;
  const auto statusNow = [this, &segment] {
    return services_.addTo(status::wallStatus(segment, clock_.now(), servers_->health("wall"),
                                              mirror_ ? &**mirror_ : nullptr));
  };
  s.publications = {{"status", kOnceASecond, statusNow},
                    {"metrics", kOnceASecond, [&segment] { return status::wallMetrics(segment); }}};
  s.events = wallEvents();
  return serveStatus("wall", CommandOf::kWall, std::move(s));
}

}  // namespace merlin
