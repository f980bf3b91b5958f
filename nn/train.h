// Training by back-propagation. Pure; the seed is an argument, and one seed gives one network.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/network.h"

namespace merlin::nn {

using TrainingWeights = BasicWeights<double>;

// The mean squared error over all outputs of all examples, and its gradient by back-propagation:
//
//   E = 1/(5 n) sum_examples sum_k (Y_k - T_k)^2
//   delta_k = 2/(5 n) (Y_k - T_k) Phi'(I_k)          dE/dW_kj = sum_examples delta_k Y_j
//   delta_j = Phi'(I_j) sum_k delta_k W_kj           dE/dW_ji = sum_examples delta_j X_i
//
// T_k is bit k of the example's code. A bias is the weight of a constant input 1.
// REQUIRES: examples not empty, phi not signum.
struct Slope {
  double mse = 0.0;
  TrainingWeights gradient;
};
Slope backPropagate(Phi phi, const TrainingWeights& weights, std::span<const Example> examples);

// Draws every weight and bias uniformly from +-1/sqrt(weights of its row), so that sums are small
// and no node starts where Phi is flat.
TrainingWeights initialWeights(std::uint64_t seed) noexcept;

struct TrainSettings {
  Phi phi = Phi::kSigmoid;
  double rate = 2.0;                  // learning rate: factor of -dE/dW in a step, > 0
  double momentum = 0.9;              // share of the last step that is added to the next, [0, 1)
  std::size_t max_iterations = 2000;  // passes over the examples, >= 1
  double mse_limit = 5e-4;            // training stops if the error is below this limit, >= 0
};

struct TrainReport {
  std::size_t iterations = 0;
  double mse = 0.0;       // mean squared error of the returned weights
  double accuracy = 0.0;  // share of examples with all five bits right, 0..1
};

struct Training {
  Weights weights;
  TrainReport report;
};

// Called before each step with the number of steps done and the present mean squared error. If it
// returns false, the training stops.
using Progress = std::function<bool(std::size_t iteration, double mse)>;

// Gradient descent with momentum from `start` ([GOU] A.5.3). It stops when the error is below its
// limit, the iterations are used up, or `progress` returns false. None of these is an error; the
// report's numbers show which it was.
//
// errors     kInvalidArgument: no examples, an input that is not finite, a code above 31, settings
//            out of their ranges, signum (no slope), weights that diverged beyond a float.
// cost       about 1 us for each example and iteration; one thread; allocates nothing in the loop.
Result<Training> train(const TrainingWeights& start, std::span<const Example> examples,
                       const TrainSettings& settings, const Progress& progress = {});

}  // namespace merlin::nn
