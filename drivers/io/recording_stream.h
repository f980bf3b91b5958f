// RecordingStream: a ByteStream that also passes all bytes of another one to a ByteTap.
#pragma once

#include <memory>

#include "drivers/port/byte_stream.h"
#include "drivers/port/byte_tap.h"

namespace merlin::io {

// Thread-bound, except interrupt(), like the inner stream.
class RecordingStream final : public ByteStream {
 public:
  // `tap` and `clock` must outlive this object.
  RecordingStream(std::unique_ptr<ByteStream> inner, ByteTap& tap, const Clock& clock)
      : inner_(std::move(inner)), tap_(tap), clock_(clock) {
    tap_.opened(clock_.now());
  }

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    auto got = inner_->read(buffer, timeout);
    if (got) tap_.heard(clock_.now(), buffer.first(*got));
    return got;
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override {
    tap_.said(clock_.now(), bytes);
    return inner_->write(bytes, timeout);
  }
  void interrupt() noexcept override { inner_->interrupt(); }

 private:
  std::unique_ptr<ByteStream> inner_;
  ByteTap& tap_;
  const Clock& clock_;
};

}  // namespace merlin::io
