#include "nn/cross_validation.h"

#include <cassert>
#include <vector>

namespace merlin::nn {

Fold splitFold(std::span<const LabelledHand> hands, std::size_t folds, std::size_t fold) {
  std::vector<std::size_t> posture;
  const auto names = posturesOf(hands, posture);
  std::vector<std::size_t> all(names.size(), 0), seen(names.size(), 0);
  for (const std::size_t p : posture) ++all[p];
  Fold split;
  for (std::size_t n = 0; n < posture.size(); ++n) {
    const std::size_t of = seen[posture[n]]++ * folds / all[posture[n]];
    (of == fold ? split.test : split.train).push_back(hands[n]);
  }
  return split;
}

Result<FoldScore> scoreFold(std::span<const LabelledHand> hands, std::size_t folds,
                            std::size_t fold, const FitSettings& settings,
                            const FitProgress& progress) {
  const auto [train, test] = splitFold(hands, folds, fold);
  const auto fitted = fit(train, settings, progress);
  if (!fitted) return fitted.error();
  return FoldScore{test.size(), score(fitted->network, test).accuracy(), neighbours(train, test)};
}

FoldScore meanOf(std::span<const FoldScore> folds) {
  assert(!folds.empty());
  const double share = 1 / static_cast<double>(folds.size());
  FoldScore mean;
  for (const FoldScore& fold : folds) {
    mean.hands += fold.hands;
    mean.accuracy += share * fold.accuracy;
    mean.neighbours.mean += share * fold.neighbours.mean;
    mean.neighbours.nearest += share * fold.neighbours.nearest;
  }
  return mean;
}

}  // namespace merlin::nn
