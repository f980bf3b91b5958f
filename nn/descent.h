// Gradient descent with Adam on the mean squared error, in whitened coordinates (space.h), with
// small batches of hands to which noise is added. Pure, seeded.
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
  Input u{};
  std::uint32_t posture = 0;  // index
};

// The state of a descent. Adam: D. P. Kingma, J. Ba, 2015; weight decay apart from the gradient:
// I. Loshchilov, F. Hutter, 2019.
struct Descending {
  PackedWeights<float> weights, first, second;  // weights and the moments of their gradient
  float first_power = 1, second_power = 1;  // powers of Adam's decay rates, for its bias correction
};

// How far hands stray in a pass. Each hand's distance from the mean of its posture is multiplied by
// `shrink`, then noise of standard deviation `noise` is added to every component: the smoothed
// bootstrap, which keeps the spread about as it is. A hand that is nearer to another posture's mean
// even without noise strays by noise_beyond and shrink_beyond. Any other hand that noise brings
// nearer to another posture's mean is moved back towards its own.
struct Straying {
  float noise = 0, shrink = 1;
  float noise_beyond = 0, shrink_beyond = 1;
};

class Descent {
 public:
  // Borrows `samples` and `means`, the mean of each posture.
  Descent(Phi phi, std::span<const Sample> samples, std::span<const Input> means, Random random);

  // Makes one pass: over a part of the samples if there are very many, and several times over them
  // if there are few. Each hand strays as `straying` says. Returns the mean squared error of [GOU]
  // A.5.3 over these samples.
  double pass(Descending& at, std::span<const std::uint32_t> codes, float rate,
              const Straying& straying);

  // Returns the mean outputs of each posture's hands, without noise.
  std::vector<std::array<double, kOutputs>> meanOutputs(const PackedWeights<float>& weights) const;

 private:
  void step(Descending& at, const PackedWeights<float>& gradient, float rate);
  Input stray(std::size_t n, const Straying& straying);
  std::uint32_t nearest(const Input& u) const noexcept;  // the posture whose mean is nearest to u

  Phi phi_;
  std::span<const Sample> samples_;
  std::span<const Input> means_;
  Random random_;
  std::vector<float> noise_;  // normally distributed; each read starts at a random place
  std::vector<std::uint32_t> order_;
  std::vector<bool> own_side_;  // of each sample: whether its own posture's mean is the nearest
  std::array<std::array<float, kCodes>, kInputs> component_{};  // the means, for nearest()
  std::array<float, kCodes> half_square_{};
  std::size_t next_ = 0;
};

// Returns the mean squared error of [GOU] A.5.3 without noise; 0 if there are no samples.
double meanError(Phi phi, std::span<const Sample> samples, const PackedWeights<float>& weights,
                 std::span<const std::uint32_t> codes);

}  // namespace merlin::nn
