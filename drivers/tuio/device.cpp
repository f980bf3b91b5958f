#include "drivers/tuio/device.h"

#include <algorithm>
#include <array>

namespace merlin::tuio {
namespace {

constexpr const char* kNoneYet = "no TUIO frame has come yet";
constexpr const char* kSilentNow = "silent: no TUIO frame for 2 s, so nothing touches";
constexpr const char* kNoOsc = "datagrams come that are not OSC";
constexpr const char* kNoFrame =
    "OSC messages come, but no complete frame of /tuio/2Dcur or /tuio/2Dobj";

}  // namespace

TuioDevice::TuioDevice(const TuioSettings& settings, const Clock& clock, SampleSink& sink)
    : clock_(clock), frames_(sink, settings.orientation) {
  frames_.setAspect(static_cast<float>(settings.aspect));
}

Result<std::string> TuioDevice::open(ByteStream&) {
  parser_.reset();
  sources_.clear();
  frames_.lift(clock_.now());
  heard_ = false;
  fault_ = "";
  complaint_ = kNoneYet;
  return std::string("TUIO 1.1 touch surface");
}

Result<Ok> TuioDevice::poll(ByteStream& stream) {
  std::array<std::byte, 2048> buffer;  // NOLINT(*-member-init): filled by read
  const auto got = stream.read(buffer, frames_.wait(clock_.now()));
  const Timestamp now = clock_.now();
  if (!got && got.error().code != Errc::kTimeout) return got.error();
  for (std::size_t i = 0; got && i < *got; ++i) {
    if (!parser_.inside()) datagram_start_ = now;
    if (const auto datagram = parser_.feed(buffer[i])) take(*datagram, datagram_start_);
  }
  if (sources_.forgetSilent(now)) publish(now);
  frames_.hold(now);
  if (now - faulted_ >= Sources::kSilent) fault_ = "";
  const char* const silence = heard_ ? kSilentNow : kNoneYet;
  complaint_ = *fault_ ? fault_ : sources_.number() > 0 ? "" : silence;
  return Ok{};
}

void TuioDevice::take(const Datagram& datagram, Timestamp first_byte) noexcept {
  sources_.begin(datagram.sender, first_byte);
  const bool good = osc_.read(datagram.bytes, sources_);
  if (!good) ++bad_datagrams_;
  if (good && sources_.complete()) {
    heard_ = true;
    fault_ = "";
    return publish(first_byte);
  }
  if (heard_ && good && !*sources_.fault()) return;  // only messages of other profiles
  fault_ = !good ? kNoOsc : *sources_.fault() ? sources_.fault() : kNoFrame;
  faulted_ = first_byte;
}

void TuioDevice::publish(Timestamp at) noexcept {
  frames_.begin();
  sources_.fill(frames_);
  frames_.publish(at);
}

DeviceCounters TuioDevice::counters() const noexcept {
  return {frames_.samples(), parser_.badBytes(),
          parser_.badPackets() + bad_datagrams_ + sources_.badMessages()};
}

std::unique_ptr<Device> makeDevice(const TuioSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<TuioDevice>(settings, clock, sink);
}

}  // namespace merlin::tuio
