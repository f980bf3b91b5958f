// Cross-validation: trains on all folds but one and tests on that one, so that every hand is tested
// by a network that was not trained on it. Pure.
#pragma once

#include <cstddef>
#include <span>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/evaluate.h"
#include "nn/fit.h"

namespace merlin::nn {

struct Fold {
  DataSet train, test;
};

// Returns the hands of one fold. Each posture's hands, in the order given, are divided into `folds`
// equal parts: part `fold` is for test, the others are for training. Linear. REQUIRES: fold <
// folds.
Fold splitFold(std::span<const LabelledHand> hands, std::size_t folds, std::size_t fold);

// Result of one fold, or the mean over several folds.
struct FoldScore {
  std::size_t hands = 0;  // number of hands tested; in a mean over folds, their sum
  double accuracy = 0;    // share of these hands that the network recognises correctly, 0..1
  Neighbours neighbours;  // shares that two simple classifiers recognise correctly
};

// Trains on all folds but `fold`, and tests on `fold`. Errors: those of fit(). Cost: that of fit()
// and of neighbours(). REQUIRES: fold < folds.
Result<FoldScore> scoreFold(std::span<const LabelledHand> hands, std::size_t folds,
                            std::size_t fold, const FitSettings& settings,
                            const FitProgress& progress = {});

// Returns the means over the folds; every fold has the same weight. REQUIRES: at least one fold.
FoldScore meanOf(std::span<const FoldScore> folds);

}  // namespace merlin::nn
