// Folds of a cross-validation.
#pragma once

#include <cstddef>
#include <span>

#include "nn/data_set.h"

namespace merlin::nn {

struct Fold {
  DataSet train, test;
};

// Fold `fold` of `folds`: the test hands are the fold-th of equal parts of each posture's hands, in
// the order given, and the training hands are all others. Linear. REQUIRES: fold < folds.
Fold splitFold(std::span<const LabelledHand> hands, std::size_t folds, std::size_t fold);

}  // namespace merlin::nn
