#include "config/needs.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "config/devices.h"
#include "config/effective.h"

namespace merlin {
namespace {

struct Need {
  const char* setting;
  std::vector<const char*> any_of;  // `setting` has an effect only if one of these is set
};

const std::vector<Need>& needs() {
  static const std::vector<const char*> kChip = {"/gpio/chip"},
                                        kSamples = {"/serve/samples_endpoint"},
                                        kCommands = {"/serve/wall_endpoint",
                                                     "/serve/devices_endpoint",
                                                     "/serve/wall_topics_endpoint"},
                                        kInput = {"/wall/input/endpoint"},
                                        kHead = {"/wall/stereo/head/station"};
  static const std::vector<Need> kNeeds = {
      {"/gpio/projector_line", kChip},
      {"/gpio/video_line", kChip},
      {"/gpio/lamp_line", kChip},
      {"/gpio/button_line", kChip},
      {"/gpio/lamp_warns", kChip},
      {"/gpio/warm_up_s", kChip},
      {"/gpio/cool_down_s", kChip},
      {"/gpio/interlock_s", kChip},
      {"/gpio/debounce_s", kChip},
      {"/serve/samples_keys", kSamples},
      {"/serve/samples_clients", kSamples},
      {"/serve/commands_keys", kCommands},
      {"/serve/commands_clients", kCommands},
      {"/serve/commands_readers", kCommands},
      {"/wall/input/server_key", kInput},
      {"/wall/input/keys", kInput},
      {"/wall/playlist/dim_to", {"/wall/playlist/dim_after_s"}},
      {"/wall/render/show_range", {"/wall/render/show"}},
      {"/wall/snapshots_kept", {"/wall/snapshots"}},
      {"/wall/stereo/head/tracker", kHead},
      {"/wall/stereo/head/origin_m", kHead},
      {"/wall/stereo/head/axes", kHead},
      {"/wall/stereo/head/scale", kHead},
      {"/wall/stereo/head/dead_band_m", kHead},
      {"/wall/stereo/head/dead_band_deg", kHead},
  };
  return kNeeds;
}

// Returns the pointers of all settings with a value other than the default. As an optimisation,
// returns an empty set if the files contain none of the settings in the table.
std::set<std::string> setOnes(const LoadedSettings& loaded) {
  std::set<std::string> set;
  const bool any = std::ranges::any_of(
      needs(), [&](const Need& need) { return loaded.lines.contains(need.setting); });
  if (!any) return set;
  for (const SettingChange& change : changesFromDefaults(loaded.settings))
    set.insert(change.pointer);
  return set;
}

void checkTable(LoadedSettings& loaded) {
  const std::set<std::string> set = setOnes(loaded);
  for (const Need& need : needs()) {
    if (!loaded.lines.contains(need.setting) || !set.contains(need.setting)) continue;
    const auto is_set = [&](const char* other) { return set.contains(other); };
    if (std::ranges::any_of(need.any_of, is_set)) continue;
    loaded.addFinding(need.setting,
                      fmt::format("has no effect without {}", fmt::join(need.any_of, " or ")));
  }
}

// Adds a finding if a baud rate is set although the port is not a serial line. The driver's usual
// rate is no finding, because written configurations always contain it.
void checkSpeed(const LineSettings& line, const std::string& at, LoadedSettings& loaded) {
  const auto port = parsePort(line.port);
  if (!port || !loaded.lines.contains(at)) return;
  const bool has_none = port->kind == PortKind::kEvdev || port->kind == PortKind::kTcp ||
                        port->kind == PortKind::kUnix || port->kind == PortKind::kUdp;
  std::vector<DeviceSettings> usual(1);
  usual[0].line.driver = line.driver;
  completeDevices(usual);
  if (!has_none || line.baud == usual[0].line.baud || usual[0].line.baud == 0) return;
  loaded.addFinding(at, fmt::format("has no effect at the port \"{}\": only serial: and pty: ports "
                                    "have a speed",
                                    line.port));
}

void checkOutput(const render::out::OutputSettings& output, const std::string& at,
                 LoadedSettings& loaded) {
  const render::out::OutputSettings usual;
  if (output.kind != render::out::OutputKind::kPng && output.interval_s != usual.interval_s)
    loaded.addFinding(at + "/interval_s", "has no effect for an output that is not of kind png");
  const auto& mesh = output.correction.mesh;
  if (mesh.isOff() && mesh.interpolation != usual.correction.mesh.interpolation)
    loaded.addFinding(
        at + "/correction/mesh/interpolation",
        fmt::format("has no effect without a mesh: {}/correction/mesh has no points", at));
}

// Warns of a setting that has no effect. It does not make the configuration invalid, because
// earlier versions accepted it.
void checkEyeSize(const render::stereo::StereoSettings& stereo, LoadedSettings& loaded) {
  using render::stereo::StereoMode;
  const bool one_each =
      stereo.mode == StereoMode::kAnaglyph || stereo.mode == StereoMode::kTwoOutputs;
  if (!one_each || stereo.size != render::stereo::EyeSize::kFull) return;
  const std::string at = "/wall/stereo/size";
  loaded.add({true, loaded.lineOf(at), at,
              fmt::format("is \"full\", which has no effect in stereo mode {}: \"full\" is for "
                          "side_by_side and top_bottom; leave it out",
                          nameOf(stereo.mode))});
}

}  // namespace

void checkNeeds(LoadedSettings& loaded) {
  checkTable(loaded);
  const Settings& s = loaded.settings;
  checkEyeSize(s.wall.stereo, loaded);
  for (std::size_t i = 0; i < s.devices.list.size(); ++i)
    checkSpeed(s.devices.list[i].line, fmt::format("/devices/{}/baud", i), loaded);
  for (std::size_t i = 0; i < s.wall.outputs.size(); ++i)
    checkOutput(s.wall.outputs[i], fmt::format("/wall/outputs/{}", i), loaded);
  for (std::size_t i = 0; i < s.wall.contents.size(); ++i) {
    const ContentSettings& content = s.wall.contents[i];
    if (!content.model.empty() && content.show_as != ContentSettings{}.show_as)
      loaded.addFinding(fmt::format("/wall/contents/{}/show_as", i),
                        "has no effect for a model: it is for picture and slides");
  }
}

}  // namespace merlin
