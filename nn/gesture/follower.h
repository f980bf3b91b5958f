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
  std::size_t index;                // of the model's gestures
  std::string_view name;            // valid as long as the follower
  float certainty;                  // 0..1; 1: the stroke equals the mean of the training's
  std::int64_t began_ns, ended_ns;  // times of the poses with which the stroke began and ended
};

struct FollowerSettings {
  // A stroke that leads back after a gesture counts as the return of the hand, and not as a
  // gesture, if it begins within this time.
  double back_s = 0.8;
  StrokeSettings stroke;
};

// Thread-bound. Allocation-free after construction, no lock; a pose costs about 0.1 us, and the one
// that ends a stroke some us more, at most for 640 points.
class GestureFollower {
 public:
  // REQUIRES: the model has at least one gesture.
  explicit GestureFollower(const GestureModel& model, const FollowerSettings& settings = {})
      : settings_(settings), recognise_(model), strokes_(settings.stroke) {}

  // Takes the next pose; returns the gesture that ended with it, if one did: when the hand has
  // become slower than StrokeSettings::cut_share of the stroke's greatest speed.
  std::optional<Gesture> update(const HandPose& pose) noexcept;

  std::string_view name(std::size_t index) const noexcept { return recognise_.name(index); }

 private:
  bool leadsBack(const StrokeFeatures& stroke, std::int64_t began_ns) const noexcept;

  FollowerSettings settings_;
  GestureRecogniser recognise_;
  StrokeFinder strokes_;
  UsualPace pace_;
  bool any_ = false;
  StrokeFeatures last_{};  // of the last gesture
  std::int64_t last_ended_ns_ = 0;
};

}  // namespace merlin::nn
