#include "nn/train.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/random.h"
#include "nn/phi.h"

namespace merlin::nn {
namespace {

std::array<double, kInputs> widen(const Input& x) noexcept {
  std::array<double, kInputs> wide;  // NOLINT: filled next
  std::copy(x.begin(), x.end(), wide.begin());
  return wide;
}

// Calls f(a_row, b_row) for every row of two sets of weights.
template <typename A, typename B, typename F>
void forRows(A& a, B& b, F f) {
  for (std::size_t j = 0; j < kHidden; ++j) f(a.hidden[j], b.hidden[j]);
  for (std::size_t k = 0; k < kOutputs; ++k) f(a.output[k], b.output[k]);
}

// Adds delta * (x, 1) to a row of the gradient.
template <std::size_t N>
void accumulate(std::array<double, N + 1>& row, double delta,
                const std::array<double, N>& x) noexcept {
  for (std::size_t i = 0; i < N; ++i) row[i] += delta * x[i];
  row[N] += delta;
}

// Adds one example's part of the gradient to `slope`; `scale` is 1 / (5 n).
void addExample(Phi phi, const TrainingWeights& weights, const Example& example, double scale,
                Slope& slope) noexcept {
  const auto x = widen(example.x);
  const Pass<double> pass = propagate(phi, weights, x);
  std::array<double, kHidden> back{};  // sum_k delta_k W_kj
  for (std::size_t k = 0; k < kOutputs; ++k) {
    const double error = pass.output[k] - static_cast<double>(example.code >> k & 1);
    slope.mse += scale * error * error;
    const double delta = 2 * scale * error * slopeOf(phi, pass.output_sum[k], pass.output[k]);
    for (std::size_t j = 0; j < kHidden; ++j) back[j] += delta * weights.output[k][j];
    accumulate(slope.gradient.output[k], delta, pass.hidden);
  }
  for (std::size_t j = 0; j < kHidden; ++j) {
    const double delta = back[j] * slopeOf(phi, pass.hidden_sum[j], pass.hidden[j]);
    accumulate(slope.gradient.hidden[j], delta, x);
  }
}

std::optional<Error> invalid(std::span<const Example> examples, const TrainSettings& s) {
  const auto error = [](std::string what) {
    return Error{Errc::kInvalidArgument, std::move(what)};
  };
  if (examples.empty()) return error("no examples to train on");
  for (const Example& e : examples) {
    if (e.code >= kCodes) return error(fmt::format("an example with code {}", e.code));
    if (!std::all_of(e.x.begin(), e.x.end(), [](float v) { return std::isfinite(v); })) {
      return error("an example with an input that is not finite");
    }
  }
  if (s.phi == Phi::kSignum)
    return error("phi signum has no slope and cannot be trained; allowed: sigmoid, atan");
  if (!(s.rate > 0) || !std::isfinite(s.rate))
    return error(fmt::format("rate {} is not > 0", s.rate));
  if (!(s.momentum >= 0 && s.momentum < 1)) {
    return error(fmt::format("momentum {} is not in [0, 1)", s.momentum));
  }
  if (s.max_iterations < 1) return error("max_iterations is 0, not >= 1");
  if (!(s.mse_limit >= 0)) return error(fmt::format("mse_limit {} is not >= 0", s.mse_limit));
  return std::nullopt;
}

// step = momentum * step - rate * gradient; weights += step.
void descend(TrainingWeights& weights, TrainingWeights& step, const TrainingWeights& gradient,
             const TrainSettings& s) {
  forRows(step, gradient, [&](auto& v, const auto& g) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = s.momentum * v[i] - s.rate * g[i];
  });
  forRows(weights, step, [](auto& w, const auto& v) {
    for (std::size_t i = 0; i < w.size(); ++i) w[i] += v[i];
  });
}

// Returns false if a weight is not a finite float.
bool narrow(const TrainingWeights& from, Weights& to) {
  bool finite = true;
  forRows(from, to, [&](const auto& f, auto& t) {
    for (std::size_t i = 0; i < f.size(); ++i) {
      t[i] = static_cast<float>(f[i]);
      finite &= std::isfinite(t[i]);
    }
  });
  return finite;
}

double accuracyOf(Phi phi, const Weights& weights, std::span<const Example> examples) {
  const auto right = std::count_if(examples.begin(), examples.end(), [&](const Example& e) {
    return threshold(forward(phi, weights, e.x)) == e.code;
  });
  return static_cast<double>(right) / static_cast<double>(examples.size());
}

}  // namespace

Slope backPropagate(Phi phi, const TrainingWeights& weights, std::span<const Example> examples) {
  assert(!examples.empty() && phi != Phi::kSignum);
  Slope slope;
  const double scale = 1.0 / static_cast<double>(kOutputs * examples.size());
  for (const Example& e : examples) addExample(phi, weights, e, scale, slope);
  return slope;
}

TrainingWeights initialWeights(std::uint64_t seed) noexcept {
  TrainingWeights weights;
  Random random(seed);
  forRows(weights, weights, [&](auto& row, auto&) {
    const double most = 1.0 / std::sqrt(static_cast<double>(row.size()));
    for (double& w : row) w = random.uniform(-most, most);
  });
  return weights;
}

Result<Training> train(const TrainingWeights& start, std::span<const Example> examples,
                       const TrainSettings& settings, const Progress& progress) {
  if (auto error = invalid(examples, settings)) return *std::move(error);
  TrainingWeights weights = start;
  TrainingWeights step;
  Training done;
  for (;;) {
    const Slope slope = backPropagate(settings.phi, weights, examples);
    done.report.mse = slope.mse;
    if (progress && !progress(done.report.iterations, slope.mse)) break;
    if (slope.mse < settings.mse_limit || done.report.iterations == settings.max_iterations) break;
    descend(weights, step, slope.gradient, settings);
    ++done.report.iterations;
  }
  if (!narrow(weights, done.weights)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("the weights diverged after {} iterations: use a rate below {} or "
                             "smaller initial weights",
                             done.report.iterations, settings.rate)};
  }
  done.report.accuracy = accuracyOf(settings.phi, done.weights, examples);
  return done;
}

}  // namespace merlin::nn
