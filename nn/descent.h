// Gradient descent with Adam on the mean squared error, in whitened coordinates (space.h), with
// small batches of hands to which noise is added. Pure; the random numbers are an argument.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/base/random.h"
#include "nn/packed_weights.h"
#include "nn/postures.h"

namespace merlin::nn {

struct Sample {
  // A hand in whitened coordinates.
  Input u{};
  std::uint32_t posture = 0;  // index of the hand's posture
};

// State of a gradient descent with Adam (D. P. Kingma, J. Ba, 2015) and decoupled weight decay (I.
// Loshchilov, F. Hutter, 2019).
struct Descending {
  PackedWeights<float> weights, first, second;  // weights; the gradient's two moments
  // Adam's two decay rates to the power of the number of steps, for its bias correction.
  float first_power = 1, second_power = 1;
};

// How hands are varied at random in a pass, in whitened coordinates. Each hand's distance from the
// mean of its posture is multiplied by `shrink`, then noise of standard deviation `noise` is added
// to every component. This is a smoothed bootstrap; with a suitable `shrink` the spread stays about
// the same. A hand that is nearer to another posture's mean even without noise is varied with
// noise_beyond and shrink_beyond instead. If noise brings any other hand nearer to another
// posture's mean, the hand is moved back towards the mean of its own posture.
struct Straying {
  float noise = 0, shrink = 1;
  float noise_beyond = 0, shrink_beyond = 1;
};

class Descent {
 public:
  // `means`: the mean of each posture's hands, in whitened coordinates. Samples and means are not
  // copied and must outlive this object.
  Descent(Phi phi, std::span<const Sample> samples, std::span<const Input> means, Random random);

  // Trains the weights of `at` in one pass of 640 to 2048 samples: of a larger set, each pass takes
  // the next part; a smaller set is repeated within the pass. `codes`: each posture's code; `rate`:
  // Adam's step size. The hands are varied as `straying` says. Returns the mean squared error of
  // [GOU] A.5.3 over the varied hands of this pass.
  double pass(Descending& at, std::span<const std::uint32_t> codes, float rate,
              const Straying& straying);

  // Returns the network's outputs, averaged over each posture's hands without noise.
  std::vector<std::array<double, kOutputs>> meanOutputs(const PackedWeights<float>& weights) const;

 private:
  void step(Descending& at, const PackedWeights<float>& gradient, float rate);
  Input stray(std::size_t n, const Straying& straying);
  std::uint32_t nearest(const Input& u) const noexcept;  // the posture whose mean is nearest to u

  Phi phi_;
  std::span<const Sample> samples_;
  std::span<const Input> means_;
  Random random_;
  // Nearly normal random numbers. A hand's noise is taken from a random place in them.
  std::vector<float> noise_;
  std::vector<std::uint32_t> order_;
  std::vector<bool> own_side_;  // for each sample: whether its own posture's mean is nearest
  std::array<std::array<float, kCodes>, kInputs> component_{};  // means_, transposed for nearest()
  std::array<float, kCodes> half_square_{};
  std::size_t next_ = 0;
};

// Returns the mean squared error of [GOU] A.5.3 over all samples, without noise; 0 if there are no
// samples. `codes`: each posture's code.
double meanError(Phi phi, std::span<const Sample> samples, const PackedWeights<float>& weights,
                 std::span<const std::uint32_t> codes);

}  // namespace merlin::nn
