#include "daemon/status/health_events.h"

#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"
#include "daemon/status/documents.h"
#include "drivers/port/health_reasons.h"

namespace merlin::status {
namespace {

// Whether the absence of a device is intended.
bool isIntended(std::string_view reason) { return reason == kNotConfigured || reason == kStopped; }

// Whether the device is being opened, or will be because the process has just started. This is not
// an event, because an absent device is opened again every second.
bool isBeingOpened(const DeviceHealth& health) {
  return health.state == HealthState::kOpening || textIn(health.reason) == kNotOpenedYet;
}

}  // namespace

bool HealthEvents::isBrief(Told& told, const DeviceHealth& health, Timestamp now) noexcept {
  if (health.state != HealthState::kOk) return false;
  told.ok_ns = health.since_ns;
  if (now - fromNanoseconds(health.since_ns) >= shm::kBriefly) told.recurs = false;
  return told.recurs;
}

void HealthEvents::tellFault(Told& told, const DeviceHealth& health, const std::string& sentence) {
  if (health.state == HealthState::kOk) return;  // a device that works has a complaint, not a fault
  const bool brief = health.since_ns < told.ok_ns + shm::kBriefly.count();
  told.recurs = told.recurs || (sentence == told.fault && brief);
  told.fault = sentence;
}

std::vector<Event> HealthEvents::take(Timestamp now) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < devices_.health.size(); ++i) {
    const auto& [device, slot] = devices_.health[i];
    const auto health = slot->read();
    if (!health || isBeingOpened(*health)) continue;
    Told& told = told_[i];
    if (isBrief(told, *health, now)) continue;
    const std::string_view state = shm::healthName(*health, now);
    const std::string_view why = health->state == HealthState::kOk && health->reason[0] == '\0'
                                     ? health->identity
                                     : health->reason;
    std::string sentence = fmt::format("{}: {} ({})", device, state, why);
    if (sentence == told.last) continue;
    told.last = sentence;
    const bool works = state == "ok" && health->reason[0] == '\0';
    const Severity unless_it_works =
        isIntended(health->reason) ? Severity::kRoutine : Severity::kFault;
    if (!works) tellFault(told, *health, sentence);
    events.push_back({std::move(sentence), works ? Severity::kNews : unless_it_works});
  }
  return events;
}

std::vector<Event> HealthEvents::takeGestures() {
  std::vector<Event> events;
  for (std::size_t i = 0; i < devices_.hands.size(); ++i) {
    const auto gesture = devices_.hands[i].gesture->read();
    if (!gesture || gesture->counter == last_gestures_[i]) continue;
    last_gestures_[i] = gesture->counter;
    if (gesture->counter > 0)
      events.push_back(routineEvent(
          fmt::format("{}: gesture {}", devices_.hands[i].name, textIn(gesture->name))));
  }
  return events;
}

}  // namespace merlin::status
