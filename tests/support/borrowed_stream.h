// BorrowedStream: forwards every call to a stream that the test owns, for code under test that
// takes ownership of its stream.
#pragma once

#include "drivers/port/byte_stream.h"

namespace merlin::test {

struct BorrowedStream final : ByteStream {
  explicit BorrowedStream(ByteStream& s) : stream(s) {}
  Result<std::size_t> read(std::span<std::byte> b, Duration t) override {
    return stream.read(b, t);
  }
  Result<std::size_t> write(std::span<const std::byte> b, Duration t) override {
    return stream.write(b, t);
  }
  void interrupt() noexcept override { stream.interrupt(); }
  ByteStream& stream;
};

}  // namespace merlin::test
