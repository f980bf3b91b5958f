#include "drivers/osc/device.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace merlin::osc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPoseTime = seconds(2);
constexpr Duration kPollTime = milliseconds(250);
constexpr Duration kLongestSilence = seconds(3);

constexpr const char* kNoPose = "no pose has come for 2 s";
constexpr const char* kNoOsc = "datagrams come that are not OSC";

}  // namespace

Result<std::string> OscDevice::open(ByteStream& stream) {
  parser_.reset();
  poses_.forgetSilence();
  poses_.collectOthers(true);
  datagrams_ = 0;
  no_osc_ = false;
  complaint_ = "";
  const Timestamp until = clock_.now() + kPoseTime;
  for (const std::uint64_t before = poses_.samples(); poses_.samples() == before;) {
    const Duration left = until - clock_.now();
    if (left <= Duration::zero()) return noPose();
    if (const auto received = receive(stream, std::min(left, kPollTime)); !received)
      return received.error();
  }
  poses_.collectOthers(false);
  return fmt::format("OSC tracker, {}", poses_.expected());
}

Error OscDevice::noPose() const {
  if (datagrams_ == 0) return {Errc::kTimeout, "no OSC message comes to the port"};
  if (no_osc_) return {Errc::kMalformed, kNoOsc};
  if (poses_.others().empty()) return {Errc::kMalformed, poses_.silence()};
  return {Errc::kMalformed, fmt::format("messages come to {}{}; expected are poses at {}",
                                        fmt::join(poses_.others(), ", "),
                                        poses_.others().size() < Poses::kMostOthers ? "" : " ...",
                                        poses_.expected())};
}

Result<Ok> OscDevice::poll(ByteStream& stream) {
  if (auto received = receive(stream, kPollTime); !received) return received;
  const Timestamp now = clock_.now();
  if (const Duration silence = now - heard_; silence >= kLongestSilence)
    return Error{Errc::kTimeout,
                 fmt::format("nothing has come to the port for {:.1f} s", toSeconds(silence))};
  const char* const why = no_osc_ ? kNoOsc : *poses_.silence() ? poses_.silence() : kNoPose;
  complaint_ = now - posed_ < kPoseTime ? "" : why;
  return Ok{};
}

Result<Ok> OscDevice::receive(ByteStream& stream, Duration timeout) {
  std::array<std::byte, 2048> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, timeout);
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  if (!got) return Ok{};
  const Timestamp now = clock_.now();
  for (std::size_t i = 0; i < *got; ++i) {
    if (!parser_.inside()) datagram_start_ = now;
    if (const auto datagram = parser_.feed(buffer[i])) take(*datagram);
  }
  return Ok{};
}

void OscDevice::take(const Datagram& datagram) noexcept {
  ++datagrams_;
  heard_ = clock_.now();
  const std::uint64_t before = poses_.samples();
  poses_.begin(datagram_start_);
  no_osc_ = !osc_.read(datagram.bytes, poses_);
  if (no_osc_) ++bad_datagrams_;
  if (poses_.samples() > before) posed_ = heard_;
}

DeviceCounters OscDevice::counters() const noexcept {
  return {poses_.samples(), parser_.badBytes(),
          parser_.badPackets() + bad_datagrams_ + poses_.badPoses()};
}

std::unique_ptr<Device> makeDevice(const OscSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<OscDevice>(settings, clock, sink);
}

}  // namespace merlin::osc
