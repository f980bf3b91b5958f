#include "drivers/loop/device_loop.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "drivers/port/health_reasons.h"

namespace merlin {
namespace {

constexpr Duration kReportInterval = std::chrono::milliseconds(100);
constexpr Duration kRateWindow = std::chrono::seconds(1);

template <std::size_t N>
void setText(char (&field)[N], std::string_view text) noexcept {
  const std::size_t n = std::min(text.size(), N - 1);
  std::memcpy(field, text.data(), n);
  std::memset(field + n, 0, N - n);
}

}  // namespace

DeviceLoop::DeviceLoop(DeviceLoopSettings settings, StreamOpener open_stream,
                       std::unique_ptr<Device> device, HealthSink& health, Clock& clock)
    : settings_(std::move(settings)),
      open_stream_(std::move(open_stream)),
      device_(std::move(device)),
      sink_(health),
      clock_(clock) {
  setText(health_.port, settings_.port);
  if (settings_.max_bytes_s > 0) pace_.emplace(settings_.max_bytes_s, [this] { paceChanged(); });
}

void DeviceLoop::run(const std::stop_token& stop, const std::function<void()>& alive) {
  enter(HealthState::kAbsent, kNotOpenedYet);
  Duration retry = settings_.first_retry;
  while (!stop.stop_requested()) {
    alive();
    opened_ = streamed_ = false;
    const Error end = serve(stop);
    if (stop.stop_requested()) break;
    if (streamed_) {
      ++health_.reconnects;
      retry = settings_.first_retry;
    }
    enter(opened_ && end.code != Errc::kClosed ? HealthState::kFailed : HealthState::kAbsent,
          withPace(end.what + hintFor(end)));
    if (!clock_.sleepUntil(clock_.now() + retry, stop)) break;
    retry = std::min(2 * retry, settings_.longest_retry);
  }
  enter(HealthState::kAbsent, kStopped);
}

std::unique_ptr<ByteStream> DeviceLoop::paced(std::unique_ptr<ByteStream> stream) {
  if (!pace_) return stream;
  return std::make_unique<PacedStream>(std::move(stream), *pace_, clock_);
}

// The PacedStream calls this during a read, in the set-up dialogue or while the device streams.
void DeviceLoop::paceChanged() {
  settings_.on_pace(pace_->above());
  if (health_.state == HealthState::kOpening) enter(health_.state, withPace({}));
}

std::string DeviceLoop::withPace(const std::string& reason) {
  if (!pace_) return reason;
  (void)pace_->allowed(clock_.now());  // updates above()
  if (!pace_->above()) return reason;
  return pace_->sentence() + (reason.empty() ? "" : "; " + reason);
}

// Malformed bytes usually mean that another device is connected, or that the baud rate is wrong.
std::string DeviceLoop::hintFor(const Error& end) const {
  const bool has_speed =
      settings_.port.starts_with("serial:") || settings_.port.starts_with("pty:");
  if (end.code != Errc::kMalformed || settings_.baud == 0 || !has_speed) return {};
  return " (is it another device, or is its speed not " + std::to_string(settings_.baud) +
         " baud?)";
}

Error DeviceLoop::serve(const std::stop_token& stop) {
  auto opened = open_stream_();
  if (!opened) return opened.error();
  const std::unique_ptr<ByteStream> stream = paced(*std::move(opened));
  opened_ = true;
  const std::stop_callback wake(stop, [&] { stream->interrupt(); });
  enter(HealthState::kOpening, withPace({}));
  const auto identity = device_->open(*stream);
  if (!identity) return identity.error();
  setText(health_.identity, *identity);
  rate_since_ = clock_.now();
  rate_samples_ = device_->counters().samples;
  enter(HealthState::kOk, "");
  return pollUntilLost(*stream, stop);
}

Error DeviceLoop::pollUntilLost(ByteStream& stream, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (const auto polled = device_->poll(stream); !polled) return polled.error();
    if (device_->counters().samples > health_.samples) streamed_ = true;
    report();
  }
  return {Errc::kClosed, std::string(kStopped)};
}

void DeviceLoop::enter(HealthState state, std::string_view reason) noexcept {
  const Timestamp now = clock_.now();
  if (state != health_.state || health_.since_ns == 0) health_.since_ns = toNanoseconds(now);
  health_.state = state;
  setText(health_.reason, reason);
  if (state != HealthState::kOk) health_.rate_hz = 0;
  reported_ = {};
  report();
}

void DeviceLoop::report() noexcept {
  const Timestamp now = clock_.now();
  if (now - reported_ < kReportInterval) return;
  reported_ = now;
  const DeviceCounters counters = device_->counters();
  health_.updated_ns = toNanoseconds(now);
  health_.samples = counters.samples;
  health_.bad_bytes = counters.bad_bytes;
  health_.bad_packets = counters.bad_packets;
  if (health_.state == HealthState::kOk) {
    const bool above = pace_ && pace_->above();
    setText(health_.reason, above ? pace_->sentence() : std::string_view(device_->complaint()));
    measureRate(now);
  }
  sink_.publish(health_);
}

void DeviceLoop::measureRate(Timestamp now) noexcept {
  const Duration window = now - rate_since_;
  if (window < kRateWindow) return;
  const auto samples = static_cast<double>(health_.samples - rate_samples_);
  health_.rate_hz = static_cast<float>(samples / toSeconds(window));
  rate_since_ = now;
  rate_samples_ = health_.samples;
}

}  // namespace merlin
