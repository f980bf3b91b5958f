// CyberGlove wire format: converts bytes to records and back; the ASCII dialogue is in text.h. No
// I/O, no clock.
//
// A record is a letter, one byte per sensor, optional fields that can be switched on, and NUL:
//   'G' or 'S'  v1 .. vN: u8 [raw, 1..255]  [time stamp: 5 bytes]  [status: u8, bit 7 set]
//   ['e' 's' or 'e' 'g', both may come]  00
// 'G' answers a single request, 'S' belongs to a stream. An error reply is 'e' code 00. No byte
// inside is 0, so a NUL always ends a packet. 'e' is also a legal value, so errors are recognised
// by their position.
//
// Sources: README.md beside this file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace merlin::cyberglove {

// Slots of the interface unit: the bits of its sensor masks. Values are sent in the order of slots.
inline constexpr std::size_t kSlots = 24;
inline constexpr std::uint32_t kMask18 = 0x7BBB3F;
inline constexpr std::uint32_t kMask22 = 0x7FFF7F;

struct SlotList {
  std::array<std::uint8_t, kSlots> slot{};  // slot[i] is where value i of a record belongs
  std::size_t count = 0;
};
// Returns the slots whose bits are set in `mask`, in ascending order.
SlotList slotsOf(std::uint32_t mask) noexcept;

// Encode and decode a sensor mask as in the command `M` and in the answer to `?K`: 3 bytes, lowest
// first. REQUIRES: `bytes` has 3 bytes.
std::string encodeMask(std::uint32_t mask);
std::uint32_t decodeMask(const char* bytes) noexcept;

// Contents of a record.
struct Layout {
  std::size_t values = 22;  // 1..24
  bool timestamp = false;   // switched on by `D`
  bool status = true;       // switched on by `U`
  bool text = false;        // records have the form of the ASCII dialogue
};

struct Record {
  enum Status : std::uint8_t { kPlugged = 1, kWristSwitch = 2, kLight = 4, kAlways = 0x80 };

  std::array<std::uint8_t, kSlots> values{};  // in wire order; 0 beyond the layout's count
  std::uint32_t timestamp = 0;                // [1/115200 s]; 0 if the layout has none
  std::uint8_t status = kAlways | kPlugged;   // this default if the layout has no status
  bool single = false;                        // whether the record answers a `G`
  bool too_fast = false;                      // "es": sampled faster than the glove can
  bool unplugged = false;                     // "eg": no glove on the interface unit
};

// An error reply.
struct Refusal {
  // '?' unknown command, 'n' invalid number, 'y' sync too fast, 'g' no glove, 's' record rate too
  // high.
  char code = '?';
};

using Packet = std::variant<Record, Refusal>;

class Parser {
 public:
  // Sets the layout and discards an incomplete packet; keeps the counters.
  // REQUIRES: 1 <= layout.values <= 24.
  void expect(const Layout& layout) noexcept;

  // Takes one byte; returns a packet when `byte` completes one. Never blocks, never allocates.
  // A packet that does not fit the layout is dropped whole and counted; the next NUL
  // resynchronises.
  std::optional<Packet> feed(std::byte byte) noexcept;

  // Return the numbers of packets and of bytes that were dropped since construction.
  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }

  // Returns whether a packet has begun and is not complete yet.
  bool inside() const noexcept { return length_ > 0; }

 private:
  std::optional<Packet> finish() noexcept;
  std::optional<Packet> read() const noexcept;

  static constexpr std::size_t kLongest = 1 + 4 * kSlots + 11 + 4 + 6 + 2;  // a text record
  Layout layout_;
  std::array<std::uint8_t, kLongest> bytes_{};  // the current packet, without its NUL
  std::size_t length_ = 0;
  std::uint64_t bad_packets_ = 0;
  std::uint64_t bad_bytes_ = 0;
};

// A time stamp on the wire: a flag byte, then the four bytes of the count, lowest first. A byte of
// 0 is sent as 1, and its bit in the flag byte is set.
using Stamp = std::array<std::uint8_t, 5>;
Stamp stuffTimestamp(std::uint32_t count) noexcept;
std::uint32_t unstuffTimestamp(const std::uint8_t* stamp) noexcept;

// Returns the bytes of a record; inverse of the parser, for the emulator. A value of 0 is sent as
// 1.
std::string encode(const Record& record, const Layout& layout);

// Returns the command `T`, which requests `rate_hz` records per second. REQUIRES: 1 <= rate_hz <=
// 115200.
std::string encodeRate(double rate_hz);

}  // namespace merlin::cyberglove
