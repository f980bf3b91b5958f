#include "drivers/evdev/device.h"

#include <fmt/format.h>

namespace merlin::evdev {
namespace {

using std::chrono::milliseconds;

// A relative axis without an event for this long is at rest. While it is pushed, it sends an event
// every 8 to 16 ms; its release gives none, even while another axis moves, because the kernel does
// not report a motion of 0.
constexpr Duration kRelativeLasts = milliseconds(60);

}  // namespace

Result<std::string> EvdevDevice::open(ByteStream& stream) {
  ball_.restart();
  input_ = {};
  complaint_.clear();
  const auto described =
      reader_.open(stream, [&](const EvdevRecord& record) { input_.describe(record); });
  if (!described) return described.error();
  if (input_.axes() == 0 && input_.keys() == 0)
    return Error{Errc::kMalformed, "the input device has neither axes nor keys"};
  sink_.describe(reader_.keys());
  complaint_ = input_.choose(settings_);
  input_.fill(ball_.sample());
  ball_.settle(clock_.now());
  return fmt::format("{}, {} axes, {} keys", input_.name().empty() ? "input device" : input_.name(),
                     input_.axes(), input_.keys());
}

Result<Ok> EvdevDevice::poll(ByteStream& stream) {
  const auto polled = reader_.poll(
      stream, ball_.wait(clock_.now()),
      [&](const EvdevRecord& record) { input_.take(record, clock_.now()); },
      [&](Timestamp at) { report(at); });
  if (!polled) return polled.error();
  const Timestamp now = *polled;
  if (input_.restRelative(now - kRelativeLasts)) report(now);
  ball_.hold(now);
  return Ok{};
}

void EvdevDevice::report(Timestamp first_byte) noexcept {
  input_.fill(ball_.sample());
  ball_.publish(first_byte);
}

DeviceCounters EvdevDevice::counters() const noexcept {
  return {ball_.samples(), reader_.badBytes(), reader_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const EvdevSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<EvdevDevice>(settings, clock, sink);
}

}  // namespace merlin::evdev
