// AlarmQueue: decides for which events one alarm's program is started, and when. Pure: the caller
// passes the time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "daemon/alarms/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/token_bucket.h"

namespace merlin::alarms {

struct AlarmEvent {
  std::string role;            // "wall", "devices", "alarms"
  std::string time_utc, kind;  // ISO 8601; EventKind::name
  std::string what;            // a sentence
  Severity severity = Severity::kFault;
};

// The kind of the event with which a person tests alarms: it starts the program of every alarm.
inline constexpr const char* kTestKind = "test";

// Returns the event as one line of JSON, which the program reads: {"instance", "role", "time_utc",
// "kind", "what", "left_out"}.
std::string alarmText(const std::string& instance, const AlarmEvent& event, std::uint64_t left_out);

// Thread-bound.
class AlarmQueue {
 public:
  explicit AlarmQueue(const AlarmSettings& settings);

  // Adds an event, if it is of a kind that the alarm is for and not routine. At most kMost events
  // wait; beyond that, the oldest that is not a fault is left out, or the oldest if all are faults.
  void add(const AlarmEvent& event);

  std::size_t waiting() const noexcept { return waiting_.size(); }

  struct Next {
    AlarmEvent event;
    std::uint64_t left_out = 0;  // number of events left out since the last one that was told
  };
  // Removes and returns the event for which the program is to be started now, faults first. Returns
  // nothing if no event waits, or if the limit most_per_hour allows no start now. After a quiet
  // time half of most_per_hour starts are allowed at once, the last of them only for a fault;
  // further starts are allowed over time. A test is exempt from the limit. Events that have waited
  // longer than kLongestWait (faults: kLongestFaultWait) are left out, since an old alarm would
  // mislead.
  std::optional<Next> next(Timestamp now);

  static constexpr std::size_t kMost = 32;
  static constexpr Duration kLongestWait = std::chrono::minutes(10);
  static constexpr Duration kLongestFaultWait = std::chrono::hours(1);

 private:
  struct Waiting {
    AlarmEvent event;
    std::optional<Timestamp> since;  // time of the first call of next() that saw it
  };
  static bool isFault(const Waiting& waiting) { return waiting.event.severity == Severity::kFault; }
  bool isFor(const AlarmEvent& event) const;
  std::deque<Waiting>::iterator mostUrgent();
  bool mayStart(const AlarmEvent& event, Timestamp now);

  AlarmSettings settings_;
  double at_once_;  // starts that are allowed at once, after a quiet time
  TokenBucket starts_;
  std::deque<Waiting> waiting_;  // the oldest first
  std::uint64_t left_out_ = 0;
};

}  // namespace merlin::alarms
