// Wire format between spacenavd, the daemon for space mice, and its clients: converts bytes to
// frames and back. Pure.
//
// A frame is 32 bytes: i32[8] in the machine's byte order. From spacenavd: 0 motion x y z rx ry rz
// ms; 1 press, 2 release: the button; 3 device: 0 added or 1 removed; 4 to 6 configuration, raw
// axis and raw button, which are not asked for. Version 1 begins with a word of four bytes,
// 0x7FAA5501, which spacenavd echoes; then a request is a frame whose first word is 0x7FAA0000 |
// number, and the answer begins with the same word. Version 0 has no requests.
//
// Source: FreeSpacenav, spacenavd/src/proto_unix.c, proto.h and libspnav/src/spnav.c.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace merlin::spacenav {

using Frame = std::array<std::int32_t, 8>;

enum Kind : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3, kRawButton = 6 };

inline constexpr std::uint32_t kHello = 0x7FAA5501;  // the word with which version 1 begins
inline constexpr std::int32_t kDeviceName = 0x7FAA2000;
inline constexpr std::int32_t kFailed = -1;  // last word of the answer to a request that failed

class Parser {
 public:
  // Takes one byte; returns a frame when `byte` completes one. Never blocks, never allocates. Bytes
  // that cannot begin a frame are dropped one by one and counted.
  std::optional<Frame> feed(std::byte byte) noexcept;

  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }
  bool inside() const noexcept { return length_ > 0; }  // in the middle of a frame
  void reset() noexcept;                                // for a new connection

 private:
  std::array<std::byte, sizeof(Frame)> bytes_{};
  std::size_t length_ = 0;
  bool lost_ = false;  // bytes were dropped since the last frame
  std::uint64_t bad_packets_ = 0, bad_bytes_ = 0;
};

// Return the bytes of a frame or of a word; inverse of the parser.
std::string encode(const Frame& frame);
std::string encodeWord(std::uint32_t word);

// One answer to kDeviceName: a piece of the name.
struct NamePiece {
  std::string text;      // at most 24 characters
  bool complete = true;  // no further piece follows
};
// Reads an answer to kDeviceName; returns nothing if the frame is not such an answer, or reports
// that there is no device.
std::optional<NamePiece> namePiece(const Frame& frame);

}  // namespace merlin::spacenav
