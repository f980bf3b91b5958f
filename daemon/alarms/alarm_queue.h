// AlarmQueue: which events one alarm's program is started for, and when. Pure: the caller passes
// the time.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "daemon/alarms/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/token_bucket.h"

namespace merlin::alarms {

struct AlarmEvent {
  std::string role;            // "wall", "devices", "alarms"
  std::string time_utc, kind;  // ISO 8601; a word
  std::string what;            // a sentence
};

// The kind of an event by which a person tests that an alarm arrives: every alarm is for it.
inline constexpr const char* kTestKind = "test";

// The event as one line of JSON: {"instance", "role", "time_utc", "kind", "what", "left_out"}.
std::string alarmText(const std::string& instance, const AlarmEvent& event, std::uint64_t left_out);

// Thread-bound.
class AlarmQueue {
 public:
  explicit AlarmQueue(const AlarmSettings& settings);

  // Takes an event, if it is of a kind that the alarm is for. At most kMost wait; of more the
  // oldest is left out.
  void add(const AlarmEvent& event);

  struct Next {
    AlarmEvent event;
    std::uint64_t left_out = 0;  // events since the last one that nobody was told of
  };
  // The event for which the program is to be started now; nothing if none waits, or while the
  // program was started most_per_hour times within the last hour. Those that wait longer than
  // kLongestWait are left out, since an alarm of yesterday would mislead.
  std::optional<Next> next(Timestamp now);

  static constexpr std::size_t kMost = 32;
  static constexpr Duration kLongestWait = std::chrono::minutes(10);

 private:
  struct Waiting {
    AlarmEvent event;
    std::optional<Timestamp> since;  // of the first call of next() that saw it
  };
  bool isFor(const AlarmEvent& event) const;

  AlarmSettings settings_;
  TokenBucket starts_;
  std::deque<Waiting> waiting_;
  std::uint64_t left_out_ = 0;
};

}  // namespace merlin::alarms
