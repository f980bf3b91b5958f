// FlightRing: a ring buffer of the last minutes of a device's raw bytes, for the analysis of
// faults.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "daemon/shm/seq_slot.h"
#include "drivers/io/transcript.h"
#include "drivers/port/byte_tap.h"

namespace merlin::devices {

// The contents of a ring, without pointers: in shared memory they outlive the process.
struct FlightMemory {
  // Consecutive bytes in one direction.
  struct Cell {
    std::int64_t ns;
    std::uint8_t to_device;
    std::uint8_t length;
    std::uint8_t bytes[46];
  };
  // A sequence of cells; the last one may still grow.
  template <std::size_t kSize>
  struct Track {
    std::atomic<std::uint64_t> count{0};
    std::array<shm::SeqSlot<Cell>, kSize> cells;
  };
  static constexpr std::size_t kBeginning = 1024;
  static constexpr std::size_t kNewest = 32768;

  std::atomic<std::uint64_t> opened_cell{0};  // cell of `newest` where the connection begins
  Track<kBeginning> beginning;
  Track<kNewest> newest;
};

// The contents as the chunks of a transcript: the beginning of the connection, then the newest
// bytes of the same connection; there is no gap if no bytes between them were overwritten. The
// writer may write meanwhile, or may have been killed at any point. `left_out`: set to the length
// of the gap, whose bytes are no longer stored.
std::vector<io::TranscriptChunk> chunksOf(const FlightMemory& memory, Duration* left_out);

// Written by the device's thread, wait-free, without locks or allocations; read by any other
// thread. Keeps the newest bytes, about four and a half minutes of a tracker's 120 records a
// second, and also the beginning of the current connection, so that a dump begins with the set-up
// dialogue and can be replayed as a test.
class FlightRing final : public ByteTap {
 public:
  FlightRing() : own_(std::make_unique<FlightMemory>()), memory_(*own_) {}
  // `memory`: newly made; must outlive this object.
  explicit FlightRing(FlightMemory& memory) : memory_(memory) {}

  void opened(Timestamp at) noexcept override;
  void heard(Timestamp at, std::span<const std::byte> bytes) noexcept override;
  void said(Timestamp at, std::span<const std::byte> bytes) noexcept override;

  // chunksOf() the ring's memory.
  std::vector<io::TranscriptChunk> take(Duration* left_out) const {
    return chunksOf(memory_, left_out);
  }
  const FlightMemory& memory() const noexcept { return memory_; }

 private:
  void add(Timestamp at, bool to_device, std::span<const std::byte> bytes) noexcept;

  const std::unique_ptr<FlightMemory> own_;
  FlightMemory& memory_;
  FlightMemory::Cell last_of_beginning_{}, last_of_newest_{};
};

}  // namespace merlin::devices
