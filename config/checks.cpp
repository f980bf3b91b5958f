#include "config/checks.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/commands.h"
#include "daemon/base/tcp_address.h"
#include "render/room/room_tiles.h"
#include "render/stereo/eye_tiles.h"

namespace merlin {
namespace {

// Adds the faults as findings. `group`: JSON pointer to which the faults' pointers are relative.
// `prefix`: precedes texts of faults that are not predicates, "cannot be used: ".
void addFaults(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded,
               const std::string& prefix = {}) {
  for (const auto& [pointer, what, other] : faults) {
    const std::string at = group + other;
    const std::string before =
        other.empty() ? "" : fmt::format("conflicts with {} ({}): ", at, loaded.placeText(at));
    loaded.addFinding(group + pointer, fmt::format("{}{}{}", prefix, before, what));
  }
}

void checkName(const Settings& s, LoadedSettings& loaded) {
  bool good = !s.instance.empty() && s.instance.size() <= 32;
  for (const char c : s.instance)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_');
  if (!good)
    loaded.addFinding(
        "/instance",
        fmt::format("is \"{}\"; allowed are 1 to 32 letters, digits, - and _", s.instance));
}

// Two drivers on one serial line would each read only a part of the device's bytes.
void checkPortsDiffer(const DevicesSettings& d, LoadedSettings& loaded) {
  std::map<std::string, const char*> taken;
  const std::pair<const char*, const LineSettings*> lines[] = {
      {"glove", &d.glove_line}, {"tracker", &d.tracker_line}, {"ball", &d.ball_line}};
  for (const auto& [device, line] : lines) {
    if (line->port.empty() || line->port.starts_with("replay:")) continue;
    const auto [first, fresh] = taken.emplace(line->port, device);
    if (fresh) continue;
    loaded.addFinding(fmt::format("/devices/{}/port", device),
                      fmt::format("is \"{}\", which is the {}'s port; each device needs its own",
                                  line->port, first->second));
  }
}

// A ball that is read from MERLIN's own socket would feed itself.
void checkOwnSocket(const Settings& s, LoadedSettings& loaded) {
  const std::string& own = s.serve.spnav_socket;
  if (own.empty() || s.devices.ball_line.port != "unix:" + own) return;
  loaded.addFinding("/devices/ball/port",
                    fmt::format("is \"unix:{0}\", the socket that merlind serves by "
                                "/serve/spnav_socket; spacenavd's own socket is needed here, and "
                                "another path there",
                                own));
}

// The same of a tracker that is read from MERLIN's own VRPN server.
void checkOwnVrpn(const Settings& s, LoadedSettings& loaded) {
  const LineSettings& line = s.devices.tracker_line;
  const auto port = parsePort(line.port);
  if (line.driver != "vrpn" || !port || port->kind != PortKind::kTcp) return;
  const bool here =
      port->path == "localhost" || port->path == "::1" || port->path.starts_with("127.");
  if (!here || port->service != std::to_string(s.serve.vrpn_port)) return;
  loaded.addFinding("/devices/tracker/port",
                    fmt::format("is \"{}\", where merlind itself serves by /serve/vrpn_port; the "
                                "tracker's own server is needed here, and another number there",
                                line.port));
}

// The samples from another machine are encrypted, so the wall's input from it needs keys.
void checkInput(const InputSettings& in, LoadedSettings& loaded) {
  if (in.endpoint.empty()) return;
  if (!parseTcpAddress(in.endpoint)) {
    loaded.addFinding(
        "/wall/input/endpoint",
        fmt::format("is \"{}\"; allowed is tcp://HOST:PORT, PORT 1 to 65535, or \"\" for "
                    "this machine's devices",
                    in.endpoint));
  }
  if (in.keys.empty() || in.server_key.size() != 40) {
    loaded.addFinding(
        "/wall/input",
        "needs keys (merlin keys -o FILE) and server_key, the other machine's public key "
        "of 40 characters");
  }
}

bool hasProjectors(const DevicesSettings& d) {
  return !d.projectors.empty() || (!d.gpio.chip.empty() && d.gpio.projector_line >= 0);
}

void checkProjectors(const DevicesSettings& d, LoadedSettings& loaded) {
  addFaults(validate(d.projectors), "/devices/projectors", loaded);
  addFaults(validate(d.projector_schedule), "/devices/projector_schedule", loaded);
  if (!d.projector_schedule.empty() && !hasProjectors(d))
    loaded.addFinding("/devices/projector_schedule", fmt::format("needs {}", kProjectorsNeeded));
}

// Finds bindings whose action could never have an effect. Walls on other machines, which receive
// actions through /serve/samples_endpoint, may have the folder or the models that this wall lacks.
void checkBindings(const Settings& s, LoadedSettings& loaded) {
  addFaults(validate(s.devices.bindings), "/devices/bindings", loaded);
  const bool other_walls = !s.serve.samples_endpoint.empty();
  const bool lamp = !s.devices.gpio.chip.empty() && s.devices.gpio.lamp_line >= 0;
  const bool projectors = hasProjectors(s.devices);
  for (std::size_t i = 0; i < s.devices.bindings.size(); ++i) {
    const std::string& action = s.devices.bindings[i].action;
    const std::string at = fmt::format("/devices/bindings/{}/action", i);
    const CommandInfo* const command = findCommand(action);
    if (action == "snapshot" && s.wall.snapshots.empty() && !other_walls)
      loaded.addFinding(at, "is snapshot, which needs a folder: /wall/snapshots names none");
    if (action == "operator_panel" && !s.wall.operator_tile.panel && !other_walls)
      loaded.addFinding(at,
                        "is operator_panel, which needs the panel: /wall/operator/panel is off");
    if (action == "next_content" && s.wall.contents.empty() && !other_walls)
      loaded.addFinding(
          at, "is next_content, and there is one content only: /wall/contents names none");
    if (action.starts_with("lamp_") && !lamp)
      loaded.addFinding(at,
                        fmt::format("is {}, which needs a lamp: /devices/gpio has no chip with a "
                                    "lamp_line",
                                    action));
    else if (action.starts_with("projector_")) {
      if (!projectors)
        loaded.addFinding(at, fmt::format("is {}, which needs {}", action, kProjectorsNeeded));
    } else if (command && command->role == CommandOf::kPanel && s.devices.gpio.chip.empty())
      loaded.addFinding(
          at, fmt::format("is {}, which needs the panel: /devices/gpio names no chip", action));
  }
}

// Checks the stereo settings, then the tiles that they make for each eye, and the outputs against
// those tiles.
void checkStereo(const WallSettings& wall, LoadedSettings& loaded) {
  const double distance_m = wall.scene.wall_distance_m;
  const SettingFaults faults =
      render::stereo::validate(wall.stereo, wall.tiles, wall.outputs, distance_m);
  addFaults(faults, "/wall", loaded);
  if (!faults.empty()) return;
  const auto eyes = render::stereo::eyeTiles(wall.stereo, wall.tiles, wall.outputs, distance_m);
  addFaults(validate(eyes.tiles), "/wall/stereo", loaded, "cannot be used: ");
  SettingFaults of_outputs = validate(eyes.outputs, eyes.tiles);
  for (SettingFault& fault : of_outputs)
    fault.pointer = render::stereo::pointerInSettings(eyes, fault.pointer);
  addFaults(of_outputs, "/wall/outputs", loaded);
}

void checkHead(const Settings& s, LoadedSettings& loaded) {
  const int station = s.wall.stereo.head.station;
  if (station == 0 || station != s.devices.hand.station) return;
  loaded.addFinding(
      "/wall/stereo/head/station",
      fmt::format("is {}, the station that is worn on the hand (/devices/hand/station); "
                  "the head needs its own",
                  station));
}

// Makes the tiles of a wall that is described as a room. A wall whose room is at fault has no tiles
// that others could be checked with.
void checkTiles(LoadedSettings& loaded) {
  WallSettings& wall = loaded.settings.wall;
  if (wall.room.isGiven()) {
    const SettingFaults faults = validate(wall.room, wall.tiles);
    addFaults(faults, "/wall/room", loaded, "cannot be used: ");
    if (!faults.empty()) return;
    wall.tiles = *render::room::roomTiles(wall.room, wall.tiles);
  }
  const SettingFaults faults = validate(wall.tiles);
  addFaults(faults, "/wall/tiles", loaded, "cannot be used: ");
  if (faults.empty()) checkStereo(wall, loaded);
}

// Each entry names one of its kinds of file, and `merlin show` finds it by its name.
void checkContents(const WallSettings& wall, LoadedSettings& loaded) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < wall.contents.size(); ++i) {
    const ContentSettings& c = wall.contents[i];
    const std::string at = fmt::format("/wall/contents/{}", i);
    int files = 0;
    for (const std::string* file : {&c.model, &c.picture, &c.slides})
      files += file->empty() ? 0 : 1;
    if (files > 1)
      loaded.addFinding(at, "names more than one file; give it one of model, picture and slides");
    if (!c.name.empty() && !names.insert(c.name).second)
      loaded.addFinding(at + "/name",
                        fmt::format("is \"{}\", the name of another content", c.name));
  }
}

void checkPanel(const WallSettings& wall, LoadedSettings& loaded) {
  const render::tiles::TilesSettings& tiles = wall.tiles;
  const bool fits = std::ranges::any_of(tiles.tiles, [&](const render::tiles::TileSettings& tile) {
    return tile.kind == render::tiles::TileKind::kOperator &&
           (tile.width > 0 ? tile.width : tiles.tile_width) >= 320 &&
           (tile.height > 0 ? tile.height : tiles.tile_height) >= 240;
  });
  if (wall.operator_tile.panel && !fits) {
    loaded.addFinding("/wall/operator/panel",
                      "needs a tile of kind operator of at least 320 x 240 pixels; the wall has "
                      "none");
  }
}

void checkSnapshots(const WallSettings& wall, LoadedSettings& loaded) {
  const bool shared = std::any_of(wall.outputs.begin(), wall.outputs.end(), [](const auto& o) {
    return o.kind == render::out::OutputKind::kSharedMemory;
  });
  if (!wall.snapshots.empty() && !shared) {
    loaded.addFinding("/wall/snapshots",
                      "needs an output of kind shared_memory, from which snapshots are taken; "
                      "/wall/outputs has none");
  }
}

}  // namespace

void checkTogether(LoadedSettings& loaded) {
  const Settings& s = loaded.settings;
  const DevicesSettings& d = s.devices;
  checkName(s, loaded);
  addFaults(validate(d.glove_line), "/devices/glove", loaded);
  addFaults(validate(d.tracker_line), "/devices/tracker", loaded);
  addFaults(validate(d.ball_line), "/devices/ball", loaded);
  checkPortsDiffer(d, loaded);
  checkOwnSocket(s, loaded);
  checkOwnVrpn(s, loaded);
  addFaults(validate(d.glove, d.glove_line), "/devices/glove", loaded);
  addFaults(validate(d.vrpn, d.tracker_line), "/devices/tracker", loaded);
  addFaults(validate(d.ball), "/devices/ball", loaded);
  addFaults(validate(d.spacenav), "/devices/ball/spacenav", loaded);
  addFaults(validate(d.evdev), "/devices/ball/evdev", loaded);
  addFaults(validate(d.gpio), "/devices/gpio", loaded);
  checkProjectors(d, loaded);
  addFaults(validate(s.serve), "/serve", loaded);
  addFaults(validate(s.page), "/page", loaded);
  addFaults(validate(s.alarms), "/alarms", loaded);
  checkInput(s.wall.input, loaded);
  checkTiles(loaded);
  checkHead(s, loaded);
  addFaults(validate(s.wall.scene), "/wall/scene", loaded, "cannot be used: ");
  addFaults(validate(s.wall.governor), "/wall/rate", loaded);
  checkContents(s.wall, loaded);
  checkSnapshots(s.wall, loaded);
  checkPanel(s.wall, loaded);
  checkBindings(s, loaded);
}

}  // namespace merlin
