// EmulatedConnection: the connection to an emulated projector on a virtual clock.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "drivers/port/byte_stream.h"
#include "tests/support/emulated_projector.h"

namespace merlin::test {

// `VirtualClock` has now() and advance(). Thread-bound.
template <typename VirtualClock>
class EmulatedConnection final : public ByteStream {
 public:
  // `answer_time`: the delay of the greeting after the connection, and of an answer after its
  // command.
  EmulatedConnection(EmulatedProjector& device, VirtualClock& clock,
                     Duration answer_time = Duration::zero())
      : device_(device),
        clock_(clock),
        answer_time_(answer_time),
        input_(device.greet()),
        ready_(clock.now() + answer_time) {}

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    const Duration wait = input_.empty() ? timeout : std::min(timeout, ready_ - clock_.now());
    if (wait > Duration::zero()) clock_.advance(wait);
    if (input_.empty() || clock_.now() < ready_) return Error{Errc::kTimeout, "time-out"};
    const std::size_t n = std::min(buffer.size(), input_.size());
    std::transform(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(n), buffer.begin(),
                   [](char c) { return static_cast<std::byte>(c); });
    input_.erase(0, n);
    return n;
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration) override {
    std::string line;
    for (const std::byte b : bytes) line += static_cast<char>(b);
    line.pop_back();
    input_ += device_.answer(line, clock_.now());
    ready_ = clock_.now() + answer_time_;
    return bytes.size();
  }
  void interrupt() noexcept override {}

 private:
  EmulatedProjector& device_;
  VirtualClock& clock_;
  Duration answer_time_;
  std::string input_;
  Timestamp ready_;
};

}  // namespace merlin::test
