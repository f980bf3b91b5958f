#include "daemon/wall/operator_facts_reader.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "daemon/base/fixed_text.h"
#include "daemon/base/printable_text.h"
#include "daemon/wall/useful_cost.h"
#include "drivers/port/health_reasons.h"

namespace merlin::wall {
namespace {

using render::text::DeviceFact;
using render::text::DeviceLight;
using render::text::OperatorFacts;

constexpr Duration kShown = std::chrono::minutes(1), kFades = std::chrono::seconds(10);

template <std::size_t N>
std::string textOf(const char (&field)[N]) {
  return std::string(wholeCharacters(textIn(field)));
}

// Whether the device has a port. If the configuration lists no devices, there are default devices
// without ports.
bool isConfigured(const DeviceHealth& health) { return textIn(health.reason) != kNotConfigured; }

// Returns the line about a device: its state, followed by the reason if there is one (a fault, or a
// warning of a device that works).
DeviceFact deviceFact(std::string name, const DeviceHealth& health, Timestamp now) {
  const std::string_view state = shm::healthName(health, now);
  const std::string reason = textOf(health.reason);
  const bool works = state == "ok", opens = state == "opening";
  DeviceFact fact{std::move(name), std::string(state), DeviceLight::kBad};
  if (!reason.empty() && !opens && state != "stale") fact.state += ": " + reason;
  if (works && reason.empty()) fact.light = DeviceLight::kGood;
  if (opens || (works && !reason.empty())) fact.light = DeviceLight::kWaiting;
  return fact;
}

// Returns a text about what the ball moves. Pictures and panoramas have no viewer that could be
// moved.
std::string ballMoves(std::string_view kind, bool flies) {
  if (kind == "picture") return "moves the picture";
  if (kind == "panorama") return "turns the view";
  return flies ? "moves the viewer" : "moves the model";
}

// Returns the opacity of a message of this age, in steps of an eighth, so that the plate is redrawn
// only eight times while the message fades.
float strengthAt(Duration age) {
  if (age <= kShown) return 1;
  const double left = 1 - toSeconds(age - kShown) / toSeconds(kFades);
  return static_cast<float>(std::ceil(std::max(left, 0.0) * 8) / 8);
}

}  // namespace

OperatorFacts OperatorFactsReader::read(Timestamp now) {
  OperatorFacts facts;
  readStats(facts);
  readContent(facts);
  readFrames(facts.rate_now_hz);
  facts.chart = chart_.at(now);
  readDevices(now, facts);
  readMessages(now, facts);
  return facts;
}

void OperatorFactsReader::readStats(OperatorFacts& facts) const {
  const auto s = wall_.stats.read();
  if (!s) return;
  facts.rate_asked_hz = static_cast<double>(s->rate_asked_hz);
  facts.rate_held_hz = std::round(static_cast<double>(s->rate_held_hz) * 10) / 10;
  facts.rate_now_hz = static_cast<double>(s->rate_now_hz);
  facts.late_percent = std::round(static_cast<double>(s->late_share_1min) * 1000) / 10;
  facts.cost = s->cost;
  facts.full_cost = s->full_cost;
  facts.budget = usefulCost(*s, s->budget);
  facts.budget_by_hand = s->held_cost > 0;
  facts.full_detail = s->full_detail != 0;
  facts.cost_unit = textOf(s->cost_unit);
  facts.posture = textOf(s->posture);
}

void OperatorFactsReader::readContent(OperatorFacts& facts) const {
  const auto content = wall_.content.read();
  const auto stats = wall_.stats.read();
  if (!content) return;
  facts.mode = ballMoves(textOf(content->kind), stats && textIn(stats->mode) == "fly");
  facts.content = textOf(content->name);
  facts.slide = textOf(content->slide);
}

// Adds the new moving frames of the trace to the chart. The trace contains the last 256 periods,
// i.e. more than a second at the highest rate.
void OperatorFactsReader::readFrames(double rate_hz) {
  const std::uint64_t count = wall_.trace.count();
  if (count - frames_read_ >= shm::kHistory)
    frames_read_ = count - std::min(count, shm::kHistory - 1);
  for (; frames_read_ < count; ++frames_read_) {
    const auto frame = wall_.trace.at(frames_read_);
    if (!frame || !frame->moving || rate_hz <= 0) continue;
    chart_.add({fromNanoseconds(frame->begin_ns), fromNanoseconds(frame->end_ns),
                fromNanoseconds(frame->deadline_ns), fromSeconds(1 / rate_hz), frame->late != 0});
  }
}

void OperatorFactsReader::readDevices(Timestamp now, OperatorFacts& facts) {
  const shm::DeviceSlots* const devices = devices_.get(now);
  facts.devices_missing = !devices && expects_devices_;
  if (!devices) return;
  for (const auto& [name, slot] : devices->health) {
    const auto health = slot->read();
    if (health && isConfigured(*health)) facts.devices.push_back(deviceFact(name, *health, now));
  }
}

void OperatorFactsReader::readMessages(Timestamp now, OperatorFacts& facts) {
  board_.tryRead(messages_);  // if this fails, messages_ does not change
  for (const BoardMessage& message : messages_) {
    const float strength = strengthAt(now - message.at);
    if (strength > 0) facts.messages.push_back({message.text, strength});
  }
}

}  // namespace merlin::wall
