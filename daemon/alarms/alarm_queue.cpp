#include "daemon/alarms/alarm_queue.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/event_kinds.h"
#include "daemon/json/json_tree.h"

namespace merlin::alarms {

std::string alarmText(const std::string& instance, const AlarmEvent& event,
                      std::uint64_t left_out) {
  return fmt::format(
      R"({{"instance": {}, "role": {}, "time_utc": {}, "kind": {}, "what": {}, "left_out": {}}})"
      "\n",
      jsonText(instance), jsonText(event.role), jsonText(event.time_utc), jsonText(event.kind),
      jsonText(event.what), left_out);
}

// Half of the starts that an hour allows fill the bucket for bursts, and the other half are added
// over the hour. With a bucket for all of them, twice as many starts would be possible within an
// hour.
AlarmQueue::AlarmQueue(const AlarmSettings& settings)
    : settings_(settings),
      at_once_(std::max(settings.most_per_hour / 2.0, 1.0)),
      starts_(std::max(settings.most_per_hour / 2.0, 0.5) / 3600, at_once_) {}

bool AlarmQueue::isFor(const AlarmEvent& event) const {
  if (event.severity == Severity::kRoutine) return false;
  return settings_.kinds.empty() || event.kind == kTestKind ||
         std::ranges::find(settings_.kinds, event.kind) != settings_.kinds.end();
}

void AlarmQueue::add(const AlarmEvent& event) {
  if (!isFor(event)) return;
  waiting_.push_back({event, std::nullopt});
  if (waiting_.size() <= kMost) return;
  const auto news = std::ranges::find_if(waiting_, [](const Waiting& w) { return !isFault(w); });
  waiting_.erase(news == waiting_.end() ? waiting_.begin() : news);
  ++left_out_;
}

std::deque<AlarmQueue::Waiting>::iterator AlarmQueue::mostUrgent() {
  return std::ranges::min_element(waiting_, {}, [](const Waiting& waiting) {
    if (waiting.event.kind == kTestKind) return 0;
    return isFault(waiting) ? 1 : 2;
  });
}

bool AlarmQueue::mayStart(const AlarmEvent& event, Timestamp now) {
  if (event.kind == kTestKind) return true;
  const bool leaves_one = event.severity == Severity::kFault || at_once_ < 2;
  return starts_.available(now) >= (leaves_one ? 1 : 2) && starts_.take(1, now);
}

std::optional<AlarmQueue::Next> AlarmQueue::next(Timestamp now) {
  for (Waiting& waiting : waiting_) {
    if (!waiting.since) waiting.since = now;
  }
  left_out_ += std::erase_if(waiting_, [&](const Waiting& waiting) {
    return now - *waiting.since > (isFault(waiting) ? kLongestFaultWait : kLongestWait);
  });
  if (waiting_.empty()) return std::nullopt;
  const auto urgent = mostUrgent();
  if (!mayStart(urgent->event, now)) return std::nullopt;
  Next next{std::move(urgent->event), std::exchange(left_out_, 0)};
  waiting_.erase(urgent);
  return next;
}

}  // namespace merlin::alarms
