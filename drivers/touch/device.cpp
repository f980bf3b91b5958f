#include "drivers/touch/device.h"

#include <array>

#include <fmt/format.h>

namespace merlin::touch {
namespace {

using std::chrono::milliseconds;

constexpr Duration kDescriptionTime = milliseconds(1000);
constexpr Duration kPollTime = milliseconds(250);
constexpr std::size_t kBuffer = 16 * 24;  // of sixteen records

std::string kindOf(const Surface& surface) {
  switch (surface.kind()) {
    case Surface::Kind::kSlots: return fmt::format("{} fingers", surface.slots());
    case Surface::Kind::kSingle: return "one finger";
    default: return "a mouse";
  }
}

}  // namespace

Result<std::string> TouchDevice::open(ByteStream& stream) {
  parser_.reset();
  frames_.lift(clock_.now());
  surface_ = {};
  in_report_ = false;
  if (const auto described = readDescription(stream); !described) return described.error();
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
  frames_.setAspect(surface_.aspect());
  publish(clock_.now());  // fingers that touch already
  return fmt::format("{}, {}", name, kindOf(surface_));
}

Result<Ok> TouchDevice::readDescription(ByteStream& stream) {
  const Timestamp until = clock_.now() + kDescriptionTime;
  for (;;) {
    std::byte byte{};  // one by one: what follows the description is for poll()
    const Duration left = until - clock_.now();
    if (left <= Duration::zero())
      return Error{Errc::kTimeout, "no complete description of an input device within 1 s"};
    const auto got = stream.read(std::span(&byte, 1), left);
    if (!got && got.error().code == Errc::kTimeout) continue;
    if (!got) return got.error();
    const auto record = parser_.feed(byte);
    if (!record) continue;
    surface_.describe(*record);
    if (record->kind == EvdevRecord::kReady) return Ok{};
  }
}

Result<Ok> TouchDevice::poll(ByteStream& stream) {
  std::array<std::byte, kBuffer> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, kPollTime);
  const Timestamp now = clock_.now();
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!in_report_) report_start_ = now;
    in_report_ = true;
    const auto record = parser_.feed(buffer[i]);
    if (!record) continue;
    surface_.take(*record);
    if (record->kind != EvdevRecord::kReport) continue;
    in_report_ = false;
    publish(report_start_);
  }
  return Ok{};
}

void TouchDevice::publish(Timestamp at) noexcept {
  frames_.begin();
  surface_.fill(frames_);
  frames_.publish(at);
}

DeviceCounters TouchDevice::counters() const noexcept {
  return {frames_.samples(), parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const TouchSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<TouchDevice>(settings, clock, sink);
}

}  // namespace merlin::touch
