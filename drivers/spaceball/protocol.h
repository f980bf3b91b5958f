// Spaceball 1003/2003/3003/4000 FLX wire format, binary mode: converts bytes to packets and back.
// No I/O, no clock.
//
// A packet is a letter, its data, and CR. The device escapes 0x0D, 0x11, 0x13 and '^' inside it as
// ^M ^Q ^S ^^, so a CR always ends a packet; a bare XON or XOFF is flow control, not data.
//   'D' period:u16be [1/16 ms]  X Y Z A B C: 6 x i16be [raw counts]       displacement, 15 bytes
//   'K' b1 b2                                                             keys, all models
//   '.' b1 b2                                                             keys, 4000 FLX
//   other letters: replies to commands and the banner, returned as text
//
// Sources: README.md beside this file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace merlin::spaceball {

struct Displacement {
  std::array<std::int16_t, 6> axes{};  // X Y Z [force] A B C [torque], raw counts, device frame
  std::uint16_t period = 0;            // [1/16 ms] since the device's last displacement packet
};

struct Keys {
  bool flx = false;  // a '.' packet
  std::uint8_t b1 = 0x40, b2 = 0x40;
};

struct Text {
  std::string_view line;  // with the letter, without CR; valid until the next feed()
};

using Packet = std::variant<Displacement, Keys, Text>;

class Parser {
 public:
  // Takes one byte; returns a packet when `byte` completes one. Never blocks, never allocates.
  // A malformed packet is dropped whole and counted; the next CR resynchronises.
  std::optional<Packet> feed(std::byte byte) noexcept;

  // Return the numbers of packets (wrong length, unknown escape or letter) and of bytes that were
  // dropped since construction.
  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }

  // Returns whether a packet has begun and is not complete yet.
  bool inside() const noexcept { return length_ > 0; }

 private:
  std::optional<Packet> finish() noexcept;
  std::optional<Packet> read() const noexcept;

  static constexpr std::size_t kLongest = 96;  // the banner has 62
  std::array<std::uint8_t, kLongest> payload_{};
  std::size_t length_ = 0;
  bool escaped_ = false;
  bool bad_ = false;  // invalid escape sequence since the last CR
  std::uint64_t bad_packets_ = 0;
  std::uint64_t bad_bytes_ = 0;
};

enum class Model { k2003, k3003, k4000, k1003 };

// Returns the model with this firmware version; the 2003 if the version is unknown (as in
// spacenavd).
Model modelOf(std::string_view firmware_version) noexcept;
const char* nameOf(Model model) noexcept;

// Returns the meaning of the first error in an 'E' packet of a 4000. Source: FLX.
const char* meaningOf(std::string_view error_packet) noexcept;

// Returns the pressed buttons; bit i is button i + 1. 1003 and 2003: eight buttons, and the pick
// button as the ninth. 3003: left, right, rezero. 4000: twelve buttons.
std::uint32_t buttonsOf(const Keys& keys, Model model) noexcept;

// Return the bytes that a device of that model sends; inverse of the parser, for the emulator.
std::string encode(const Displacement& displacement);
std::string encodeKeys(std::uint32_t buttons, Model model);

}  // namespace merlin::spaceball
