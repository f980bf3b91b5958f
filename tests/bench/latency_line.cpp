#include "tests/bench/latency_line.h"

#include <span>
#include <string>

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include "daemon/base/clock.h"

namespace merlin::bench {

bool askForRealTime() {
  const sched_param priority{50};
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority) == 0;
}

void serveDialogue(int fd, emulate::Emulator& emulator, const std::function<bool()>& done) {
  const SystemClock clock;
  std::byte received[64];
  std::string out;
  while (!done()) {
    pollfd item{fd, POLLIN, 0};
    ::poll(&item, 1, 1);
    const ssize_t n = ::read(fd, received, sizeof received);
    if (n > 0) emulator.receive(std::span(received, static_cast<std::size_t>(n)), clock.now());
    emulator.advance(clock.now(), out);
    if (!out.empty()) (void)!::write(fd, out.data(), out.size());
    out.clear();
  }
}

void serveGreeting(int fd, const std::string& greeting, const std::function<bool()>& done) {
  (void)!::write(fd, greeting.data(), greeting.size());
  std::byte asked[256];
  while (!done()) {
    pollfd item{fd, POLLIN, 0};
    if (::poll(&item, 1, 1) > 0) (void)!::read(fd, asked, sizeof asked);
  }
}

void atIrregularTimes(std::uint32_t count, double rate_hz,
                      const std::function<void(std::uint32_t n)>& send) {
  const SystemClock clock;
  Timestamp due = clock.now();
  for (std::uint32_t i = 0; i < count; ++i) {
    due += fromSeconds((0.5 + static_cast<double>(i * 7919 % 1000) / 1000) / rate_hz);
    timespec at{due.time_since_epoch() / std::chrono::seconds(1),
                (due.time_since_epoch() % std::chrono::seconds(1)).count()};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    send(i);
  }
}

}  // namespace merlin::bench
