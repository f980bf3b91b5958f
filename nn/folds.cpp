#include "nn/folds.h"

#include <vector>

#include "nn/fit.h"

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

}  // namespace merlin::nn
