// Divides hands into the folds of a cross-validation.
#pragma once

#include <cstddef>
#include <span>

#include "nn/data_set.h"

namespace merlin::nn {

struct Fold {
  DataSet train, test;
};

// Returns the hands of one fold. Each posture's hands, in the order given, are divided into `folds`
// equal parts: part `fold` is for test, the others are for training. Linear. REQUIRES: fold <
// folds.
Fold splitFold(std::span<const LabelledHand> hands, std::size_t folds, std::size_t fold);

}  // namespace merlin::nn
