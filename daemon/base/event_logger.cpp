#include "daemon/base/event_logger.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr double kSentencesPerSecond = 1.0 / 60, kEventsPerSecond = 1.0 / 10;

LogLevel levelOf(bool is_fault) { return is_fault ? LogLevel::kWarning : LogLevel::kInfo; }

// Removes the figures from a sentence, so that "rate reduced to 14.9 of 30 Hz" equals "... 15.1
// ...".
std::string withoutFigures(std::string_view sentence) {
  std::string text;
  for (const char c : sentence) {
    const bool is_figure = c >= '0' && c <= '9';
    if (!is_figure || text.empty() || text.back() != '#') text += is_figure ? '#' : c;
  }
  return text;
}

}  // namespace

EventLogger::Subject& EventLogger::subject(const EventKind& kind, const Event& event,
                                           Timestamp now) {
  const std::string key = fmt::format("{}: {}", kind.name, withoutFigures(event.what));
  if (!sentences_.contains(key) && sentences_.size() >= kMostSubjects) forgetOldest();
  const TokenBucket bucket(kSentencesPerSecond, kSentences);
  Subject& found = sentences_.try_emplace(key, Subject{kind, {}, false, bucket}).first->second;
  found.sentence = event.what;
  found.is_fault = event.isFault();
  found.used = now;
  return found;
}

void EventLogger::forgetOldest() {
  const auto oldest =
      std::ranges::min_element(sentences_, {}, [](const auto& entry) { return entry.second.used; });
  Subject& kind = kinds_.at(oldest->second.kind.name);
  kind.left_out += oldest->second.left_out;
  sentences_.erase(oldest);
}

void EventLogger::log(const EventKind& kind, const Event& event, Timestamp now) {
  const TokenBucket bucket(kEventsPerSecond, kEvents);
  Subject& all = kinds_.try_emplace(kind.name, Subject{kind, {}, false, bucket}).first->second;
  Subject& same = subject(kind, event, now);
  if (!same.bucket.take(1, now)) {
    ++same.left_out;
  } else if (!all.bucket.take(1, now)) {
    ++all.left_out;
  } else {
    write_(levelOf(event.isFault()), event.what, {kind.name, role_});
  }
}

void EventLogger::tellLeftOut(Timestamp now) {
  for (auto& [key, same] : sentences_) {
    if (same.left_out == 0 || !same.bucket.take(1, now)) continue;
    write_(levelOf(same.is_fault),
           fmt::format("{} more of these events were left out of the log, the last: {}",
                       std::exchange(same.left_out, 0), same.sentence),
           {same.kind.name, role_});
  }
  for (auto& [key, all] : kinds_) {
    if (all.left_out == 0 || !all.bucket.take(1, now)) continue;
    write_(LogLevel::kWarning,
           fmt::format("{} more events of the kind {} were left out of the log",
                       std::exchange(all.left_out, 0), key),
           {all.kind.name, role_});
  }
}

}  // namespace merlin
