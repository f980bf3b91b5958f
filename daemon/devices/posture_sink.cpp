#include "daemon/devices/posture_sink.h"

#include <algorithm>

#include "daemon/base/fixed_text.h"

namespace merlin::devices {
namespace {

// After this time without a sample, for example because the plug was pulled, another person may
// wear the glove, so tracking of the sensors' drift begins anew.
constexpr std::int64_t kSilence_ns = 1'000'000'000;

}  // namespace

void PostureSink::publish(const GloveSample& sample) noexcept {
  if (fresh_.take(recognition_)) endPosture(sample);
  if (recognition_) recognise(sample);
  next_.publish(sample);
}

// Publishes, after a reload, one sample without a posture, so that the actions held by the old
// posture end.
void PostureSink::endPosture(const GloveSample& sample) noexcept {
  entered_before_ = entered_;
  PostureSample shown{};
  PostureState state{};
  shown.received_ns = state.received_ns = sample.received_ns;
  shown.since_ns = state.since_ns = sample.received_ns;
  shown.counter = state.counter = sample.counter;
  state.entered = entered_;
  outputs_.shown.publish(shown);
  outputs_.held.publish(state);
}

void PostureSink::recognise(const GloveSample& sample) noexcept {
  Recognition& r = *recognition_;
  const bool plugged_in = sample.flags & ~r.flags & GloveSample::kPlugged;
  if (plugged_in || sample.received_ns - r.received_ns > kSilence_ns) r.recognise.reset();
  r.received_ns = sample.received_ns;
  r.flags = sample.flags;
  nn::Angles values;
  if (r.unit == nn::InputUnit::kRaw) {
    std::copy_n(std::begin(sample.raw), values.size(), values.begin());
  } else {
    std::copy(std::begin(sample.angle_rad), std::end(sample.angle_rad), values.begin());
  }
  const nn::Recognition seen = r.recognise(values);
  if (seen.code != r.code) {
    r.code = seen.code;
    r.since_ns = sample.received_ns;
  }
  PostureSample shown{};
  shown.received_ns = sample.received_ns;
  shown.since_ns = r.since_ns;
  shown.counter = sample.counter;
  shown.code = seen.code;
  std::copy(seen.activation.begin(), seen.activation.end(), shown.activation);
  setText(shown.name, seen.name);
  outputs_.shown.publish(shown);

  const nn::Held& held = r.hold.update(seen, sample.received_ns);
  entered_ = entered_before_ + held.entered;
  PostureState state{};
  state.received_ns = sample.received_ns;
  state.since_ns = held.since_ns;
  state.counter = sample.counter;
  state.code = held.code;
  state.margin = seen.margin;
  state.entered = entered_;
  if (held.any) setText(state.name, r.recognise.name(held.code));
  setText(state.seen, seen.name);
  outputs_.held.publish(state);
}

}  // namespace merlin::devices
