#include "daemon/base/clock.h"

#include <algorithm>
#include <ctime>

namespace merlin {
namespace {

// Longest delay before a stop request is noticed. Sleeps in slices instead of waiting on a
// condition variable: the ThreadSanitizer of g++ 12 does not know pthread_cond_clockwait, and 20
// wake-ups a second cost nothing.
constexpr Duration kSlice = std::chrono::milliseconds(50);

void sleepPlain(Timestamp when) noexcept {
  const std::int64_t ns = toNanoseconds(when);
  const timespec ts{ns / 1'000'000'000, ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &ts, nullptr) != 0) {
  }
}

}  // namespace

Timestamp SystemClock::now() const noexcept {
  timespec ts{};
  clock_gettime(CLOCK_MONOTONIC, &ts);
  return fromNanoseconds(std::int64_t{ts.tv_sec} * 1'000'000'000 + ts.tv_nsec);
}

bool SystemClock::sleepUntil(Timestamp when, const std::stop_token& stop) noexcept {
  for (;;) {
    if (stop.stop_requested()) return false;
    const Timestamp t = now();
    if (t >= when) return true;
    sleepPlain(std::min(when, t + kSlice));
  }
}

Duration realtimeOffset() noexcept {
  const Duration before = std::chrono::steady_clock::now().time_since_epoch();
  const Duration utc = std::chrono::system_clock::now().time_since_epoch();
  const Duration after = std::chrono::steady_clock::now().time_since_epoch();
  return utc - (before + (after - before) / 2);
}

}  // namespace merlin
