// Channel: a stream of samples in shared memory: the newest sample, a ring of the last 256 samples,
// and a futex word on which readers wait.
#pragma once

#include <array>
#include <atomic>
#include <climits>
#include <cstdint>
#include <optional>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "daemon/shm/seq_slot.h"

namespace merlin::shm {

inline constexpr std::size_t kHistory = 256;

// One thread writes; any number of threads and processes read. Each channel has cache lines of its
// own, so that writes to one channel never slow down readers of another.
template <typename T>
class alignas(64) Channel {
 public:
  // Adds a sample. Wait-free except for one futex call, which wakes waiting readers. REQUIRES: only
  // one thread calls this.
  void publish(const T& sample) noexcept {
    const auto n = count_.load(std::memory_order_relaxed);
    ring_[n % kHistory].publish(sample);
    newest_.publish(sample);
    count_.store(n + 1, std::memory_order_release);
    wake_.fetch_add(1, std::memory_order_release);
    ::syscall(SYS_futex, &wake_, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
  }

  std::optional<T> newest() const noexcept { return newest_.read(); }

  // Returns the number of samples published since the segment was created.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }

  // Returns sample number n, counted from 0; nothing if it was not published yet or is no longer in
  // the ring. The oldest of the last kHistory samples is not returned, since the writer may be
  // overwriting it.
  std::optional<T> at(std::uint64_t n) const noexcept {
    if (n >= count() || n + kHistory <= count()) return std::nullopt;
    const auto sample = ring_[n % kHistory].read();
    return n + kHistory > count() ? sample : std::nullopt;  // overwritten meanwhile: nothing
  }

  // Returns the futex word, which is incremented with each sample, for a reader that waits for
  // several channels at once.
  const std::atomic<std::uint32_t>& wakeWord() const noexcept { return wake_; }

  // Offsets of the members from the channel's start [bytes], for the table of fields.
  static constexpr std::size_t countOffset() { return offsetof(Channel, count_); }
  static constexpr std::size_t wakeOffset() { return offsetof(Channel, wake_); }
  static constexpr std::size_t ringOffset() { return offsetof(Channel, ring_); }

  // Waits until count() differs from `seen` or `timeout` has passed. May also return earlier, so
  // the caller has to check count().
  void wait(std::uint64_t seen, timespec timeout) const noexcept {
    const auto word = wake_.load(std::memory_order_acquire);
    if (count() != seen) return;
    ::syscall(SYS_futex, &wake_, FUTEX_WAIT, word, &timeout, nullptr, 0);
  }

 private:
  SeqSlot<T> newest_;
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint32_t> wake_{0};  // incremented with each sample; for FUTEX_WAIT
  std::uint32_t reserved_ = 0;
  std::array<SeqSlot<T>, kHistory> ring_{};
};

}  // namespace merlin::shm
