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

// Thread-safe. Keeps 500 events in memory that is allocated at the start, so that the process does
// not grow over hours, unless events are longer than usual.
class EventLog {
 public:
  // `first`: number of the first event, 1 or more. If it is the time of the start, in milliseconds,
  // numbers grow over restarts, so that a client with a number of an earlier run gets everything.
  explicit EventLog(std::uint64_t first);

  // Adds a document that a role published as `event`. A malformed document is ignored; long texts
  // are cut.
  void addDocument(const std::string& role, const std::string& document);
  // Adds an event of this process itself, with the present time.
  void add(const std::string& role, const std::string& kind, const std::string& what);

  // Returns the kept events with a number above `number`, the oldest first.
  std::vector<LoggedEvent> after(std::uint64_t number) const;

  // Returns {"next": N, "events": [{"number", "role", "time_utc", "kind", "what"}]}: the events
  // after number `since`, the oldest first, at most the last 200. N is the number of the next
  // event. If `since` is N or more, the client has it from an earlier run, before the clock was set
  // back; then all kept events count as new.
  std::string since(std::uint64_t since) const;

 private:
  void keep(const LoggedEvent& event);

  mutable std::mutex mutex_;
  // Always 500, the oldest first; number 0: none yet. Guarded by mutex_, as is next_.
  std::deque<LoggedEvent> events_;
  std::uint64_t next_;
};

}  // namespace merlin::page
