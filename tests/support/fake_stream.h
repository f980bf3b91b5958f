// FakeStream: a ByteStream on a FakeClock. Its other end is an emulator, or bytes given by feed().
//
// read() advances the clock to the moment when the next byte arrives, or by the whole time-out. It
// starts no thread and does not block.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "drivers/emulate/emulator.h"
#include "drivers/port/byte_stream.h"
#include "tests/support/fake_clock.h"

namespace merlin::test {

class FakeStream final : public ByteStream {
 public:
  // `emulator` may be null: then read() returns only the bytes given to feed().
  FakeStream(FakeClock& clock, emulate::Emulator* emulator) : clock_(clock), emulator_(emulator) {}

  void feed(std::string_view bytes) { input_ += bytes; }
  // True if there are bytes that have not been read.
  bool pending() const { return !input_.empty(); }
  void close() { closed_ = true; }
  // From now on nothing is received, as if the cable were unplugged at the device.
  void mute() { emulator_ = nullptr; }
  void plug(emulate::Emulator* emulator) { emulator_ = emulator; }

  // All bytes that the driver has written.
  const std::string& written() const { return written_; }

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    if (closed_) return Error{Errc::kClosed, "closed"};
    const Timestamp deadline = clock_.now() + timeout;
    for (;;) {
      if (emulator_) emulator_->advance(clock_.now(), input_);
      if (!input_.empty()) break;
      const Timestamp due = emulator_ ? emulator_->nextDue() : deadline;
      if (due >= deadline) {
        clock_.advance(deadline - clock_.now());
        return Error{Errc::kTimeout, "time-out"};
      }
      clock_.advance(std::max<Duration>(due - clock_.now(), std::chrono::microseconds(1)));
    }
    const std::size_t n = std::min(buffer.size(), input_.size());
    std::memcpy(buffer.data(), input_.data(), n);
    input_.erase(0, n);
    return n;
  }

  Result<std::size_t> write(std::span<const std::byte> bytes, Duration) override {
    if (closed_) return Error{Errc::kClosed, "closed"};
    written_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (emulator_) emulator_->receive(bytes, clock_.now());
    return bytes.size();
  }

  void interrupt() noexcept override { closed_ = true; }

 private:
  FakeClock& clock_;
  emulate::Emulator* emulator_;
  std::string input_;
  std::string written_;
  bool closed_ = false;
};

}  // namespace merlin::test
