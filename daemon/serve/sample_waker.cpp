#include "daemon/serve/sample_waker.h"

#include <cerrno>
#include <ctime>
#include <utility>

#include <linux/futex.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "daemon/base/clock.h"

namespace merlin::serve {
namespace {

constexpr Duration kWakerRound = std::chrono::milliseconds(50);
constexpr long kWithoutWaitv_ns =
    2'000'000;  // poll interval before Linux 5.16, which has no futex_waitv

// Waits until one of the words differs from its value in `seen`, or kWakerRound has passed.
void waitForAny(const std::vector<const std::atomic<std::uint32_t>*>& words,
                const std::vector<std::uint32_t>& seen) {
  if (words.empty()) {  // no device is configured that could send samples
    const timespec round{0, kWakerRound.count()};
    ::nanosleep(&round, nullptr);
    return;
  }
#ifdef SYS_futex_waitv
  std::vector<futex_waitv> waiters(words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    waiters[i].val = seen[i];
    waiters[i].uaddr = reinterpret_cast<std::uintptr_t>(words[i]);
    waiters[i].flags = FUTEX_32;
  }
  timespec until{};
  ::clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_nsec += kWakerRound.count();
  if (until.tv_nsec >= 1'000'000'000) {
    ++until.tv_sec;
    until.tv_nsec -= 1'000'000'000;
  }
  const long done =
      ::syscall(SYS_futex_waitv, waiters.data(), waiters.size(), 0, &until, CLOCK_MONOTONIC);
  // Any other error: the call is not available (older kernel, or a system-call filter).
  if (done >= 0 || errno == EAGAIN || errno == ETIMEDOUT || errno == EINTR) return;
#endif
  const timespec nap{0, kWithoutWaitv_ns};
  ::syscall(SYS_futex, words[0], FUTEX_WAIT, seen[0], &nap, nullptr, 0);
}

}  // namespace

SampleWaker::SampleWaker(std::vector<const std::atomic<std::uint32_t>*> words, ThreadWatch& watch,
                         const std::string& name)
    : words_(std::move(words)),
      event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      thread_(watch, name,
              [this](const std::stop_token& stop, Progress& progress) { run(stop, progress); }) {}

SampleWaker::~SampleWaker() { thread_.stop(); }

void SampleWaker::clear() const noexcept {
  std::uint64_t count = 0;
  while (::read(event_.get(), &count, sizeof count) < 0 && errno == EINTR) {
  }
}

void SampleWaker::run(const std::stop_token& stop, Progress& progress) const {
  std::vector<std::uint32_t> seen(words_.size());
  const auto look = [&] {
    bool changed = false;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const std::uint32_t now = words_[i]->load(std::memory_order_acquire);
      changed |= std::exchange(seen[i], now) != now;
    }
    return changed;
  };
  look();
  while (!stop.stop_requested()) {
    waitForAny(words_, seen);
    if (look()) {
      const std::uint64_t one = 1;
      while (::write(event_.get(), &one, sizeof one) < 0 && errno == EINTR) {
      }
    }
    progress.step();
  }
}

}  // namespace merlin::serve
