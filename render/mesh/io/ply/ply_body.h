// The body of a PLY file as a stream of numbers, whatever its form.
#pragma once

#include <cstdint>
#include <string_view>

#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::ply {

class Body {
 public:
  Body(std::string_view bytes, Form form)
      : at_(bytes.data()), end_(at_ + bytes.size()), form_(form) {}

  // The next number of the file; false at its end, or where an ascii word is no number
  // that a double has.
  bool next(Scalar type, double& value) noexcept {
    return form_ == Form::kAscii ? nextWord(value) : nextBinary(type, value);
  }

  // The next list of a binary file where it has three corners, a length in a byte and indices in
  // four: nearly every file is of those. Else false, and the list is read by next().
  bool nextTriangle(const Property& list, std::uint32_t* corners) noexcept;

  std::size_t left() const noexcept { return static_cast<std::size_t>(end_ - at_); }

  // The text at which next() stopped, for a message; empty at the end of the file.
  std::string_view rest() const noexcept;

 private:
  bool nextWord(double& value) noexcept;
  bool nextBinary(Scalar type, double& value) noexcept;

  const char* at_;
  const char* end_;
  Form form_;
};

}  // namespace merlin::render::ply
