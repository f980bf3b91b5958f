#include "daemon/alarms/told_events.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/event_kinds.h"
#include "daemon/json/json_tree.h"

namespace merlin::alarms {
namespace {

AlarmEvent eventOf(const std::string& role, const JsonNode& document) {
  AlarmEvent event;
  event.role = role;
  for (const auto& [key, line, value] : document.members) {
    if (value.kind != JsonNode::Kind::kString) continue;
    if (key == "time_utc") event.time_utc = value.text;
    if (key == "kind") event.kind = value.text;
    if (key == "what") event.what = value.text;
    if (key == "severity") event.severity = severityOf(value.text);
  }
  return event;
}

}  // namespace

std::vector<AlarmEvent> eventsOf(const std::string& role, const std::string& answer) {
  std::vector<AlarmEvent> events;
  const auto parsed = parseJson(answer);
  if (!parsed) return events;
  for (const JsonNode& document : parsed->items) {
    AlarmEvent event = eventOf(role, document);
    if (!event.what.empty()) events.push_back(std::move(event));
  }
  return events;
}

bool ToldEvents::take(const AlarmEvent& event, bool works) {
  std::string key = fmt::format("{} {} {} {}", event.role, event.time_utc, event.kind, event.what);
  if (std::ranges::find(last_, key) != last_.end()) return false;
  last_.push_back(std::move(key));
  if (last_.size() > kKept) last_.pop_front();
  if (event.kind != kDeviceEvent.name) return true;
  const std::string device = event.what.substr(0, event.what.find(':'));
  if (works) return complained_.erase(device) > 0;
  complained_.insert(device);
  return true;
}

}  // namespace merlin::alarms
