// Driver of the sample device, which answers "HELLO\n" with its name and then streams.
#pragma once

#include <memory>

#include "daemon/base/clock.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/sample/protocol.h"

namespace merlin::sample {

// open() takes at most 1 s. poll() fails with kTimeout after 1 s of silence.
class SampleDevice final : public Device {
 public:
  SampleDevice(const Clock& clock, SampleSink& sink) : clock_(clock), sink_(sink) {}

  Result<std::string> open(ByteStream& stream) override;
  Result<Ok> poll(ByteStream& stream) override;
  DeviceCounters counters() const noexcept override;
  const char* complaint() const noexcept override { return ""; }

 private:
  void publish(const Record& record, Timestamp first_byte) noexcept;

  const Clock& clock_;
  SampleSink& sink_;
  Parser parser_;
  BallSample sample_{};
  std::uint64_t samples_ = 0;
  Timestamp line_start_{}, last_heard_{};
};

std::unique_ptr<Device> makeDevice(const Clock& clock, SampleSink& sink);

}  // namespace merlin::sample
