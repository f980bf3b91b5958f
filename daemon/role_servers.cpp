#include "daemon/role_servers.h"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "daemon/serve/spnav_server.h"
#include "daemon/serve/vrpn_server.h"
#include "daemon/status/documents.h"
#include "daemon/status/projectors.h"

namespace merlin {
namespace {

constexpr Duration kOnceASecond = std::chrono::seconds(1);
constexpr Duration kSixtyASecond = std::chrono::microseconds(16'667);

// Puts the JSON pointer of a setting before an error's text.
Error errorAt(const char* pointer, const Error& error) {
  return {error.code, fmt::format("{}: {}", pointer, error.what)};
}

// Returns the public keys in a file; none if `file` is empty.
Result<std::vector<std::string>> keysOf(const std::string& file) {
  if (file.empty()) return std::vector<std::string>();
  return status::readPublicKeys(file);
}

// Address, keys and clients of the socket that sends samples to other machines; without an address
// if none is configured. Errors: those of the files with the keys.
Result<status::CurveServer> sampleServerKeys(const ServeSettings& s) {
  if (s.samples_endpoint.empty()) return status::CurveServer{};
  auto keys = status::readKeyPair(s.samples_keys);
  if (!keys) return keys.error();
  auto clients = status::readPublicKeys(s.samples_clients);
  if (!clients) return clients.error();
  return status::CurveServer{s.samples_endpoint, *std::move(keys), {*std::move(clients), {}}};
}

// Address, keys and clients of a role's socket for other machines, at `endpoint`: the socket that
// answers requests, or that of the topics; without an address if `endpoint` is empty. Errors: those
// of the files with the keys.
Result<status::CurveServer> commandServerKeys(const ServeSettings& s, const std::string& endpoint) {
  if (endpoint.empty()) return status::CurveServer{};
  auto keys = status::readKeyPair(s.commands_keys);
  if (!keys) return keys.error();
  auto readers = keysOf(s.commands_readers), commanders = keysOf(s.commands_clients);
  if (!readers) return readers.error();
  if (!commanders) return commanders.error();
  return status::CurveServer{
      endpoint, *std::move(keys), {*std::move(readers), *std::move(commanders)}};
}

std::optional<status::RendererState> rendererState(const wall::WallRole& wall) {
  const auto report = wall.renderer();
  if (!report) return std::nullopt;
  const render::gl::RendererInfo& info = report->info;
  return status::RendererState{info.name,
                               info.vendor,
                               info.driver,
                               info.library,
                               info.node,
                               info.pci,
                               info.software,
                               report->contexts,
                               report->asynchronous ? "asynchronous" : "direct",
                               report->corrects ? "gpu" : "cpu",
                               report->correction_fault,
                               report->scan_out.drawn ? "drawn" : "copied",
                               report->scan_out.fault};
}

status::ProjectorStatus statusOf(const pjlink::ProjectorState& s, const char* kind) {
  status::ProjectorStatus status;
  status.name = s.name;
  status.kind = kind;
  status.power = pjlink::powerName(s.power);
  status.wanted = !s.wanted ? "" : *s.wanted ? "on" : "off";
  status.health = pjlink::healthName(s.health);
  status.reason = s.reason;
  status.address = s.address;
  status.identity = s.identity;
  status.lamp_hours = s.lamp_hours;
  if (s.within) status.within_s = std::ceil(toSeconds(*s.within));
  return status;
}

std::optional<status::ProjectorSwitching> nextSwitching(devices::DevicesRole& devices) {
  if (!devices.projectors()) return std::nullopt;
  const auto next = devices.projectors()->nextSwitching();
  if (!next) return std::nullopt;
  return status::ProjectorSwitching{next->at, next->on};
}

std::vector<status::ProjectorStatus> projectorStatus(devices::DevicesRole& devices) {
  std::vector<status::ProjectorStatus> all;
  if (const auto panel = devices.panelProjectors()) all.push_back(statusOf(*panel, "gpio"));
  if (!devices.projectors()) return all;
  for (const auto& state : devices.projectors()->states()) all.push_back(statusOf(state, "pjlink"));
  return all;
}

}  // namespace

shm::Endpoints endpointsOf(const Settings& settings, const std::string& role) {
  const std::string at =
      fmt::format("ipc://{}/{}-{}", settings.run_directory, settings.instance, role);
  return {at + ".status", at + ".command"};
}

void RoleServers::startServersForOthers(const shm::DeviceSlots& devices) {
  const ServeSettings& s = parts_.settings.serve;
  if (!s.spnav_socket.empty()) {
    servers_.keep("space mouse", [this, &s, &devices]() -> Result<std::unique_ptr<net::Server>> {
      auto server = serve::SpnavServer::start(s.spnav_socket, devices, watch_, clock_);
      if (!server) return errorAt("/serve/spnav_socket", server.error());
      return std::unique_ptr<net::Server>(*std::move(server));
    });
  }
  if (s.vrpn_port > 0) {
    servers_.keep("VRPN", [this, &s, &devices]() -> Result<std::unique_ptr<net::Server>> {
      auto server =
          serve::VrpnServer::start(s.vrpn_port, devices, watch_, clock_, parts_.settings.instance);
      if (!server) return errorAt("/serve/vrpn_port", server.error());
      return std::unique_ptr<net::Server>(*std::move(server));
    });
  }
}

Result<Ok> RoleServers::startStatus(const std::string& role, CommandOf commands,
                                    status::StatusServerSettings settings) {
  const shm::Endpoints at = endpointsOf(parts_.settings, role);
  settings.status_endpoint = at.status;
  settings.command_endpoint = at.command;
  const ServeSettings& serve = parts_.settings.serve;
  auto network = commandServerKeys(
      serve, commands == CommandOf::kWall ? serve.wall_endpoint : serve.devices_endpoint);
  if (!network) return network.error();
  settings.network_commands = *std::move(network);
  const auto status = settings.publications[0].document;
  settings.commands = parts_.commands.of(commands);
  const auto add = [&](CommandOf also) {
    for (auto& command : parts_.commands.of(also)) settings.commands.push_back(std::move(command));
  };
  if (commands == CommandOf::kDevices) add(CommandOf::kPanel);
  add(CommandOf::kEachRole);
  settings.commands.insert(settings.commands.begin(),
                           {"status", std::string(findCommand("status")->help),
                            [status]() -> Result<std::string> { return status(); }});
  return servers_.startRole(role, std::move(settings));
}

Result<Ok> RoleServers::startDevices() {
  const shm::DeviceSlots& devices = parts_.devices->slots();
  status::StatusServerSettings s;
  const auto statusNow = [this, &devices] {
    return parts_.services.addTo(status::addProjectors(
        status::devicesStatus(devices, clock_.now(), servers_.health("devices")),
        projectorStatus(*parts_.devices), nextSwitching(*parts_.devices)));
  };
  s.publications = {
      {"status", kOnceASecond, statusNow},
      {"metrics", kOnceASecond, [&devices] { return status::devicesMetrics(devices); }},
      {"sample", kSixtyASecond,
       [this, &devices] { return status::newestSamples(devices, clock_.now()); }}};
  auto network = sampleServerKeys(parts_.settings.serve);
  if (!network) return network.error();
  s.network = *std::move(network);
  s.network_name = "samples for other machines";
  s.network_setting = "/serve/samples_endpoint";
  // Shared because a std::function must be copyable.
  shm::DeviceSlots followed = devices;
  if (const auto* const panel = parts_.devices->panelHealth())
    followed.health.push_back({"control panel", panel});
  auto health = std::make_shared<status::HealthEvents>(std::move(followed));
  auto events = std::make_shared<RoleEvents>("devices");
  s.events = [this, events, health] { return deviceEvents(*events, *health); };
  if (auto started = startStatus("devices", CommandOf::kDevices, std::move(s)); !started)
    return started;
  startServersForOthers(devices);
  return Ok{};
}

Result<Ok> RoleServers::startWall() {
  const shm::WallSegment& segment = parts_.wall->segment();
  const shm::DeviceSlots* remote =
      parts_.remote_devices ? &parts_.remote_devices->slots() : nullptr;
  status::StatusServerSettings s;
  const auto statusNow = [this, &segment, remote] {
    const auto renderer = rendererState(*parts_.wall);
    const wall::ShownFolder& folder = parts_.wall->contents().folder();
    std::string document = status::wallStatus(segment, clock_.now(), servers_.health("wall"),
                                              remote, renderer ? &*renderer : nullptr);
    document = status::addShownFolder(document, {folder.path(), folder.limitBytes(), folder.fault(),
                                                 parts_.wall->contents().namesInFolder()});
    return parts_.services.addTo(
        status::addMissingContents(document, parts_.wall->contents().missing()));
  };
  s.publications = {{"status", kOnceASecond, statusNow},
                    {"metrics", kOnceASecond, [&segment] { return status::wallMetrics(segment); }}};
  auto network =
      commandServerKeys(parts_.settings.serve, parts_.settings.serve.wall_topics_endpoint);
  if (!network) return network.error();
  s.network = *std::move(network);
  s.network_name = "topics of the wall over the network";
  s.network_setting = "/serve/wall_topics_endpoint";
  // Shared because a std::function must be copyable.
  auto events = std::make_shared<RoleEvents>("wall");
  auto wall = std::make_shared<status::WallEvents>(segment);
  auto health = remote ? std::make_shared<status::HealthEvents>(*remote) : nullptr;
  s.events = [this, events, wall, health] { return wallEvents(*events, *wall, health.get()); };
  if (auto started = startStatus("wall", CommandOf::kWall, std::move(s)); !started) return started;
  if (remote) startServersForOthers(*remote);
  return Ok{};
}

namespace {

std::vector<Event> faultsOf(std::vector<std::string> sentences) {
  std::vector<Event> events;
  for (std::string& sentence : sentences) events.push_back(faultEvent(std::move(sentence)));
  return events;
}

}  // namespace

// Logs the events and adds them to those of the role.
void RoleServers::add(RoleEvents& to, const EventKind& kind,
                      const std::vector<Event>& events) const {
  for (const Event& event : events) {
    to.logger.log(kind, event, clock_.now());
    if (parts_.wall) parts_.wall->tell(event.what);
    to.documents.push_back(status::event(kind.name, event, clock_.now()));
  }
}

// Adds the events of the services, and returns all collected documents. Each event of a service is
// delivered once, to the role whose server asks first.
std::vector<std::string> RoleServers::taken(RoleEvents& events) const {
  add(events, kServiceEvent, parts_.services.takeEvents());
  events.logger.tellLeftOut(clock_.now());
  return std::exchange(events.documents, {});
}

std::vector<std::string> RoleServers::deviceEvents(RoleEvents& events,
                                                   status::HealthEvents& health) {
  add(events, kDeviceEvent, health.take(clock_.now()));
  add(events, kGestureEvent, health.takeGestures());
  if (devices::Projectors* const projectors = parts_.devices->projectors())
    add(events, kProjectorEvent, projectors->takeEvents());
  if (!parts_.wall && parts_.keeper)
    add(events, kStateEvent, faultsOf(parts_.keeper->takeNotices()));
  add(events, kFlightEvent, parts_.devices->flight().check());
  add(events, kServerEvent, servers_.events("devices"));
  return taken(events);
}

// Returns the documents of the new events of the wall, its contents and its servers and, if the
// wall uses another machine's devices, of these devices.
std::vector<std::string> RoleServers::wallEvents(RoleEvents& events, status::WallEvents& wall,
                                                 status::HealthEvents* remote) {
  add(events, kWallEvent, wall.take());
  add(events, kPictureEvent, wall.takePictures());
  add(events, kWallEvent, parts_.wall->viewerEvents());
  add(events, kModelEvent, parts_.wall->contentEvents());
  add(events, kStateEvent, faultsOf(parts_.keeper->takeNotices()));
  if (remote) {
    add(events, kDeviceEvent, remote->take(clock_.now()));
    add(events, kGestureEvent, remote->takeGestures());
  }
  add(events, kServerEvent, servers_.events("wall"));
  return taken(events);
}

}  // namespace merlin
