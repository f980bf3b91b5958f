// GestureRecogniser: decides which gesture a stroke is, if any. Pure.
//
// Each gesture is modelled as a normal distribution of the features of its strokes. A stroke is
// recognised as the gesture under whose distribution it is most likely. It is rejected if it is too
// far from this gesture's mean, or if the gesture's discriminant finds it too similar to ordinary
// motion.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "nn/gesture/discriminant.h"
#include "nn/gesture/features.h"

namespace merlin::nn {

inline constexpr std::size_t kMostGestures = 32;
inline constexpr std::size_t kLongestGestureName = 31;
// Label of strokes that were not meant as a gesture; no gesture may have this name.
inline constexpr std::string_view kNoGesture = "none";

// Whether `name` is valid: 1 to 31 letters, digits, - or _, and not kNoGesture.
bool isGestureName(std::string_view name) noexcept;

// A lower triangular matrix, stored row by row.
using Triangle = std::array<float, kFeatures*(kFeatures + 1) / 2>;

struct StrokeDistribution {
  StrokeFeatures mean{};
  // W, the inverse of the Cholesky factor of the features' covariance: |W (f - mean)| is the
  // distance of a stroke from the mean, in deviations. Its diagonal is above 0.
  Triangle whitening{};
};

struct TrainedGesture {
  std::string name;
  StrokeDistribution strokes;
  float limit = 0;  // greatest distance from the mean at which a stroke is accepted, > 0
  // Distinguishes the gesture from similar ordinary motion; absent if the training had too few
  // strokes of such motion. A stroke is accepted only if its log-odds are at least `least_odds`.
  std::optional<Discriminant> discriminant;
  float least_odds = 0;
};

// Returns the stroke's whitened features W (f - mean), in deviations from the distribution's mean.
StrokeFeatures whitened(const StrokeDistribution& distribution,
                        const StrokeFeatures& features) noexcept;

struct GestureModel {
  std::vector<TrainedGesture> gestures;  // at most kMostGestures, names differ
};

struct StrokeRecognition {
  std::size_t nearest = 0;  // index of the gesture under which the stroke is most likely
  float distance = 0;       // from this gesture's mean, in deviations
  float odds = 0;           // log-odds of the gesture's discriminant; infinite without one
  bool accepted = false;    // whether distance and odds are within the gesture's limits
  float certainty = 0;      // 1 at the mean; 0 at the limit of the distance and if not accepted
};

// Immutable, hence thread-safe.
class GestureRecogniser {
 public:
  // REQUIRES: the model has at least one gesture.
  explicit GestureRecogniser(const GestureModel& model);

  // Recognises a stroke by its features. Allocation-free; takes about 0.1 us for each gesture.
  StrokeRecognition operator()(const StrokeFeatures& features) const noexcept;

  // Returns the name of a gesture, valid as long as the recogniser exists. REQUIRES: index <
  // size().
  std::string_view name(std::size_t index) const noexcept { return names_[index]; }
  std::size_t size() const noexcept { return names_.size(); }

 private:
  struct Limits {
    float distance = 0, odds = 0;
    bool has_discriminant = false;
    Discriminant discriminant{};
  };
  struct Distribution {
    StrokeDistribution of;
    float log_volume = 0;
  };

  std::vector<std::string> names_;
  std::vector<Distribution> gestures_;
  std::vector<Limits> limits_;
};

}  // namespace merlin::nn
