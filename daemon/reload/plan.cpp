#include "daemon/reload/plan.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace merlin::reload {
namespace {

// A group's row is for all its settings that have none of their own, new ones included.
constexpr Taker kTakers[] = {
    {"/instance", kAll, Part::kRestart},
    {"/run_directory", kAll, Part::kRestart},
    {"/state_file", kDevices | kWall, Part::kRestart},
    {"/devices", kDevices, Part::kRestart},
    {"/devices/bindings", kDevices, Part::kBindings},
    {"/devices/stale_after_s", kDevices | kWall, Part::kBindings},
    {"/devices/glove", kDevices, Part::kGlove},
    {"/devices/tracker", kDevices, Part::kTracker},
    {"/devices/ball", kDevices, Part::kBall},
    {"/devices/hand", kDevices, Part::kHand},
    {"/devices/hand/station", kDevices | kWall, Part::kHand},
    {"/devices/postures", kDevices, Part::kPostures},
    {"/devices/posture_hold_s", kDevices, Part::kPostures},
    {"/devices/posture_leave_s", kDevices, Part::kPostures},
    {"/devices/posture_margin", kDevices, Part::kPostures},
    {"/devices/posture_drift", kDevices, Part::kPostures},
    {"/wall", kWall, Part::kRestart},
    {"/wall/rate", kWall, Part::kRate},
    {"/wall/playlist", kWall, Part::kPlaylist},
    // The initial view, the model's size and the screen's distance are in what was measured and
    // laid out at the start.
    {"/wall/scene", kWall, Part::kRestart},
    {"/wall/scene/ball_speed_m_s", kWall, Part::kScene},
    {"/wall/scene/ball_turn_deg_s", kWall, Part::kScene},
    {"/wall/scene/tracker_axes", kWall, Part::kScene},
    {"/wall/scene/hand_gain", kWall, Part::kScene},
    {"/wall/scene/fly_gain", kWall, Part::kScene},
    {"/wall/scene/tracker_origin_m", kWall, Part::kScene},
    {"/wall/scene/hand_noise_m", kWall, Part::kScene},
    {"/wall/scene/hand_noise_deg", kWall, Part::kScene},
    {"/wall/scene/return_after_s", kWall, Part::kScene},
    {"/serve", kDevices | kMirror, Part::kRestart},
    {"/serve/wall_endpoint", kWall, Part::kRestart},
    {"/serve/devices_endpoint", kDevices, Part::kRestart},
    {"/serve/commands_keys", kDevices | kWall, Part::kRestart},
    {"/serve/commands_clients", kDevices | kWall, Part::kRestart},
    {"/serve/commands_readers", kDevices | kWall, Part::kRestart},
    {"/page", kPage, Part::kRestart},
    {"/alarms", kAlarms, Part::kRestart},
};

bool covers(std::string_view outer, std::string_view pointer) {
  return pointer.starts_with(outer) &&
         (pointer.size() == outer.size() || pointer[outer.size()] == '/');
}

void keepPort(LineSettings& line, LineSettings fresh, bool keeps) {
  if (keeps) fresh.port = line.port;
  line = std::move(fresh);
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
  if (plan.has(Part::kGlove)) {
    keepPort(to.glove_line, from.glove_line, keep_ports);
    to.glove = from.glove;
  }
  if (plan.has(Part::kTracker)) {
    keepPort(to.tracker_line, from.tracker_line, keep_ports);
    to.tracker = from.tracker;
    to.vrpn = from.vrpn;
  }
  if (plan.has(Part::kBall)) {
    keepPort(to.ball_line, from.ball_line, keep_ports);
    to.ball = from.ball;
    to.spacenav = from.spacenav;
    to.evdev = from.evdev;
  }
  if (plan.has(Part::kHand)) to.hand = from.hand;
  if (plan.has(Part::kPostures)) {
    to.postures = from.postures;
    to.posture_hold = from.posture_hold;
    to.posture_drift = from.posture_drift;
  }
  if (plan.has(Part::kRate)) running.wall.governor = fresh.wall.governor;
  if (plan.has(Part::kPlaylist)) running.wall.playlist = fresh.wall.playlist;
  // All of it: a change of the rest of the scene would have needed a restart.
  if (plan.has(Part::kScene)) running.wall.scene = fresh.wall.scene;
}

}  // namespace merlin::reload
