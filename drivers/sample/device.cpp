#include "drivers/sample/device.h"

#include "drivers/port/dialogue.h"

namespace merlin::sample {
namespace {

constexpr Duration kPollTime = std::chrono::milliseconds(250);
constexpr Duration kSilence = std::chrono::seconds(1);

}  // namespace

Result<std::string> SampleDevice::open(ByteStream& stream) {
  Dialogue dialogue(stream, clock_);
  if (const auto sent = dialogue.send("HELLO\n"); !sent) return sent.error();
  auto name = dialogue.readUntil('\n', 40, kSilence, "HELLO");
  last_heard_ = clock_.now();
  return name;
}

Result<Ok> SampleDevice::poll(ByteStream& stream) {
  std::array<std::byte, 64> buffer;  // NOLINT: filled by read
  const auto got = stream.read(buffer, kPollTime);
  const Timestamp now = clock_.now();
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  if (!got)
    return now - last_heard_ < kSilence ? Result<Ok>(Ok{})
                                        : Error{Errc::kTimeout, "silent for 1 s"};
  last_heard_ = now;
  for (std::size_t i = 0; i < *got; ++i) {
    if (!parser_.inside()) line_start_ = now;
    if (const auto record = parser_.feed(buffer[i])) publish(*record, line_start_);
  }
  return Ok{};
}

void SampleDevice::publish(const Record& record, Timestamp first_byte) noexcept {
  sample_.received_ns = toNanoseconds(first_byte);
  ++sample_.counter;
  ++samples_;
  sample_.buttons = record.buttons;
  for (std::size_t i = 0; i < 6; ++i) {
    (i < 3 ? sample_.translation[i] : sample_.rotation[i - 3]) =
        static_cast<float>(record.axes[i]) / 1000;
    sample_.raw[i] = static_cast<std::int16_t>(record.axes[i]);
  }
  sink_.publish(sample_);
}

DeviceCounters SampleDevice::counters() const noexcept {
  return {samples_, parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const Clock& clock, SampleSink& sink) {
  return std::make_unique<SampleDevice>(clock, sink);
}

}  // namespace merlin::sample
