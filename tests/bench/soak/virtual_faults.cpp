// The faults and reloads of a VirtualDay.
#include <algorithm>
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "config/effective.h"
#include "config/loader.h"
#include "daemon/reload/answer.h"
#include "daemon/reload/plan.h"
#include "tests/bench/soak/virtual_day.h"

namespace merlin::bench {

using nlohmann::json;
using reload::Part;

void VirtualDay::faults(const std::stop_token& stop, Timestamp end) {
  constexpr Fault kFaults[] = {
      &VirtualDay::unplugDevice, &VirtualDay::switchDeviceOff,    &VirtualDay::disturbLine,
      &VirtualDay::unplugOutput, &VirtualDay::removeSharedMemory, &VirtualDay::fillDisk,
      &VirtualDay::slowRenderer, &VirtualDay::blackenOutput,      &VirtualDay::reloadWell,
      &VirtualDay::reloadWell,   &VirtualDay::reloadBadly};
  std::exponential_distribution<double> pause(1.0 / 90);
  std::vector<Fault> deck;
  while (!stop.stop_requested()) {
    if (!sleep(30 + pause(random_))) return;
    if (end - parts_.clock.now() < std::chrono::seconds(240)) return;
    if (deck.empty()) {
      deck.assign(std::begin(kFaults), std::end(kFaults));
      std::shuffle(deck.begin(), deck.end(), random_);
    }
    const Fault fault = deck.back();
    deck.pop_back();
    ++counts_.faults;
    (this->*fault)();
  }
}

void VirtualDay::unplugDevice() {
  const std::size_t device = below(parts_.devices.count());
  explainDevice("device unplugged", device);
  parts_.devices.line(device).plug(false);
  (void)sleep(between(2, 60));
  parts_.devices.line(device).plug(true);
}

void VirtualDay::switchDeviceOff() {
  const std::size_t device = below(parts_.devices.count());
  explainDevice("device switched off", device);
  parts_.devices.line(device).power(false);
  (void)sleep(between(12, 60));  // long, since even a working ball at rest is silent for seconds
  parts_.devices.line(device).power(true);
}

// Inserts a disturbance, which may be too short to make the driver reconnect.
void VirtualDay::disturbLine() {
  const std::size_t device = below(parts_.devices.count());
  const std::string& name = parts_.devices.name(device);
  explain("line disturbed", "device", "^" + name + ": ", false, 60);
  explain("line disturbed", "flight", name, false, 60);
  std::string noise;
  for (std::size_t i = 16 + below(400); i > 0; --i) noise += static_cast<char>(random_());
  parts_.devices.line(device).disturb(noise);
}

void VirtualDay::removeSharedMemory() {
  const char* const which = std::array{"devices", "wall", "framebuffer"}[below(3)];
  explain("shared memory removed", "service", "^shared memory: failed", true);
  explain("shared memory removed", "service", "^shared memory: works again", true);
  std::filesystem::remove("/dev/shm" + shm::segmentName(configured_.instance, which));
}

void VirtualDay::fillDisk() {
  explain("disk full", "service", "^state: failed", true);
  explain("disk full", "service", "^state: works again", true);
  const auto change = [this] {
    keeper_.change([this](state::State& s) { s.content = fmt::format("content {}", ++variant_); });
    keeper_.settle();
  };
  disk_->full = true;
  change();
  (void)sleep(between(3, 30));
  disk_->full = false;
  change();
  // The state keeper's thread runs in real time, so virtual time stands still until it has saved
  // the state.
  SystemClock system;
  for (int i = 0; !keeper_.fault().empty() && i < 5000; ++i)
    (void)system.sleepUntil(system.now() + std::chrono::milliseconds(1), {});
}

void VirtualDay::slowRenderer() {
  explain("renderer slow", "wall", "^(the operator's view|tiles at|frame rate)", false, 300);
  parts_.wall.faults().slower = between(3, 12);
  const double seconds = between(10, 60);
  slow_until_ = parts_.clock.now() + fromSeconds(seconds + 60);
  (void)sleep(seconds);
  parts_.wall.faults().slower = 1;
}

void VirtualDay::unplugOutput() {
  explain("output unplugged", "wall", "^output shared failed: the display was unplugged", true);
  explain("output unplugged", "wall", "^output shared works again", true);
  // The unplugged output does not show what it should, so the picture checks may report that too.
  explain("output unplugged", "picture", "^output shared ");
  parts_.wall.faults().unplugged = true;
  (void)sleep(between(3, 25));
  parts_.wall.faults().unplugged = false;
}

void VirtualDay::blackenOutput() {
  const bool is_black = parts_.wall.attendance().shown() == shm::WallInteraction::kBlank;
  explain("output black", "picture", "^output shared is black instead of what was meant",
          !is_black);
  explain("output black", "picture", "^output shared shows what was meant again", !is_black);
  parts_.wall.faults().blackened = true;
  (void)sleep(between(15, 40));
  parts_.wall.faults().blackened = false;
}

void VirtualDay::reloadWell() {
  const json variants[] = {
      {{"bindings", {{{"input", "posture.fist"}, {"action", "fly"}}}}},
      {{"bindings", {{{"input", "posture.fist"}, {"action", "grab"}}}}},
      {{"postures", {{"hold_s", 0.2}}}},
      {{"hands", {{{"cutoff_hz", 4}}}}},
      {{"wall", {{"rate", {{"late_share", 0.02}}}, {"scene", {{"hand_gain", 2}}}}}},
      {{"wall", {{"playlist", {{"after_s", 120}, {"hold_s", 20}}}}}}};
  if (!reload(variants[++variant_ % std::size(variants)]))
    counts_.wrong.emplace_back("a good reload was refused");
}

void VirtualDay::reloadBadly() {
  const json variants[] = {{{"postures", {{"hold_s", "long"}}}},
                           {{"wall", {{"no_such_key", 1}}}},
                           {{"wall", {{"render", {{"wireframe", "yes"}}}}}},
                           {{"bindings", {{{"input", "posture.fist"}, {"action", "no_such"}}}}}};
  explain("bad reload", "service", "^configuration: failed", true);
  explain("bad reload", "service", "^configuration: works again", true);
  if (reload(variants[++variant_ % std::size(variants)]))
    counts_.wrong.emplace_back("a bad reload was taken");
  (void)sleep(between(2, 20));
  if (!reload(json::object())) counts_.wrong.emplace_back("a good reload was refused");
}

// Does what merlind's Reloader does, but without the Reloader's thread.
bool VirtualDay::reload(const json& patch) {
  ++counts_.reloads;
  json changed = parts_.configuration;
  changed.merge_patch(patch);
  const LoadedSettings fresh = loadSettings(changed.dump(), parts_.folder);
  reload::Answer answer;
  if (fresh.verdict() == LoadedSettings::Verdict::kInvalid) {
    answer.outcome = reload::Outcome::kInvalid;
    for (const Finding& finding : fresh.findings)
      answer.findings.push_back(toText("soak.json", finding));
  } else {
    answer.plan = reload::planFor(changesBetween(configured_, fresh.settings),
                                  reload::kDevices | reload::kWall);
  }
  if (answer.outcome != reload::Outcome::kDone) {
    services_.failed("configuration", reload::refusal(answer));
    return false;
  }
  const reload::Plan& plan = answer.plan;
  reload::adopt(plan, fresh.settings, true, parts_.settings);
  parts_.devices.reload(parts_.settings, plan.has(Part::kBindings), plan.has(Part::kHand),
                        plan.has(Part::kPostures));
  parts_.wall.reload(parts_.settings, plan.has(Part::kRate), plan.has(Part::kPlaylist),
                     plan.has(Part::kScene), plan.has(Part::kBindings) || plan.has(Part::kHand));
  configured_ = fresh.settings;
  services_.ok("configuration");
  return true;
}

}  // namespace merlin::bench
