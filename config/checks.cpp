#include "config/checks.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/device_checks.h"
#include "config/devices.h"
#include "config/needs.h"
#include "daemon/base/commands.h"
#include "daemon/base/tcp_address.h"
#include "render/out/room_blend.h"
#include "render/room/room_tiles.h"
#include "render/stereo/eye_tiles.h"

namespace merlin {
namespace {

void checkName(const Settings& s, LoadedSettings& loaded) {
  bool good = !s.instance.empty() && s.instance.size() <= 32;
  for (const char c : s.instance)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_');
  if (!good)
    loaded.addFinding(
        "/instance",
        fmt::format("is \"{}\"; allowed are 1 to 32 letters, digits, - and _", s.instance));
}

// Checks /wall/input: the address must be valid, and keys are necessary, because the samples from
// another machine are encrypted.
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
  addFaults(validate(d.projectors), "/projectors", loaded);
  addFaults(validate(d.projector_schedule), "/projector_schedule", loaded);
  if (!d.projector_schedule.empty() && !hasProjectors(d))
    loaded.addFinding("/projector_schedule", fmt::format("needs {}", kProjectorsNeeded));
}

// Adds a finding if the binding has no action. An unknown name of an action is reported when the
// file is read, not here.
void checkHasAction(const Binding& binding, const std::string& at, LoadedSettings& loaded) {
  if (!binding.action.empty() || loaded.lines.contains(at + "/action")) return;
  loaded.addFinding(at, fmt::format("has no action: name one in \"action\", one of {}",
                                    fmt::join(kActions, ", ")));
}

// Finds bindings without an action, and actions that could never have an effect. The snapshot
// folder and the operator's panel may be missing here if /serve/samples_endpoint is set, because
// walls on other machines receive the actions through it and may have them.
void checkBindings(const Settings& s, LoadedSettings& loaded) {
  addFaults(validate(s.devices.bindings), "/bindings", loaded);
  const bool other_walls = !s.serve.samples_endpoint.empty();
  const bool lamp = !s.devices.gpio.chip.empty() && s.devices.gpio.lamp_line >= 0;
  const bool projectors = hasProjectors(s.devices);
  for (std::size_t i = 0; i < s.devices.bindings.size(); ++i) {
    const std::string& action = s.devices.bindings[i].action;
    checkHasAction(s.devices.bindings[i], fmt::format("/bindings/{}", i), loaded);
    const std::string at = fmt::format("/bindings/{}/action", i);
    const CommandInfo* const command = findCommand(action);
    if (action == "snapshot" && s.wall.snapshots.empty() && !other_walls)
      loaded.addFinding(at, "is snapshot, which needs a folder: /wall/snapshots names none");
    if (action == "operator_panel" && !s.wall.operator_tile.panel && !other_walls)
      loaded.addFinding(at,
                        "is operator_panel, which needs the panel: /wall/operator/panel is off");
    if (action.starts_with("lamp_") && !lamp)
      loaded.addFinding(at, fmt::format("is {}, which needs a lamp: /gpio has no chip with a "
                                        "lamp_line",
                                        action));
    else if (action.starts_with("projector_")) {
      if (!projectors)
        loaded.addFinding(at, fmt::format("is {}, which needs {}", action, kProjectorsNeeded));
    } else if (command && command->role == CommandOf::kPanel && s.devices.gpio.chip.empty())
      loaded.addFinding(at,
                        fmt::format("is {}, which needs the panel: /gpio names no chip", action));
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
  for (const SettingFault& doubt : doubtsOf(wall.stereo)) {
    const std::string at = "/wall" + doubt.pointer;
    loaded.add({true, loaded.lineOf(at), at, doubt.what});
  }
  const auto eyes = render::stereo::eyeTiles(wall.stereo, wall.tiles, wall.outputs, distance_m);
  addFaults(validate(eyes.tiles), "/wall/stereo", loaded, "cannot be used: ");
  SettingFaults of_outputs = validate(eyes.outputs, eyes.tiles);
  for (SettingFault& fault : of_outputs)
    fault.pointer = render::stereo::pointerInSettings(eyes, fault.pointer);
  addFaults(of_outputs, "/wall/outputs", loaded);
}

// Computes the blend ramps of outputs with automatic blending from the positions of the screens.
// Adds a finding if the stereo mode puts both eyes' pictures side by side or one above the other
// into one output.
void checkBlends(WallSettings& wall, LoadedSettings& loaded) {
  using render::stereo::StereoMode;
  const StereoMode mode = wall.stereo.mode;
  const auto automatic = [](const render::out::OutputSettings& o) {
    return o.correction.blend.automatic;
  };
  const auto first = std::ranges::find_if(wall.outputs, automatic);
  if (first != wall.outputs.end() &&
      (mode == StereoMode::kSideBySide || mode == StereoMode::kTopBottom))
    return loaded.addFinding(
        fmt::format("/wall/outputs/{}/correction/blend/automatic", first - wall.outputs.begin()),
        fmt::format("is true, and /wall/stereo/mode is {}, in which an output shows two pictures: "
                    "give left, right, top and bottom",
                    nameOf(mode)));
  addFaults(fillBlends(wall.outputs, wall.tiles), "/wall/outputs", loaded);
}

// Computes the tiles if a room is given, then checks the tiles, the blend ramps and stereo. Stops
// after the first of these steps that has a fault, because the later ones need valid tiles.
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
  if (!faults.empty()) return;
  checkBlends(wall, loaded);
  checkStereo(wall, loaded);
}

// Checks that no content names more than one file, and that no two have the same name, by which
// `merlin show` finds them.
void checkContents(const WallSettings& wall, LoadedSettings& loaded) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < wall.contents.size(); ++i) {
    const ContentSettings& c = wall.contents[i];
    const std::string at = fmt::format("/wall/contents/{}", i);
    int files = 0;
    for (const std::string* file : {&c.model, &c.picture, &c.slides})
      files += file->empty() ? 0 : 1;
    if (files != 1) {
      loaded.addFinding(at, fmt::format("names {}; give it one of model, picture and slides",
                                        files == 0 ? "no file" : "more than one file"));
    }
    if (!c.name.empty() && !names.insert(c.name).second)
      loaded.addFinding(
          at + "/name",
          fmt::format("is \"{}\", the name of another content; give each its own name", c.name));
  }
}

void checkOperator(const WallSettings& wall, LoadedSettings& loaded) {
  const render::tiles::TilesSettings& tiles = wall.tiles;
  const auto isOperators = [](const render::tiles::TileSettings& tile) {
    return tile.kind == render::tiles::TileKind::kOperator;
  };
  const bool fits = std::ranges::any_of(tiles.tiles, [&](const render::tiles::TileSettings& tile) {
    return isOperators(tile) && (tile.width > 0 ? tile.width : tiles.tile_width) >= 320 &&
           (tile.height > 0 ? tile.height : tiles.tile_height) >= 240;
  });
  if (wall.operator_tile.overlay && !std::ranges::any_of(tiles.tiles, isOperators)) {
    loaded.addFinding("/wall/operator/overlay", "needs a tile of kind operator; the wall has none");
  }
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
  completeDevices(loaded.settings.devices.list);
  checkDevices(loaded);
  addFaults(validate(d.gpio), "/gpio", loaded);
  checkProjectors(d, loaded);
  addFaults(validate(s.serve), "/serve", loaded);
  addFaults(validate(s.page), "/page", loaded);
  addFaults(validate(s.alarms), "/alarms", loaded);
  checkInput(s.wall.input, loaded);
  checkTiles(loaded);
  addFaults(validate(s.wall.scene), "/wall/scene", loaded, "cannot be used: ");
  addFaults(validate(s.wall.governor), "/wall/rate", loaded);
  checkContents(s.wall, loaded);
  checkSnapshots(s.wall, loaded);
  checkOperator(s.wall, loaded);
  checkBindings(s, loaded);
  checkNeeds(loaded);
}

}  // namespace merlin
