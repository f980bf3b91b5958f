// EventLog: the last events of all roles and of the page, numbered.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"

namespace merlin::page {

struct LoggedEvent {
  std::uint64_t number = 0;
  std::string role;                  // "wall", "devices", "page"
  std::string time_utc = {};         // ISO 8601
  std::string kind = {}, what = {};  // a word and a sentence
  Severity severity = Severity::kFault;
};

// Thread-safe. Keeps 500 events, in memory that is taken at the start: a page that has run for
// hours is as large as one that has just started, unless its events are longer than is usual.
class EventLog {
 public:
  // `first`: number of the first event, 1 or more. If it is the time of the start, in milliseconds,
  // numbers grow over restarts, so that a client with a number of an earlier run gets everything.
  explicit EventLog(std::uint64_t first);

  // Adds what a role published as `event`. What is malformed is left out; long texts are cut.
  void addDocument(const std::string& role, const std::string& document);
  // Adds an event of the page itself, with the time of day.
  void add(const std::string& role, const std::string& kind, const std::string& what);

  // Those that are kept and have a number above `number`, the oldest first.
  std::vector<LoggedEvent> after(std::uint64_t number) const;

  // {"next": N, "events": [{"number", "role", "time_utc", "kind", "what"}]}: those after number
  // `since`, the oldest first, at most the last 200.
  std::string since(std::uint64_t since) const;

 private:
  void keep(const LoggedEvent& event);

  mutable std::mutex mutex_;
  // Always 500, the oldest first; number 0: none yet. Guarded by mutex_, as is next_.
  std::deque<LoggedEvent> events_;
  std::uint64_t next_;
};

}  // namespace merlin::page
