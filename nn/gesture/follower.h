// GestureFollower: recognises gestures from poses of the hand while they are made. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "nn/gesture/recogniser.h"
#include "nn/gesture/stroke.h"

namespace merlin::nn {

struct Gesture {
  std::size_t index;                // index into GestureModel::gestures
  std::string_view name;            // valid as long as the follower exists
  float certainty;                  // 0..1; 1 if the stroke equals the gesture's mean
  std::int64_t began_ns, ended_ns;  // times of the poses with which the stroke began and ended
};

struct FollowerSettings {
  // A stroke in the opposite direction of the last gesture counts as the return of the hand, and
  // not as a gesture, if it begins within this time after the end of that gesture.
  double back_s = 0.8;
  StrokeSettings stroke;
};

// Thread-bound. After construction it allocates nothing; it takes no lock. A pose costs about 0.1
// us; a pose that ends a stroke, which has at most 640 points, costs some us more.
class GestureFollower {
 public:
  // REQUIRES: the model has at least one gesture.
  explicit GestureFollower(const GestureModel& model, const FollowerSettings& settings = {})
      : settings_(settings), recognise_(model), strokes_(settings.stroke) {}

  // Takes the next pose. Returns the gesture whose stroke ended with this pose, nothing otherwise.
  // A stroke ends when the hand becomes slower than StrokeSettings::cut_share times the stroke's
  // greatest speed, or reverses its direction.
  std::optional<Gesture> update(const HandPose& pose) noexcept;

  std::string_view name(std::size_t index) const noexcept { return recognise_.name(index); }

 private:
  bool leadsBack(const StrokeFeatures& stroke, std::int64_t began_ns) const noexcept;

  FollowerSettings settings_;
  GestureRecogniser recognise_;
  StrokeFinder strokes_;
  UsualPace pace_;
  bool any_ = false;
  StrokeFeatures last_{};  // features of the last gesture's stroke
  std::int64_t last_ended_ns_ = 0;
};

}  // namespace merlin::nn
