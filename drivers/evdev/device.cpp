#include "drivers/evdev/device.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::evdev {
namespace {

using std::chrono::milliseconds;

constexpr Duration kDescriptionTime = milliseconds(1000);
// A relative axis tells every 8 to 16 ms while it is pushed, and nothing when it is let go.
constexpr Duration kRelativeLasts = milliseconds(60);
constexpr std::size_t kBuffer = 16 * 24;  // of sixteen records

}  // namespace

Result<std::string> EvdevDevice::open(ByteStream& stream) {
  parser_.reset();
  ball_.restart();
  input_ = {};
  complaint_.clear();
  in_report_ = false;
  const Timestamp until = clock_.now() + kDescriptionTime;
  for (bool ready = false; !ready;) {
    std::byte byte{};  // one by one: what follows the description is for poll()
    const Duration left = until - clock_.now();
    if (left <= Duration::zero())
      return Error{Errc::kTimeout, "no complete description of an input device within 1 s"};
    const auto got = stream.read(std::span(&byte, 1), left);
    if (!got && got.error().code == Errc::kTimeout) continue;
    if (!got) return got.error();
    const auto record = parser_.feed(byte);
    if (!record) continue;
    input_.describe(*record);
    ready = record->kind == EvdevRecord::kReady;
  }
  if (input_.axes() == 0 && input_.keys() == 0)
    return Error{Errc::kMalformed, "the input device has neither axes nor keys"};
  complaint_ = input_.choose(settings_);
  input_.fill(ball_.sample());
  return fmt::format("{}, {} axes, {} keys", input_.name().empty() ? "input device" : input_.name(),
                     input_.axes(), input_.keys());
}

Result<Ok> EvdevDevice::poll(ByteStream& stream) {
  std::array<std::byte, kBuffer> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, ball_.wait());
  const Timestamp now = clock_.now();
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!in_report_) report_start_ = now;
    in_report_ = true;
    const auto record = parser_.feed(buffer[i]);
    if (!record) continue;
    input_.take(*record);
    if (record->kind == EvdevRecord::kReport) report(report_start_);
  }
  if (input_.relativeMoves() && now - reported_ >= kRelativeLasts) {
    input_.restRelative();
    report(now);
  }
  ball_.hold(now);
  return Ok{};
}

void EvdevDevice::report(Timestamp first_byte) noexcept {
  in_report_ = false;
  reported_ = first_byte;
  input_.fill(ball_.sample());
  ball_.publish(first_byte);
}

DeviceCounters EvdevDevice::counters() const noexcept {
  return {ball_.samples(), parser_.badBytes(), parser_.badPackets()};
}

std::unique_ptr<Device> makeDevice(const EvdevSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<EvdevDevice>(settings, clock, sink);
}

}  // namespace merlin::evdev
