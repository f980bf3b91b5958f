#include "drivers/pjlink/schedule.h"

#include <algorithm>

namespace merlin::pjlink {
namespace {

constexpr LocalMinute kDay = 24 * 60;
constexpr LocalMinute kSetBack = 3 * 60;  // more than any daylight-saving change
constexpr LocalMinute kFirstWeekday = 3;  // 1970-01-01 was a Thursday

}  // namespace

Schedule::Schedule(const std::vector<SwitchingTimes>& times) {
  for (const SwitchingTimes& t : times)
    times_.push_back(
        {weekdayBits(t.days), minuteOfDay(t.on).value_or(0), minuteOfDay(t.off).value_or(0)});
}

bool Schedule::isOn(LocalMinute now) const {
  const LocalMinute minute = ((now % kDay) + kDay) % kDay;
  const LocalMinute weekday = ((((now - minute) / kDay + kFirstWeekday) % 7) + 7) % 7;
  const auto includes = [](const Times& t, LocalMinute day) { return (t.days >> day & 1U) != 0; };
  return std::ranges::any_of(times_, [&](const Times& t) {
    if (t.on < t.off) return includes(t, weekday) && minute >= t.on && minute < t.off;
    return (includes(t, weekday) && minute >= t.on) ||
           (includes(t, (weekday + 6) % 7) && minute < t.off);
  });
}

std::optional<bool> Schedule::step(LocalMinute now) {
  if (times_.empty()) return std::nullopt;
  if (last_ && now < latest_ && latest_ - now <= kSetBack) return std::nullopt;
  latest_ = now;
  const bool on = isOn(now);
  if (last_ == on) return std::nullopt;
  last_ = on;
  return on;
}

}  // namespace merlin::pjlink
