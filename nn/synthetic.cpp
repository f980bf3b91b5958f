#include "nn/synthetic.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "daemon/base/random.h"

namespace merlin::nn {
namespace {

// Index abduction (no glove measures it: a rule fills it), wrist pitch, wrist yaw.
constexpr std::size_t kFreeSlots[] = {7, 21, 22};

bool isFree(std::size_t slot) {
  return std::find(std::begin(kFreeSlots), std::end(kFreeSlots), slot) != std::end(kFreeSlots);
}

Angles makeHand(const HandShape& shape, const SyntheticSettings& s, Random& random) {
  Angles hand{};
  const double suppleness = 1 + s.stiffness_sigma * random.normal();
  for (std::size_t i = 0; i < kInputs; ++i) {
    const double low = s.ranges[i].low_rad, high = s.ranges[i].high_rad;
    const double count = (high - low) / s.counts;
    double angle = isFree(i) ? random.uniform(low, high)
                             : shape.angle_rad[i] * suppleness +
                                   s.joint_sigma * (high - low) * random.normal();
    angle += s.sensor_sigma * count * random.normal();
    hand[i] = static_cast<float>(low + std::round((angle - low) / count) * count);
  }
  return hand;
}

}  // namespace

DataSet makeHands(std::span<const HandShape> shapes, const SyntheticSettings& settings,
                  std::uint64_t seed) {
  assert(settings.counts >= 1);
  DataSet hands;
  hands.reserve(shapes.size() * settings.per_shape);
  Random random(seed);
  for (const HandShape& shape : shapes) {
    for (std::size_t n = 0; n < settings.per_shape; ++n) {
      hands.push_back({std::string(shape.name), makeHand(shape, settings, random)});
    }
  }
  return hands;
}

}  // namespace merlin::nn
