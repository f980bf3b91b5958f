// Reads the body of a PLY file, ASCII or binary, as a stream of numbers.
#pragma once

#include <cstdint>
#include <string_view>

#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::mesh::ply {

class Body {
 public:
  Body(std::string_view bytes, Form form)
      : at_(bytes.data()), end_(at_ + bytes.size()), form_(form) {}

  // Reads the next number into `value`. Returns false at the end of the file, or if an ASCII word
  // is not a number in the range of double.
  bool next(Scalar type, double& value) noexcept {
    return form_ == Form::kAscii ? nextWord(value) : nextBinary(type, value);
  }

  // Fast path for nearly every file: if the file is little-endian binary and the next list is three
  // 4-byte vertex indices after a 1-byte length, reads it into `corners` (3 entries) and returns
  // true. Otherwise reads nothing and returns false; the caller then reads the list with next().
  bool nextTriangle(const Property& list, std::uint32_t* corners) noexcept;

  std::size_t left() const noexcept { return static_cast<std::size_t>(end_ - at_); }

  // Returns up to 16 bytes of the text at which next() stopped, for a message; empty at the end of
  // the file.
  std::string_view rest() const noexcept;

 private:
  bool nextWord(double& value) noexcept;
  bool nextBinary(Scalar type, double& value) noexcept;

  const char* at_;
  const char* end_;
  Form form_;
};

}  // namespace merlin::render::mesh::ply
