// The sample device's wire format: a ball that sends lines of text. The device is fictitious; its
// driver is a small template for new drivers.
//
//   six numbers -1000..1000 (x y z a b c, thousandths of full scale) and a button mask, separated
//   by blanks, ended by LF: "0 0 500 0 0 -20 1\n"
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace merlin::sample {

struct Record {
  std::array<int, 6> axes{};  // thousandths of full scale
  std::uint32_t buttons = 0;
};

class Parser {
 public:
  // Takes one byte; returns a record when `byte` completes one. Never blocks, never allocates.
  // A malformed line is dropped whole and counted; the next LF resynchronises.
  std::optional<Record> feed(std::byte byte) noexcept;

  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }
  bool inside() const noexcept { return length_ > 0; }  // in the middle of a line

 private:
  std::optional<Record> read() const noexcept;

  std::array<char, 64> line_{};
  std::size_t length_ = 0;
  std::uint64_t bad_packets_ = 0, bad_bytes_ = 0;
};

// Returns the line of a record; inverse of the parser.
std::string encode(const Record& record);

}  // namespace merlin::sample
