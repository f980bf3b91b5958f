// SeqSlot: passes the newest value of a type from one writer to any number of readers in any
// process (a seqlock).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace merlin::shm {

// publish() is wait-free, and read() never blocks the writer. A reader gets one complete published
// value or nothing, never a mix of two values. There is no queue: each value overwrites the one
// before it.
//
// The payload is an array of atomics rather than plain memory, so that a read that overlaps a write
// is no data race: it is detected and repeated, and ThreadSanitizer accepts it. Source: H.-J.
// Boehm, "Can Seqlocks Get Along With Programming Language Memory Models?", 2012.
//
// Memory layout: the sequence number (u64, odd while a value is being written, 0 before the first
// one), then T, padded to a multiple of 8 bytes.
template <typename T>
class SeqSlot {
  static_assert(std::is_trivially_copyable_v<T>, "T crosses a process border");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "a lock would not");

 public:
  // Replaces the value. REQUIRES: only one thread calls this.
  void publish(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), &value, sizeof value);
    // The sequence number is odd while a value is being written. It may already be odd here if the
    // memory was restored from a copy that was made during a write (SharedMemory::mend()).
    const auto odd = (sequence_.load(std::memory_order_relaxed) + 1) | 1;
    sequence_.store(odd, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i) {
      payload_[i].store(words[i], std::memory_order_release);
    }
    sequence_.store(odd + 1, std::memory_order_release);
  }

  // Returns the last published value; nothing before the first publish(), or if kTries attempts in
  // a row overlapped a write (for example because the writer died while writing).
  std::optional<T> read() const noexcept {
    for (int i = 0; i < kTries; ++i) {
      const auto before = sequence_.load(std::memory_order_acquire);
      if (before == 0) return std::nullopt;
      if (before & 1) continue;
      Words words;
      for (std::size_t w = 0; w < kWords; ++w) {
        words[w] = payload_[w].load(std::memory_order_acquire);
      }
      if (sequence_.load(std::memory_order_relaxed) != before) continue;
      T value;  // NOLINT(*-member-init): memcpy fills it
      std::memcpy(&value, words.data(), sizeof value);
      return value;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kTries = 64;
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;

  std::atomic<std::uint64_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> payload_{};
};

}  // namespace merlin::shm
