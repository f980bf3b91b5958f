#include "nn/gesture/training.h"

#include <algorithm>
#include <limits>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include "daemon/base/printable_text.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kLeastStrokes = 3, kFolds = 5;
constexpr float kLeastLimit = 1;
constexpr float kNoLimit = -1e5F;  // odds below all others
constexpr auto kFeatureCount = static_cast<Eigen::Index>(kFeatures);
using Vector = Eigen::Matrix<double, kFeatureCount, 1>;
using Matrix = Eigen::Matrix<double, kFeatureCount, kFeatureCount>;

Vector vectorOf(const StrokeFeatures& features) {
  return Eigen::Map<const Eigen::Matrix<float, kFeatureCount, 1>>(features.data()).cast<double>();
}

// `of`: strokes of each gesture, in the order of the names; `none`: strokes of ordinary motion.
struct Examples {
  std::map<std::string, std::vector<StrokeFeatures>> of;
  std::vector<StrokeFeatures> none;
};

struct Sums {
  Vector mean = Vector::Zero();
  Matrix scatter = Matrix::Zero();  // sum of the outer products of the deviations from the mean
  double count = 0;
};

// Neighbours in a recording come from the same person, so they are put into the same fold.
std::size_t foldOf(std::size_t n, std::size_t count) { return n * kFolds / count; }

// Returns the sums over all strokes except those of fold `fold`; over all strokes if `fold` is
// kFolds.
Sums sumsOf(const std::vector<StrokeFeatures>& strokes, std::size_t fold) {
  Sums sums;
  const auto each = [&](auto use) {
    for (std::size_t n = 0; n < strokes.size(); ++n) {
      if (foldOf(n, strokes.size()) != fold) use(vectorOf(strokes[n]));
    }
  };
  each([&](const Vector& f) {
    sums.mean += f;
    sums.count += 1;
  });
  sums.mean /= std::max(sums.count, 1.0);
  each([&](const Vector& f) { sums.scatter += (f - sums.mean) * (f - sums.mean).transpose(); });
  return sums;
}

StrokeDistribution distributionOf(const Sums& own, const Matrix& pooled,
                                  const GestureTrainingSettings& settings) {
  Matrix covariance = (own.scatter + settings.pooled_strokes * pooled) /
                      std::max(own.count - 1 + settings.pooled_strokes, 1.0);
  covariance.diagonal().array() += settings.ridge * settings.ridge;
  const Eigen::LLT<Matrix> factor(covariance);
  const Matrix inverse = factor.matrixL().solve(Matrix::Identity());
  StrokeDistribution distribution;
  std::size_t at = 0;
  for (Eigen::Index row = 0; row < kFeatureCount; ++row) {
    distribution.mean[static_cast<std::size_t>(row)] = static_cast<float>(own.mean[row]);
    for (Eigen::Index i = 0; i <= row; ++i)
      distribution.whitening[at++] = static_cast<float>(inverse(row, i));
  }
  return distribution;
}

// Fits the distributions of all gestures, without discriminants and limits, to all strokes except
// those of fold `fold`.
GestureModel distributions(const Examples& examples, std::size_t fold,
                           const GestureTrainingSettings& settings) {
  std::vector<Sums> sums;
  Matrix pooled = Matrix::Zero();
  double count = 0;
  for (const auto& [name, strokes] : examples.of) {
    sums.push_back(sumsOf(strokes, fold));
    pooled += sums.back().scatter;
    count += std::max(sums.back().count - 1, 0.0);
  }
  pooled /= std::max(count, 1.0);
  GestureModel model;
  std::size_t k = 0;
  for (const auto& [name, strokes] : examples.of) {
    TrainedGesture gesture;
    gesture.name = name;
    gesture.strokes = distributionOf(sums[k++], pooled, settings);
    gesture.limit = std::numeric_limits<float>::max();
    model.gestures.push_back(std::move(gesture));
  }
  return model;
}

void setLimits(GestureModel& model, const Examples& examples,
               const GestureTrainingSettings& settings) {
  std::vector<std::vector<float>> distances(model.gestures.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const GestureModel part = distributions(examples, fold, settings);
    const GestureRecogniser recognise(part);
    std::size_t k = 0;
    for (const auto& [name, strokes] : examples.of) {
      for (std::size_t n = 0; n < strokes.size(); ++n) {
        if (foldOf(n, strokes.size()) != fold) continue;
        const StrokeRecognition r = recognise(strokes[n]);
        if (r.nearest == k) distances[k].push_back(r.distance);
      }
      ++k;
    }
  }
  for (std::size_t k = 0; k < distances.size(); ++k) {
    auto& own = distances[k];
    std::sort(own.begin(), own.end());
    const auto last = static_cast<std::size_t>(settings.kept * static_cast<double>(own.size()));
    const float greatest = own.empty() ? 0 : own[std::min(last, own.size() - 1)];
    model.gestures[k].limit = std::max(static_cast<float>(settings.slack) * greatest, kLeastLimit);
  }
}

// Returns the discriminant's examples for each gesture: first its own strokes, then its lookalikes.
std::vector<std::vector<DiscriminantExample>> lookalikesOf(
    const GestureModel& model, const Examples& examples, const GestureTrainingSettings& settings) {
  std::vector<std::vector<DiscriminantExample>> sets(model.gestures.size());
  const GestureRecogniser recognise(model);
  std::size_t k = 0;
  for (const auto& [name, strokes] : examples.of) {
    for (const StrokeFeatures& f : strokes)
      sets[k].push_back({whitened(model.gestures[k].strokes, f), true});
    ++k;
  }
  for (const StrokeFeatures& stroke : examples.none) {
    const StrokeRecognition r = recognise(stroke);
    const TrainedGesture& gesture = model.gestures[r.nearest];
    const double reach = settings.lookalike_reach * static_cast<double>(gesture.limit);
    if (static_cast<double>(r.distance) <= reach)
      sets[r.nearest].push_back({whitened(gesture.strokes, stroke), false});
  }
  return sets;
}

// Returns the threshold of the odds with the least loss: 1 for each own stroke below it, and
// `worth` for each lookalike above it.
float leastOdds(std::vector<float> own, std::vector<float> others, double worth) {
  std::sort(own.begin(), own.end());
  std::sort(others.begin(), others.end());
  float best = kNoLimit;
  double least = worth * static_cast<double>(others.size());
  std::size_t below = 0;
  for (std::size_t n = 0; n < own.size(); ++n) {
    while (below < others.size() && others[below] < own[n]) ++below;
    const double lost = static_cast<double>(n) + worth * static_cast<double>(others.size() - below);
    if (lost >= least) continue;
    least = lost;
    // The threshold is in the middle between the worst accepted stroke and the best rejected
    // lookalike.
    best = below > 0 ? (own[n] + others[below - 1]) / 2 : own[n];
  }
  return best;
}

// Sets the discriminant, and its threshold by cross-validation: the odds of each example come from
// a discriminant that was fitted without it.
void setDiscriminant(TrainedGesture& gesture, std::span<const DiscriminantExample> examples,
                     const GestureTrainingSettings& settings) {
  const auto own = static_cast<std::size_t>(std::count_if(
      examples.begin(), examples.end(), [](const DiscriminantExample& e) { return e.meant; }));
  if (examples.size() - own < settings.least_lookalikes) return;
  const auto fold = [&](std::size_t n) {  // own strokes come first
    return n < own ? foldOf(n, own) : foldOf(n - own, examples.size() - own);
  };
  std::vector<float> meant, others;
  for (std::size_t f = 0; f < kFolds; ++f) {
    std::vector<DiscriminantExample> kept;
    for (std::size_t n = 0; n < examples.size(); ++n) {
      if (fold(n) != f) kept.push_back(examples[n]);
    }
    const Discriminant discriminant = fitDiscriminant(kept, settings.decay);
    for (std::size_t n = 0; n < examples.size(); ++n) {
      if (fold(n) == f)
        (examples[n].meant ? meant : others).push_back(oddsOf(discriminant, examples[n].whitened));
    }
  }
  gesture.discriminant = fitDiscriminant(examples, settings.decay);
  gesture.least_odds = leastOdds(std::move(meant), std::move(others), settings.worth);
}

Result<Examples> examplesOf(std::span<const LabelledStroke> strokes) {
  Examples examples;
  for (const LabelledStroke& stroke : strokes) {
    if (stroke.gesture == kNoGesture) {
      examples.none.push_back(stroke.features);
    } else if (!isGestureName(stroke.gesture)) {
      return Error{Errc::kInvalidArgument,
                   fmt::format("gesture \"{}\"; allowed: 1 to {} letters, digits, - or _",
                               excerpt(stroke.gesture), kLongestGestureName)};
    } else {
      examples.of[stroke.gesture].push_back(stroke.features);
    }
  }
  if (examples.of.empty())
    return Error{
        Errc::kInvalidArgument,
        "no gesture in it: in no take with a gesture's name did the hand move far and fast "
        "enough for a stroke; record it again with brisk movements"};
  if (examples.of.size() > kMostGestures)
    return Error{Errc::kInvalidArgument,
                 fmt::format("{} gestures; allowed: 1 to {}", examples.of.size(), kMostGestures)};
  for (const auto& [name, own] : examples.of) {
    if (own.size() < kLeastStrokes)
      return Error{Errc::kInvalidArgument,
                   fmt::format("{} strokes of \"{}\"; needed: {} or more, better 10 of each of "
                               "several people",
                               own.size(), name, kLeastStrokes)};
  }
  return examples;
}

}  // namespace

Result<GestureModel> trainGestures(std::span<const LabelledStroke> strokes,
                                   const GestureTrainingSettings& settings) {
  const auto examples = examplesOf(strokes);
  if (!examples) return examples.error();
  GestureModel model = distributions(*examples, kFolds, settings);
  setLimits(model, *examples, settings);
  const auto sets = lookalikesOf(model, *examples, settings);
  for (std::size_t k = 0; k < sets.size(); ++k)
    setDiscriminant(model.gestures[k], sets[k], settings);
  return model;
}

}  // namespace merlin::nn
