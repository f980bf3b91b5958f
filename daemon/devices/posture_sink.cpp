#include "daemon/devices/posture_sink.h"

#include <algorithm>

namespace merlin::devices {

void PostureSink::publish(const GloveSample& sample) noexcept {
  nn::Angles angles;
  std::copy(std::begin(sample.angle_rad), std::end(sample.angle_rad), angles.begin());
  const nn::Recognition seen = nn::recognise(network_, angles);
  if (seen.code != code_) {
    code_ = seen.code;
    since_ns_ = sample.received_ns;
  }
  PostureSample posture{};
  posture.received_ns = sample.received_ns;
  posture.since_ns = since_ns_;
  posture.counter = sample.counter;
  posture.code = seen.code;
  std::copy(seen.activation.begin(), seen.activation.end(), posture.activation);
  std::copy_n(seen.name.begin(), std::min(seen.name.size(), sizeof posture.name - 1), posture.name);
  postures_.publish(posture);
  next_.publish(sample);
}

}  // namespace merlin::devices
