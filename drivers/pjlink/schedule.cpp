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

std::optional<Schedule::Switching> Schedule::next(LocalMinute now) const {
  const LocalMinute midnight = now - ((now % kDay) + kDay) % kDay;
  std::vector<LocalMinute> points;
  for (LocalMinute day = 0; day <= 7; ++day) {
    for (const Times& t : times_) {
      for (const int minute : {t.on, t.off}) points.push_back(midnight + day * kDay + minute);
    }
  }
  std::ranges::sort(points);
  for (const LocalMinute point : points) {
    if (point > now && isOn(point) != isOn(point - 1)) return Switching{point, isOn(point)};
  }
  return std::nullopt;
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
