// Format of the bytes of a port evdev:PATH: the description of an input device of the kernel, then
// its events, as records of 24 bytes. drivers/io writes them, drivers/evdev and drivers/touch read
// them. Thus a gamepad can be recorded, replayed and watched by the flight recorder like every
// other device. Pure.
//
//   byte 0     0xE5
//   byte 1     EvdevRecord::Kind
//   bytes 2-3  code: the kernel's number of the axis or key (linux/input-event-codes.h)
//   bytes 4-23 kName, kKey: text, padded with NUL; otherwise value, low, high, resolution: i32
//
// All numbers are little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace merlin {

struct EvdevRecord {
  // The description consists of kName, kAxis, kRelative and kKey records in any order, the events
  // that set the present state, and kReady. The fingers of a multi-touch device follow the kernel's
  // protocol B: a kMoved record of ABS_MT_SLOT, then those of this slot's axes. Each report of the
  // device consists of kMoved, kShifted and kPressed records, and ends with kReport.
  enum Kind : std::uint8_t {
    kName = 1,      // text: the device's name
    kAxis = 2,      // code, value, low, high, resolution: an absolute axis, its value and its range
    kRelative = 3,  // code: a relative axis
    kKey = 4,       // code, text: a key or button, and the kernel's name of it without KEY_ or BTN_
    kReady = 5,
    kMoved = 6,    // code, value: new value of an absolute axis
    kShifted = 7,  // code, value: by how much a relative axis moved
    kPressed = 8,  // code, value: 1 pressed, 0 released, 2 repeated
    kReport = 9,
  };
  static constexpr std::size_t kText = 20;

  Kind kind = kReport;
  std::uint16_t code = 0;
  std::int32_t value = 0, low = 0, high = 0;
  std::int32_t resolution = 0;         // of a position axis [1/mm]; 0: unknown
  std::array<char, kText + 1> text{};  // NUL-ended
};

class EvdevParser {
 public:
  // Takes one byte; returns a record when `byte` completes one. Never blocks, never allocates.
  // Bytes that do not belong to a record are dropped one by one and counted.
  std::optional<EvdevRecord> feed(std::byte byte) noexcept;

  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }
  bool inside() const noexcept { return length_ > 0; }  // in the middle of a record
  void reset() noexcept;                                // for a new connection

 private:
  static constexpr std::size_t kSize = 24;
  std::array<std::uint8_t, kSize> bytes_{};
  std::size_t length_ = 0;
  bool lost_ = false;  // bytes were dropped since the last record
  std::uint64_t bad_packets_ = 0, bad_bytes_ = 0;
};

// Appends the record's bytes. A text that is too long is cut.
void append(const EvdevRecord& record, std::string& out);

}  // namespace merlin
