#include "daemon/page/event_log.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/json/json_tree.h"
#include "daemon/page/gate.h"

namespace merlin::page {
namespace {

constexpr std::size_t kKeptEvents = 500, kSentEvents = 200, kLongest = 1000;
constexpr std::size_t kTime = 27, kUsual = 160;  // characters of a time and of a usual sentence

std::string utcNow() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  std::tm tm{};
  ::gmtime_r(&now.tv_sec, &tm);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", tm.tm_year + 1900, tm.tm_mon + 1,
                     tm.tm_mday, tm.tm_hour, tm.tm_min, tm.tm_sec, now.tv_nsec / 1000);
}

std::string cut(std::string_view text) {
  return std::string(wholeCharacters(text.substr(0, kLongest)));
}

}  // namespace

EventLog::EventLog(std::uint64_t first) : next_(first) {
  for (std::size_t i = 0; i < kKeptEvents; ++i) {
    LoggedEvent& event = events_.emplace_back();
    event.time_utc.reserve(kTime);
    event.what.reserve(kUsual);
  }
}

void EventLog::addDocument(const std::string& role, const std::string& document) {
  const auto parsed = parseJson(document);
  if (!parsed) return;
  LoggedEvent event{.role = role};
  for (const auto& [key, line, value] : parsed->members) {
    if (value.kind != JsonNode::Kind::kString) continue;
    if (key == "time_utc") event.time_utc = cut(value.text);
    if (key == "kind") event.kind = cut(value.text);
    if (key == "what") event.what = cut(value.text);
    if (key == "severity") event.severity = severityOf(value.text);
  }
  if (!event.what.empty()) keep(event);
}

void EventLog::add(const std::string& role, const std::string& kind, const std::string& what) {
  keep({.role = role, .time_utc = utcNow(), .kind = kind, .what = cut(what)});
}

// Reuses the memory of the oldest event for the newest one, by copying the strings into the memory
// that they have reserved.
void EventLog::keep(const LoggedEvent& event) {
  const std::lock_guard lock(mutex_);
  LoggedEvent kept = std::move(events_.front());
  events_.pop_front();
  kept = event;
  kept.number = next_++;
  events_.push_back(std::move(kept));
}

std::vector<LoggedEvent> EventLog::after(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  return {std::ranges::upper_bound(events_, number, {}, &LoggedEvent::number), events_.end()};
}

std::string EventLog::since(std::uint64_t since) const {
  const std::lock_guard lock(mutex_);
  if (since >= next_) since = 0;
  auto from = std::ranges::upper_bound(events_, since, {}, &LoggedEvent::number);
  if (events_.end() - from > static_cast<std::ptrdiff_t>(kSentEvents))
    from = events_.end() - static_cast<std::ptrdiff_t>(kSentEvents);
  std::string list;
  for (; from != events_.end(); ++from) {
    list += fmt::format(R"({}{{"number":{},"role":{},"time_utc":{},"kind":{},"what":{}}})",
                        list.empty() ? "" : ",", from->number, jsonText(from->role),
                        jsonText(from->time_utc), jsonText(from->kind), jsonText(from->what));
  }
  return fmt::format("{{\"next\":{},\"events\":[{}]}}\n", next_, list);
}

}  // namespace merlin::page
