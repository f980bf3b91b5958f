// EventLogger: writes events to the log, faults as warnings, and leaves out what is repeated too
// often.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/log.h"
#include "daemon/base/token_bucket.h"

namespace merlin {

// A device with a loose plug, or a program that connects again and again, must not fill the
// journal. The same sentence (digits are ignored) is logged up to kSentences times at once, then
// once a minute; events of one kind up to kEvents times at once, then once in ten seconds. Events
// beyond that are counted, and a line reports their number as soon as the limit allows another
// line. Thread-bound.
class EventLogger {
 public:
  using Write = std::function<void(LogLevel, std::string_view text, const LogFields&)>;

  // `role`: the role whose events these are; must outlive this object.
  explicit EventLogger(std::string_view role, Write write = logLine)
      : role_(role), write_(std::move(write)) {}

  void log(const EventKind& kind, const Event& event, Timestamp now);
  // Logs how many events were left out, as soon as the limits allow that line. To be called
  // periodically.
  void tellLeftOut(Timestamp now);

  static constexpr int kSentences = 30, kEvents = 240;
  static constexpr std::size_t kMostSubjects = 256;  // most sentences that are tracked at a time

 private:
  // What a limit applies to: one sentence of a kind, or all events of a kind.
  struct Subject {
    EventKind kind;
    std::string sentence;  // the last one; empty if this is a kind
    bool is_fault = false;
    TokenBucket bucket;
    int left_out = 0;
    Timestamp used{};
  };
  Subject& subject(const EventKind& kind, const Event& event, Timestamp now);
  void forgetOldest();

  std::string_view role_;
  Write write_;
  std::map<std::string, Subject> sentences_, kinds_;
};

}  // namespace merlin
