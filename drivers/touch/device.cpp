#include "drivers/touch/device.h"

#include <fmt/format.h>

namespace merlin::touch {
namespace {

std::string kindOf(const Surface& surface) {
  switch (surface.kind()) {
    case Surface::Kind::kSlots: return fmt::format("{} fingers", surface.slots());
    case Surface::Kind::kSingle: return "one finger";
    default: return "a mouse";
  }
}

}  // namespace

Result<std::string> TouchDevice::open(ByteStream& stream) {
  frames_.lift(clock_.now());
  surface_ = {};
  const auto described =
      reader_.open(stream, [&](const EvdevRecord& record) { surface_.describe(record); });
  if (!described) return described.error();
  const std::string name = surface_.name().empty() ? "input device" : surface_.name();
  if (surface_.choose(settings_) == Surface::Kind::kNone) {
    return Error{
        Errc::kMalformed,
        fmt::format("\"{}\" is {}", name,
                    surface_.hasOldProtocol()
                        ? "a multi-touch device of the kernel's protocol A, without slots, "
                          "which is not supported"
                        : "neither a touch surface nor a mouse; for a gamepad, joystick or "
                          "space mouse set \"driver\": \"evdev\"")};
  }
  sink_.describe(reader_.keys());
  frames_.setAspect(surface_.aspect());
  frames_.begin();
  surface_.fill(frames_);
  if (surface_.kind() == Surface::Kind::kMouse)
    frames_.publishAnyway(clock_.now());  // clients count the wheel from here on
  else
    frames_.publish(clock_.now());  // in case fingers touch already
  return fmt::format("{}, {}", name, kindOf(surface_));
}

Result<Ok> TouchDevice::poll(ByteStream& stream) {
  const auto polled = reader_.poll(
      stream, frames_.wait(clock_.now()), [&](const EvdevRecord& record) { surface_.take(record); },
      [&](Timestamp at) { publish(at); });
  if (!polled) return polled.error();
  frames_.hold(*polled);
  return Ok{};
}

void TouchDevice::publish(Timestamp at) noexcept {
  frames_.begin();
  surface_.fill(frames_);
  frames_.publish(at);
}

DeviceCounters TouchDevice::counters() const noexcept {
  return {frames_.samples(), reader_.badBytes(), reader_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const TouchSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<TouchDevice>(settings, clock, sink);
}

}  // namespace merlin::touch
