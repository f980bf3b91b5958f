// Format of the bytes of a port udp: each datagram that arrives is preceded by its length and a
// number for its sender, so that datagrams can be recorded, replayed and watched by the flight
// recorder like the bytes of every other line. drivers/io writes them, drivers/tuio and drivers/osc
// read them. Pure.
//
//   byte 0     0xDA
//   byte 1     0x67 xor bytes 2 to 7, a checksum against damaged lengths
//   bytes 2-3  length of the datagram, 1 to 65507: u16, little-endian
//   bytes 4-7  sender: u32, little-endian; the same for all datagrams from one address and port
//   then the datagram
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace merlin {

inline constexpr std::size_t kDatagramHeader = 8;
// The largest payload of a UDP datagram over IPv4.
inline constexpr std::size_t kLongestDatagram = 65507;

struct Datagram {
  std::uint32_t sender = 0;
  std::span<const std::byte> bytes;  // owned by the parser; valid until its next feed()
};

class DatagramParser {
 public:
  DatagramParser();

  // Takes one byte; returns a datagram when `byte` completes one. Never blocks, never allocates.
  // Bytes that do not belong to a datagram are dropped one by one and counted.
  std::optional<Datagram> feed(std::byte byte) noexcept;

  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }
  bool inside() const noexcept { return header_length_ > 0; }  // in the middle of a datagram
  void reset() noexcept;                                       // for a new connection

 private:
  bool headerFits() const noexcept;
  void dropFirst() noexcept;

  std::array<std::uint8_t, kDatagramHeader> header_{};
  std::size_t header_length_ = 0, length_ = 0, wanted_ = 0;
  std::vector<std::byte> bytes_;
  bool lost_ = false;  // bytes were dropped since the last datagram
  std::uint64_t bad_packets_ = 0, bad_bytes_ = 0;
};

// Appends the datagram with its header. REQUIRES: 1 to kLongestDatagram bytes.
void append(const Datagram& datagram, std::string& out);

}  // namespace merlin
