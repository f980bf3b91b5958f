#include "daemon/devices/posture_sink.h"

#include <algorithm>

namespace merlin::devices {
namespace {

template <std::size_t N>
void setName(char (&field)[N], std::string_view name) noexcept {
  std::copy_n(name.begin(), std::min(name.size(), N - 1), field);
}

}  // namespace

void PostureSink::publish(const GloveSample& sample) noexcept {
  nn::Angles values;
  if (unit_ == nn::InputUnit::kRaw) {
    std::copy_n(std::begin(sample.raw), values.size(), values.begin());
  } else {
    std::copy(std::begin(sample.angle_rad), std::end(sample.angle_rad), values.begin());
  }
  const nn::Recognition seen = recognise_(values);
  if (seen.code != code_) {
    code_ = seen.code;
    since_ns_ = sample.received_ns;
  }
  PostureSample shown{};
  shown.received_ns = sample.received_ns;
  shown.since_ns = since_ns_;
  shown.counter = sample.counter;
  shown.code = seen.code;
  std::copy(seen.activation.begin(), seen.activation.end(), shown.activation);
  setName(shown.name, seen.name);
  outputs_.shown.publish(shown);

  const nn::Held& held = hold_.update(seen, sample.received_ns);
  PostureState state{};
  state.received_ns = sample.received_ns;
  state.since_ns = held.since_ns;
  state.counter = sample.counter;
  state.code = held.code;
  state.margin = seen.margin;
  state.entered = held.entered;
  if (held.any) setName(state.name, recognise_.name(held.code));
  setName(state.seen, seen.name);
  outputs_.held.publish(state);
  next_.publish(sample);
}

}  // namespace merlin::devices
