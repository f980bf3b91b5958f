#include "nn/network.h"

#include "nn/phi.h"

namespace merlin::nn {
namespace {

struct PhiName {
  Phi phi;
  const char* name;
};
constexpr PhiName kPhiNames[] = {
    {Phi::kSigmoid, "sigmoid"}, {Phi::kSignum, "signum"}, {Phi::kAtan, "atan"}};

// Computes one layer: its sums, then its values.
template <typename Real, std::size_t In, std::size_t Out>
void layer(Phi phi, const std::array<std::array<Real, In + 1>, Out>& weights,
           const std::array<Real, In>& x, std::array<Real, Out>& sums,
           std::array<Real, Out>& values) noexcept {
  for (std::size_t j = 0; j < Out; ++j) {
    Real sum = 0;
    for (std::size_t i = 0; i < In; ++i) sum += weights[j][i] * x[i];
    sums[j] = sum + weights[j][In];
  }
  activate<Real, Out>(phi, sums.data(), values.data());
}

}  // namespace

const char* nameOf(Phi phi) noexcept {
  for (const PhiName& p : kPhiNames) {
    if (p.phi == phi) return p.name;
  }
  return "";
}

std::optional<Phi> phiNamed(std::string_view name) noexcept {
  for (const PhiName& p : kPhiNames) {
    if (p.name == name) return p.phi;
  }
  return std::nullopt;
}

template <typename Real>
Pass<Real> propagate(Phi phi, const BasicWeights<Real>& weights,
                     const std::array<Real, kInputs>& x) noexcept {
  Pass<Real> pass;  // NOLINT: filled by layer
  layer(phi, weights.hidden, x, pass.hidden_sum, pass.hidden);
  layer(phi, weights.output, pass.hidden, pass.output_sum, pass.output);
  return pass;
}

template Pass<float> propagate(Phi, const BasicWeights<float>&,
                               const std::array<float, kInputs>&) noexcept;
template Pass<double> propagate(Phi, const BasicWeights<double>&,
                                const std::array<double, kInputs>&) noexcept;

Output forward(Phi phi, const Weights& weights, const Input& x) noexcept {
  return propagate(phi, weights, x).output;
}

std::uint32_t threshold(const Output& output) noexcept {
  std::uint32_t code = 0;
  for (std::size_t i = 0; i < kOutputs; ++i) {
    if (output[i] > 0.5F) code |= 1U << i;
  }
  return code;
}

}  // namespace merlin::nn
