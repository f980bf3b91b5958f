#include "daemon/reload/plan.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace merlin::reload {
namespace {

// The row of a group holds for all settings in it that have no row of their own, including settings
// that are added later.
constexpr Taker kTakers[] = {
    {"/instance", kAll, Part::kRestart},
    {"/run_directory", kAll, Part::kRestart},
    {"/state_file", kDevices | kWall, Part::kRestart},
    // The names, kinds and number of devices and hands are in the field table of the shared memory,
    // which its readers read only once.
    {"/devices", kDevices | kWall | kMirror, Part::kRestart},
    {"/devices/*", kDevices, Part::kLine},
    {"/devices/*/name", kDevices | kWall | kMirror, Part::kRestart},
    {"/devices/*/driver", kDevices | kMirror, Part::kRestart},
    {"/devices/*/person", kDevices | kWall, Part::kHand},
    {"/hands", kDevices | kWall | kMirror, Part::kRestart},
    {"/hands/*/station", kDevices | kWall, Part::kHand},
    {"/hands/*/cutoff_hz", kDevices, Part::kHand},
    {"/hands/*/cutoff_per_m_s", kDevices, Part::kHand},
    {"/hands/*/person", kDevices | kWall, Part::kHand},
    {"/hands/*/gestures", kDevices, Part::kGestures},
    {"/postures", kDevices, Part::kPostures},
    {"/gestures", kDevices, Part::kGestures},
    {"/bindings", kDevices, Part::kBindings},
    {"/people/stale_after_s", kDevices | kWall, Part::kBindings},
    {"/people/turn_s", kWall, Part::kHand},
    {"/gpio", kDevices, Part::kRestart},
    {"/projectors", kDevices, Part::kRestart},
    {"/projector_schedule", kDevices, Part::kRestart},
    {"/cpu_latency_us", kDevices, Part::kRestart},
    {"/script", kDevices, Part::kRestart},
    {"/wall", kWall, Part::kRestart},
    {"/wall/rate", kWall, Part::kRate},
    {"/wall/playlist", kWall, Part::kPlaylist},
    {"/wall/outputs/*/correction", kWall, Part::kCorrection},
    // Measured files are read at the start.
    {"/wall/outputs/*/correction/mpcdi", kWall, Part::kRestart},
    {"/wall/outputs/*/correction/mpcdi_region", kWall, Part::kRestart},
    // The initial view, the model's size and the screen's distance were used at the start, to
    // measure the contents and to lay out the wall.
    {"/wall/scene", kWall, Part::kRestart},
    {"/wall/scene/ball_speed_m_s", kWall, Part::kScene},
    {"/wall/scene/ball_turn_deg_s", kWall, Part::kScene},
    {"/wall/scene/tracker_axes", kDevices | kWall, Part::kScene},
    {"/wall/scene/hand_gain", kWall, Part::kScene},
    {"/wall/scene/fly_gain", kWall, Part::kScene},
    {"/wall/scene/tracker_origin_m", kWall, Part::kScene},
    {"/wall/scene/hand_noise_m", kWall, Part::kScene},
    {"/wall/scene/hand_noise_deg", kWall, Part::kScene},
    {"/wall/scene/return_after_s", kWall, Part::kScene},
    {"/serve", kDevices | kMirror, Part::kRestart},
    {"/serve/wall_endpoint", kWall, Part::kRestart},
    {"/serve/wall_topics_endpoint", kWall, Part::kRestart},
    {"/serve/devices_endpoint", kDevices, Part::kRestart},
    {"/serve/commands_keys", kDevices | kWall, Part::kRestart},
    {"/serve/commands_clients", kDevices | kWall, Part::kRestart},
    {"/serve/commands_readers", kDevices | kWall, Part::kRestart},
    {"/page", kPage, Part::kRestart},
    {"/alarms", kAlarms, Part::kRestart},
};

// Removes the first part of the pointer and returns it: "devices" of "/devices/2".
std::string_view takePart(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const std::string_view part = pointer.substr(0, pointer.find('/'));
  pointer.remove_prefix(part.size());
  return part;
}

bool isIndex(std::string_view part) {
  return !part.empty() &&
         std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Whether `pointer` is `outer`, or in that group or list.
bool covers(std::string_view outer, std::string_view pointer) {
  while (!outer.empty()) {
    if (pointer.empty()) return false;
    const std::string_view expected = takePart(outer), found = takePart(pointer);
    if (expected != found && !(expected == "*" && isIndex(found))) return false;
  }
  return true;
}

// The index of the device whose setting this is: 2 for "/devices/2/port".
std::size_t deviceOf(std::string_view pointer) {
  (void)takePart(pointer);
  std::size_t index = 0;
  for (const char digit : takePart(pointer))
    index = index * 10 + static_cast<std::size_t>(digit - '0');
  return index;
}

void adoptDevice(const DeviceSettings& fresh, bool keep_port, DeviceSettings& running) {
  std::string port = keep_port ? running.line.port : fresh.line.port;
  running.line = fresh.line;
  running.line.port = std::move(port);
  running.own = fresh.own;
}

}  // namespace

Taker takerOf(std::string_view pointer) {
  Taker found{"", kAll, Part::kRestart};
  for (const Taker& taker : kTakers) {
    if (covers(taker.pointer, pointer) && taker.pointer.size() > found.pointer.size())
      found = taker;
  }
  return found;
}

std::vector<Taker> takers() { return {std::begin(kTakers), std::end(kTakers)}; }

Plan planFor(const std::vector<SettingChange>& changes, Readers process) {
  Plan plan;
  for (const SettingChange& change : changes) {
    const Taker taker = takerOf(change.pointer);
    if ((taker.readers & process) == 0) {
      plan.elsewhere.push_back(change);
    } else if (taker.part == Part::kRestart) {
      plan.restart.push_back(change);
    } else {
      plan.swapped.push_back(change);
      plan.parts[static_cast<std::size_t>(taker.part)] = true;
      if (taker.part != Part::kLine) continue;
      const std::size_t device = deviceOf(change.pointer);
      plan.lines.resize(std::max(plan.lines.size(), device + 1));
      plan.lines[device] = true;
    }
  }
  return plan;
}

void adopt(const Plan& plan, const Settings& fresh, bool keep_ports, Settings& running) {
  const DevicesSettings& from = fresh.devices;
  DevicesSettings& to = running.devices;
  if (plan.has(Part::kBindings)) {
    to.bindings = from.bindings;
    to.stale_after_s = from.stale_after_s;
  }
  for (std::size_t i = 0; i < std::min(to.list.size(), from.list.size()); ++i) {
    if (i < plan.lines.size() && plan.lines[i]) adoptDevice(from.list[i], keep_ports, to.list[i]);
    if (plan.has(Part::kHand)) to.list[i].person = from.list[i].person;
  }
  // Copies all settings of the hands, because a change of those that belong to other parts would
  // have needed a restart.
  if (plan.has(Part::kHand) || plan.has(Part::kGestures)) to.hands = from.hands;
  if (plan.has(Part::kHand)) to.turn_s = from.turn_s;
  if (plan.has(Part::kPostures)) {
    to.postures = from.postures;
    to.posture_hold = from.posture_hold;
    to.posture_drift = from.posture_drift;
  }
  if (plan.has(Part::kGestures)) to.gestures = from.gestures;
  if (plan.has(Part::kRate)) running.wall.governor = fresh.wall.governor;
  if (plan.has(Part::kPlaylist)) running.wall.playlist = fresh.wall.playlist;
  if (plan.has(Part::kCorrection)) {
    auto& outputs = running.wall.outputs;
    for (std::size_t i = 0; i < std::min(outputs.size(), fresh.wall.outputs.size()); ++i)
      outputs[i].correction = fresh.wall.outputs[i].correction;
  }
  // Copies the whole scene, because a change of its other settings would have needed a restart.
  if (plan.has(Part::kScene)) running.wall.scene = fresh.wall.scene;
}

}  // namespace merlin::reload
