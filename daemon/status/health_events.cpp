#include "daemon/status/health_events.h"

#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"
#include "daemon/status/documents.h"

namespace merlin::status {

std::vector<std::string> HealthEvents::take(Timestamp now) {
  std::vector<std::string> events;
  for (std::size_t i = 0; i < devices_.health.size(); ++i) {
    const auto& [device, slot] = devices_.health[i];
    const auto health = slot->read();
    // Opening is not an event: an absent device is opened again every second.
    if (!health || health->state == HealthState::kOpening) continue;
    const std::string_view state = shm::healthName(*health, now);
    const std::string_view why = health->state == HealthState::kOk && health->reason[0] == '\0'
                                     ? health->identity
                                     : health->reason;
    std::string sentence = fmt::format("{}: {} ({})", device, state, why);
    if (sentence == last_[i]) continue;
    last_[i] = sentence;
    events.push_back(std::move(sentence));
  }
  return events;
}

std::vector<std::string> HealthEvents::takeGestures() {
  std::vector<std::string> events;
  for (std::size_t i = 0; i < devices_.hands.size(); ++i) {
    const auto gesture = devices_.hands[i].gesture->read();
    if (!gesture || gesture->counter == last_gestures_[i]) continue;
    last_gestures_[i] = gesture->counter;
    if (gesture->counter > 0)
      events.push_back(
          fmt::format("{}: gesture {}", devices_.hands[i].name, textIn(gesture->name)));
  }
  return events;
}

}  // namespace merlin::status
