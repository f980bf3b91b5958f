// merlin wall plan: draws the room from above and prints the table of its tiles.
#include "daemon/cli/wall/wall_plan.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/drawn_wall.h"
#include "config/loader.h"
#include "config/usual_file.h"
#include "config/writer.h"
#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/wall/plan_svg.h"
#include "render/room/presets.h"
#include "render/room/room_tiles.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PlanOptions {
  std::string config, preset, output;
  double overlap_m = 0;
  bool json = false, panels = false;
};

Result<WallSettings> presetWall(const std::string& name, double overlap_m) {
  WallSettings wall;
  const std::span names(render::room::kRoomPresetNames);
  wall.room.preset.name =
      static_cast<render::room::RoomPreset>(std::ranges::find(names, name) - names.begin());
  wall.room.preset.overlap_m = overlap_m;
  auto tiles = render::room::roomTiles(wall.room, wall.tiles);
  if (!tiles) return tiles.error();
  wall.tiles = *std::move(tiles);
  return wall;
}

Result<WallSettings> configuredWall(const std::string& path) {
  const LoadedSettings loaded = loadSettingsFile(path);
  for (const Finding& f : loaded.findings) printError("merlin: {}\n", toText(path, f));
  if (loaded.verdict() != LoadedSettings::Verdict::kInvalid) return loaded.settings.wall;
  return Error{Errc::kInvalidArgument, path + ": the configuration is invalid"};
}

// Returns the wall of the preset or of the given configuration; without either, that of the usual
// configuration or, if that file does not exist, the wall that merlind shows without settings.
// Errors: kInvalidArgument.
Result<WallSettings> wallOf(const PlanOptions& options) {
  if (!options.preset.empty() && !options.config.empty())
    return Error{Errc::kInvalidArgument, "wall plan: give --config or --preset, not both"};
  if (options.preset.empty() && options.overlap_m != 0)
    return Error{Errc::kInvalidArgument,
                 "wall plan: --overlap is for --preset; a configuration says it in "
                 "/wall/room/preset/overlap_m or in its displays' part_m"};
  if (!options.preset.empty()) return presetWall(options.preset, options.overlap_m);
  if (!options.config.empty()) return configuredWall(options.config);
  if (fileStamp(kUsualConfig)) return configuredWall(kUsualConfig);
  printNote(fmt::format("there is no {}; this is the wall of a configuration without settings",
                        kUsualConfig));
  return WallSettings{};
}

Json screenJson(const render::room::ScreenFigures& s) {
  return {{"width_m", s.width_m},
          {"height_m", s.height_m},
          {"pixel_pitch_mm", s.pixel_pitch_mm},
          {"distance_m", s.distance_m}};
}

Json tableJson(const WallPlan& wall) {
  Json json = {{"frame_width", wall.plan.frame_width}, {"frame_height", wall.plan.frame_height}};
  if (!wall.room.panels.empty()) json["eye_m"] = wall.room.eye_m;
  json["tiles"] = Json::array();
  for (const render::room::TileFigures& f : render::room::tileTable(wall.tiles, wall.plan)) {
    Json tile = {{"name", f.name},
                 {"kind", f.kind == render::tiles::TileKind::kWall ? "wall" : "operator"},
                 {"view", nameOf(f.view)},
                 {"x", f.x},
                 {"y", f.y},
                 {"width", f.width},
                 {"height", f.height},
                 {"horizontal_deg", f.horizontal_deg},
                 {"vertical_deg", f.vertical_deg}};
    if (f.followsWall()) {
      tile["yaw_deg"] = f.yaw_deg;
      tile["pitch_deg"] = f.pitch_deg;
    }
    if (f.screen) tile["screen"] = screenJson(*f.screen);
    json["tiles"].push_back(std::move(tile));
  }
  json["overlaps"] = Json::array();
  for (const render::room::TileOverlap& o : render::room::tileOverlaps(wall.plan)) {
    json["overlaps"].push_back({{"left", o.left},
                                {"right", o.right},
                                {"width_m", o.width_m},
                                {"height_m", o.height_m},
                                {"left_px", o.left_px},
                                {"right_px", o.right_px}});
  }
  return json;
}

// Rounds all numbers to six digits after the point (a micrometre), because computed lengths differ
// from round numbers by amounts such as 0.0000000000001.
void roundNumbers(Json& value) {
  if (value.is_number_float()) value = std::round(value.get<double>() * 1e6) / 1e6;
  if (value.is_structured())
    for (Json& part : value) roundNumbers(part);
}

// Returns the settings of `item` that differ from those of the new entry `new_one`, rounded.
Json statedOf(const Json& item, const Json& new_one) {
  Json stated = Json::object();
  for (const auto& [key, value] : item.items()) {
    if (!new_one.contains(key) || value != new_one[key]) stated[key] = value;
  }
  roundNumbers(stated);
  return stated;
}

Json roomOf(const render::room::RoomSettings& room) {
  Settings settings;
  settings.wall.room = room;
  return Json::parse(settingsText(settings))["wall"]["room"];
}

// Prints a configuration that contains only the room; settings of panels and displays with default
// values are left out.
int printPanels(const WallSettings& wall) {
  if (!wall.room.isGiven()) {
    return fail({Errc::kInvalidArgument,
                 "this wall has no panels: its tiles are set by hand (/wall/tiles/tiles)"});
  }
  render::room::RoomSettings new_ones;
  new_ones.panels.emplace_back();
  new_ones.displays.emplace_back();
  const Json untouched = roomOf(new_ones);
  Json room = roomOf(render::room::withPanels(wall.room));
  room.erase("preset");
  for (const char* const list : {"panels", "displays"})
    for (Json& item : room[list]) item = statedOf(item, untouched[list][0]);
  fmt::print("{}\n", Json{{"wall", {{"room", std::move(room)}}}}.dump(2));
  return kExitDone;
}

int plan(const PlanOptions& options) {
  if (!options.output.empty()) {
    if (const auto named = checkEnding(options.output, "drawing", ".svg"); !named)
      return fail(named.error());
  }
  const auto settings = wallOf(options);
  if (!settings) return fail(settings.error());
  if (options.panels) return printPanels(*settings);
  const render::tiles::TilesSettings tiles = drawnWall(*settings).tiles;
  auto planned = render::tiles::planTiles(tiles);
  if (!planned) return fail(planned.error());
  const WallPlan wall{render::room::withPanels(settings->room), tiles, *std::move(planned),
                      settings->scene.wall_distance_m};
  if (!options.output.empty()) {
    const auto written = writeFile(options.output, planSvg(wall));
    if (!written) return fail(written.error());
  }
  if (options.json) {
    printJsonLine(tableJson(wall));
    return kExitDone;
  }
  for (const std::string& line : tableLines(wall)) printOut("{}\n", line);
  return kExitDone;
}

}  // namespace

void addPlan(Command wall, Run& run) {
  const auto options = std::make_shared<PlanOptions>();
  Command command = wall.subcommand(
      "plan",
      "Draw the wall from above (panels, displays, the eye and what each display shows) and print "
      "the table of its tiles: pixels, place in the frame, field of view, direction of the "
      "picture's middle, size of picture and pixels, distance from the eye.\n"
      "Example: merlin wall plan -c config/wall-three-160.json -o room.svg");
  command
      .option("-c,--config", options->config,
              "The configuration; /etc/merlin/merlin.json if none is named")
      .typeName("FILE");
  std::vector<std::string> presets;
  for (const char* const name : std::span(render::room::kRoomPresetNames).subspan(1))
    presets.emplace_back(name);
  command
      .option("--preset", options->preset,
              "Instead of a configuration: a common wall, as in /wall/room/preset/name")
      .oneOf(presets);
  command
      .option("--overlap", options->overlap_m,
              "Presets flat and six only: width of the strip that neighbouring projectors both "
              "show, in metres")
      .typeName("METRES");
  command.option("-o", options->output, "Write the drawing into this file").typeName("FILE.svg");
  command.flag("--json", options->json, "Print the table as JSON");
  command.flag("--panels", options->panels,
               "Only print the room with explicit panels and displays, as a configuration; with a "
               "preset, this is a starting point for your own room");
  command.callback([options, &run] { run = [options] { return plan(*options); }; });
}

}  // namespace merlin::cli
