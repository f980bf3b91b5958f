// Discriminant: distinguishes strokes of a gesture from similar strokes of ordinary motion. It is a
// logistic regression on a stroke's whitened features and all their products, so that the decision
// boundary is a quadric. Pure, deterministic.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "nn/gesture/features.h"

namespace merlin::nn {

// Weights of the constant 1, of each whitened feature z_i, and of each product z_i z_j, j <= i, row
// by row.
inline constexpr std::size_t kTerms = 1 + kFeatures + kFeatures * (kFeatures + 1) / 2;
using Discriminant = std::array<float, kTerms>;

// Returns the log-odds that the stroke was meant as the gesture. `whitened`: the stroke's features,
// whitened by the gesture's distribution (recogniser.h). Allocation-free; about 0.05 us.
float oddsOf(const Discriminant& discriminant, const StrokeFeatures& whitened) noexcept;

// A stroke's whitened features, and whether the stroke was meant as the gesture.
struct DiscriminantExample {
  StrokeFeatures whitened{};
  bool meant = false;
};

// Returns the weights that maximise the log-likelihood minus `decay` / 2 times the sum of the
// squared weights, by Newton's method. Cost: up to 25 steps, each linear in the examples and cubic
// in kTerms.
Discriminant fitDiscriminant(std::span<const DiscriminantExample> examples, double decay);

}  // namespace merlin::nn
