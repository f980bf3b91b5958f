#include "daemon/wall/operator_facts_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "daemon/base/printable_text.h"

namespace merlin::wall {
namespace {

using render::text::DeviceFact;
using render::text::DeviceLight;
using render::text::OperatorFacts;

constexpr Duration kStale = std::chrono::seconds(1);
constexpr Duration kShown = std::chrono::minutes(1), kFades = std::chrono::seconds(10);

template <std::size_t size>
std::string textOf(const char (&bytes)[size]) {
  return std::string(wholeCharacters({bytes, ::strnlen(bytes, size)}));
}

// Why it is not well is said where there is a reason.
DeviceFact deviceFact(std::string name, const DeviceHealth& health, Timestamp now) {
  const auto with_reason = [&health](const char* state) {
    const std::string reason = textOf(health.reason);
    return reason.empty() ? std::string(state) : state + (": " + reason);
  };
  switch (health.state) {
    case HealthState::kOk:
      if (now - fromNanoseconds(health.updated_ns) > kStale)
        return {std::move(name), "stale", DeviceLight::kBad};
      return {std::move(name), with_reason("ok"),
              health.reason[0] == '\0' ? DeviceLight::kGood : DeviceLight::kWaiting};
    case HealthState::kOpening: return {std::move(name), "opening", DeviceLight::kWaiting};
    case HealthState::kAbsent: return {std::move(name), with_reason("absent"), DeviceLight::kBad};
    case HealthState::kFailed: break;
  }
  return {std::move(name), with_reason("failed"), DeviceLight::kBad};
}

// In steps of an eighth, so that a message that fades changes the plate eight times.
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
  facts.budget = s->budget;
  facts.budget_by_hand = s->held_cost > 0;
  facts.full_detail = s->full_detail != 0;
  facts.cost_unit = textOf(s->cost_unit);
  const bool flies = std::string_view(s->mode) == "fly";
  facts.mode = flies ? "moves the viewer" : "moves the model";
  facts.posture = textOf(s->posture);
}

void OperatorFactsReader::readContent(OperatorFacts& facts) const {
  const auto content = wall_.content.read();
  if (!content) return;
  facts.content = textOf(content->name);
  facts.slide = textOf(content->slide);
}

// The trace keeps 256 periods: more than a second at the highest rate.
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
  if (!devices) return;
  for (const auto& [name, slot] : devices->health) {
    if (const auto health = slot->read()) facts.devices.push_back(deviceFact(name, *health, now));
  }
}

void OperatorFactsReader::readMessages(Timestamp now, OperatorFacts& facts) {
  board_.tryRead(messages_);  // otherwise those that were read last
  for (const BoardMessage& message : messages_) {
    const float strength = strengthAt(now - message.at);
    if (strength > 0) facts.messages.push_back({message.text, strength});
  }
}

}  // namespace merlin::wall
