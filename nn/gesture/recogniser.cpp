#include "nn/gesture/recogniser.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace merlin::nn {
namespace {

float norm(const StrokeFeatures& v) noexcept {
  float square = 0;
  for (const float x : v) square += x * x;
  return std::sqrt(square);
}

// Returns the logarithm of the volume of the ellipsoid of one deviation, up to a constant. W is
// triangular, so this is the sum of -log over W's diagonal.
float logVolume(const Triangle& whitening) {
  double sum = 0;
  std::size_t at = 0;
  for (std::size_t row = 0; row < kFeatures; ++row) {
    at += row;
    sum -= std::log(static_cast<double>(whitening[at++]));
  }
  return static_cast<float>(sum);
}

}  // namespace

bool isGestureName(std::string_view name) noexcept {
  const auto known = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !name.empty() && name.size() <= kLongestGestureName && name != kNoGesture &&
         std::all_of(name.begin(), name.end(), known);
}

StrokeFeatures whitened(const StrokeDistribution& distribution,
                        const StrokeFeatures& features) noexcept {
  StrokeFeatures away{}, white{};
  for (std::size_t i = 0; i < kFeatures; ++i) away[i] = features[i] - distribution.mean[i];
  std::size_t at = 0;
  for (std::size_t row = 0; row < kFeatures; ++row) {
    for (std::size_t i = 0; i <= row; ++i) white[row] += distribution.whitening[at++] * away[i];
  }
  return white;
}

GestureRecogniser::GestureRecogniser(const GestureModel& model) {
  assert(!model.gestures.empty());
  for (const TrainedGesture& gesture : model.gestures) {
    names_.push_back(gesture.name);
    gestures_.push_back({gesture.strokes, logVolume(gesture.strokes.whitening)});
    limits_.push_back({gesture.limit, gesture.least_odds, gesture.discriminant.has_value(),
                       gesture.discriminant.value_or(Discriminant{})});
  }
}

StrokeRecognition GestureRecogniser::operator()(const StrokeFeatures& features) const noexcept {
  StrokeRecognition best;
  StrokeFeatures nearest{};
  float least = 0;
  for (std::size_t k = 0; k < gestures_.size(); ++k) {
    const StrokeFeatures white = whitened(gestures_[k].of, features);
    const float distance = norm(white);
    const float unlikely = distance * distance / 2 + gestures_[k].log_volume;
    if (k > 0 && !(unlikely < least)) continue;
    least = unlikely;
    nearest = white;
    best.nearest = k;
    best.distance = distance;
  }
  const Limits& limits = limits_[best.nearest];
  best.odds = limits.has_discriminant ? oddsOf(limits.discriminant, nearest)
                                      : std::numeric_limits<float>::infinity();
  best.accepted = best.distance <= limits.distance && best.odds >= limits.odds;
  best.certainty = best.accepted ? 1 - best.distance / limits.distance : 0;
  return best;
}

}  // namespace merlin::nn
