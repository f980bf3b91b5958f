// FlightRing: a ring buffer with a device's raw bytes of the last minutes, for the analysis of
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

// The contents of a ring. They contain no pointers, so that in shared memory they can be read after
// the process has ended.
struct FlightMemory {
  // A few consecutive bytes in one direction.
  struct Cell {
    std::int64_t ns;
    std::uint8_t to_device;
    std::uint8_t length;
    std::uint8_t bytes[46];
  };
  // A sequence of cells, of which cell i is in cells[i % kSize]; bytes may still be appended to the
  // last one.
  template <std::size_t kSize>
  struct Track {
    std::atomic<std::uint64_t> count{0};
    std::array<shm::SeqSlot<Cell>, kSize> cells;
  };
  static constexpr std::size_t kBeginning = 1024;
  static constexpr std::size_t kNewest = 32768;

  // Number of the cell of `newest` with which the current connection begins.
  std::atomic<std::uint64_t> opened_cell{0};
  Track<kBeginning> beginning;
  Track<kNewest> newest;
};

// Returns the contents as the chunks of a transcript: the bytes from the beginning of the current
// connection, then its newest bytes. If bytes between these two parts were overwritten, the second
// part follows the first one without a pause. The writer may write meanwhile, or may have been
// killed at any point. `left_out`: receives the length of time of the bytes that are missing; zero
// if none are missing.
std::vector<io::TranscriptChunk> chunksOf(const FlightMemory& memory, Duration* left_out);

// The device's thread writes, wait-free, without locks and allocations; any other thread may read.
// The ring stores the newest bytes (about four and a half minutes of a tracker with 120 records a
// second) and also the beginning of the current connection, so that a dump begins with the set-up
// dialogue and can be replayed as a test.
class FlightRing final : public ByteTap {
 public:
  FlightRing() : own_(std::make_unique<FlightMemory>()), memory_(*own_) {}
  // `memory`: contains nothing yet; must outlive this object.
  explicit FlightRing(FlightMemory& memory) : memory_(memory) {}

  void opened(Timestamp at) noexcept override;
  void heard(Timestamp at, std::span<const std::byte> bytes) noexcept override;
  void said(Timestamp at, std::span<const std::byte> bytes) noexcept override;

  // Returns the contents of the ring: see chunksOf().
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
