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

// Written by the device's thread, wait-free, without locks or allocations; read by any other
// thread. Keeps the newest bytes, about four and a half minutes of a tracker's 120 records a
// second, and also the beginning of the current connection, so that a dump begins with the set-up
// dialogue and can be replayed as a test.
class FlightRing final : public ByteTap {
 public:
  FlightRing();

  void opened(Timestamp at) noexcept override;
  void heard(Timestamp at, std::span<const std::byte> bytes) noexcept override;
  void said(Timestamp at, std::span<const std::byte> bytes) noexcept override;

  // The contents as the chunks of a transcript: the beginning of the connection, then the newest
  // bytes of the same connection; without a gap if no bytes between them were overwritten.
  // `left_out`: set to the length of the gap, whose bytes are no longer stored.
  std::vector<io::TranscriptChunk> take(Duration* left_out) const;

 private:
  // Consecutive bytes in one direction.
  struct Cell {
    std::int64_t ns;
    std::uint8_t to_device;
    std::uint8_t length;
    std::uint8_t bytes[46];
  };
  static constexpr std::size_t kBeginning = 1024;  // cells
  static constexpr std::size_t kNewest = 32768;

  // A sequence of cells; the last one may still grow.
  struct Track {
    std::vector<shm::SeqSlot<Cell>> cells;
    std::atomic<std::uint64_t> count{0};
    Cell last{};

    void add(std::int64_t ns, bool to_device, std::span<const std::byte> bytes,
             bool wraps) noexcept;
  };
  void add(Timestamp at, bool to_device, std::span<const std::byte> bytes) noexcept;

  Track beginning_, newest_;
  std::atomic<std::uint64_t> opened_cell_{0};  // cell of newest_ where the connection begins
};

}  // namespace merlin::devices
