#include "nn/gesture/follower.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kWays = 4;  // the first features are the displacement in x, y, z and roll
constexpr float kBack = -0.35F;   // dot product below which a stroke reverses the last one

}  // namespace

// Returns whether the stroke is the return movement after the last gesture.
bool GestureFollower::leadsBack(const StrokeFeatures& stroke,
                                std::int64_t began_ns) const noexcept {
  if (!any_ || static_cast<double>(began_ns - last_ended_ns_) > settings_.back_s * 1e9)
    return false;
  float along = 0;
  for (std::size_t i = 0; i < kWays; ++i) along += stroke[i] * last_[i];
  return along < kBack;
}

std::optional<Gesture> GestureFollower::update(const HandPose& pose) noexcept {
  const auto stroke = strokes_.update(pose);
  if (stroke.empty()) return std::nullopt;
  const auto features = featuresOf(stroke, strokes_.calmBefore_m_s(), pace_);
  if (!features) return std::nullopt;
  const StrokeRecognition seen = recognise_(*features);
  const std::int64_t began_ns = stroke.front().at_ns, ended_ns = stroke.back().at_ns;
  const bool back = leadsBack(*features, began_ns);
  if (!seen.accepted && !back)
    pace_.learn((*features)[kLogLength], (*features)[kLogSpeed], (*features)[kRoll]);
  if (!seen.accepted || back) return std::nullopt;
  any_ = true;
  last_ = *features;
  last_ended_ns_ = ended_ns;
  return Gesture{seen.nearest, recognise_.name(seen.nearest), seen.certainty, began_ns, ended_ns};
}

}  // namespace merlin::nn
