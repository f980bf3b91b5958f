// Schedule: the times at which projectors are switched. Pure: the time of the local calendar is
// passed in.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/pjlink/settings.h"

namespace merlin::pjlink {

// A minute of the local calendar: minutes from 1970-01-01 00:00 to it, as if every day had 24
// hours.
using LocalMinute = std::int64_t;

// Thread-bound.
class Schedule {
 public:
  // REQUIRES: validate(times) finds no fault. Without times, nothing is ever switched.
  explicit Schedule(const std::vector<SwitchingTimes>& times);

  // Returns whether the projectors are to be on, that is, whether at least one entry says so.
  // O(entries).
  bool isOn(LocalMinute now) const;

  // Returns the next minute after `now` in which the scheduled state changes, and the state from
  // then on; nothing if the state does not change within a week. O(entries^2). May be called while
  // another thread calls step().
  struct Switching {
    LocalMinute at = 0;
    bool on = false;
  };
  std::optional<Switching> next(LocalMinute now) const;

  // To be called at least once a minute. Returns true (on) or false (off) when the scheduled state
  // has changed since the last call, and at the first call. While the local time repeats an hour
  // (daylight-saving time ends), or after it was set back by at most three hours, it returns
  // nothing until the time is later than before, so that each switching happens once. An hour that
  // is skipped counts as passed: its switchings happen at its end.
  std::optional<bool> step(LocalMinute now);

 private:
  struct Times {
    unsigned days;  // weekdayBits()
    int on, off;    // minutes after midnight
  };
  std::vector<Times> times_;
  std::optional<bool> last_;
  LocalMinute latest_ = 0;  // latest time at which step() was called
};

}  // namespace merlin::pjlink
