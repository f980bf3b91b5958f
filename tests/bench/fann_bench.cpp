// ./dev bench posture: recall of MERLIN's network compared with FANN with the same weights. For
// both, a pass in double precision is the reference.
//
// The program is built twice, once with FANN's floats and once with FANN's doubles, since the two
// FANN libraries use the same names.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#ifdef MERLIN_FANN_DOUBLE
#include <doublefann.h>
#else
#include <floatfann.h>
#endif
#include <fmt/format.h>

#include "nn/fit.h"
#include "nn/recall.h"
#include "nn/train.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/nanoseconds.h"
#include "tests/nn/shipped.h"

namespace merlin::bench {
namespace {

constexpr bool kDouble = sizeof(fann_type) == sizeof(double);

struct FannDeleter {
  void operator()(fann* net) const { fann_destroy(net); }
};
using FannNetwork = std::unique_ptr<fann, FannDeleter>;

// Returns the same network in FANN, whose sigmoid is 1 / (1 + e^(-2 s t)); hence s = 1/2.
FannNetwork toFann(const nn::Weights& weights) {
  constexpr unsigned kHidden0 = nn::kInputs + 1, kOutput0 = kHidden0 + nn::kHidden + 1;
  FannNetwork net(fann_create_standard(3, nn::kInputs, nn::kHidden, nn::kOutputs));
  fann_set_activation_function_hidden(net.get(), FANN_SIGMOID);
  fann_set_activation_function_output(net.get(), FANN_SIGMOID);
  fann_set_activation_steepness_hidden(net.get(), fann_type(0.5));
  fann_set_activation_steepness_output(net.get(), fann_type(0.5));
  std::vector<fann_connection> all(fann_get_total_connections(net.get()));
  fann_get_connection_array(net.get(), all.data());
  for (fann_connection& c : all) {
    const float w = c.to_neuron >= kOutput0
                        ? weights.output[c.to_neuron - kOutput0][c.from_neuron - kHidden0]
                        : weights.hidden[c.to_neuron - kHidden0][c.from_neuron];
    c.weight = fann_type(w);
  }
  fann_set_weight_array(net.get(), all.data(), static_cast<unsigned>(all.size()));
  return net;
}

nn::TrainingWeights widen(const nn::Weights& weights) {
  nn::TrainingWeights w;
  for (std::size_t j = 0; j < nn::kHidden; ++j)
    std::copy(weights.hidden[j].begin(), weights.hidden[j].end(), w.hidden[j].begin());
  for (std::size_t k = 0; k < nn::kOutputs; ++k)
    std::copy(weights.output[k].begin(), weights.output[k].end(), w.output[k].begin());
  return w;
}

using FannInput = std::array<fann_type, nn::kInputs>;

struct Differences {
  // `ours` and `theirs`: differences from the pass in double precision
  double between = 0, ours = 0, theirs = 0;
};

Differences differencesOf(const nn::PostureNetwork& network, const std::vector<nn::Input>& inputs) {
  const FannNetwork net = toFann(network.weights);
  const nn::Recall recall(network.phi, network.weights);
  const nn::TrainingWeights weights = widen(network.weights);
  Differences most;
  for (const nn::Input& in : inputs) {
    std::array<double, nn::kInputs> x{};
    FannInput fann_x{};
    std::copy(in.begin(), in.end(), x.begin());
    std::copy(in.begin(), in.end(), fann_x.begin());
    const auto exact = nn::propagate(network.phi, weights, x).output;
    const nn::Output our = recall(in);
    const fann_type* their = fann_run(net.get(), fann_x.data());
    for (std::size_t k = 0; k < nn::kOutputs; ++k) {
      const auto o = static_cast<double>(our[k]), t = static_cast<double>(their[k]);
      most.between = std::max(most.between, std::abs(o - t));
      most.ours = std::max(most.ours, std::abs(o - exact[k]));
      most.theirs = std::max(most.theirs, std::abs(t - exact[k]));
    }
  }
  return most;
}

void times(const nn::PostureNetwork& network, const std::vector<nn::Input>& inputs,
           Report& report) {
  const FannNetwork net = toFann(network.weights);
  const nn::Recall recall(network.phi, network.weights);
  std::vector<FannInput> fann_inputs(inputs.size());
  for (std::size_t n = 0; n < inputs.size(); ++n)
    std::copy(inputs[n].begin(), inputs[n].end(), fann_inputs[n].begin());
  volatile double sink = 0;
  const Measured theirs = nanoseconds([&](std::size_t n) {
    sink = static_cast<double>(*fann_run(net.get(), fann_inputs[n % 1024].data()));
  });
  const Measured ours =
      nanoseconds([&](std::size_t n) { sink = static_cast<double>(recall(inputs[n % 1024])[0]); });
  const Measured portably = nanoseconds(
      [&](std::size_t n) { sink = static_cast<double>(recall.portably(inputs[n % 1024])[0]); });
  report.text(
      "  MERLIN {:.0f} ns, FANN {:.0f} ns: {:.1f} times faster; {:.0f} ns, {:.1f} times, without "
      "AVX2\n",
      ours.value(), theirs.value(), theirs / ours, portably.value(), theirs / portably);
  report.figure("recall", ours, "ns");
  report.figure("recall.without_avx2", portably, "ns");
  report.figure("recall.fann", theirs, "ns");
}

bool run(Report& report) {
  const auto fitted = nn::fit(nn::test::people(hand::allShapes(), 1, 10, 5, 1), {});
  if (!fitted) didNotRun("the training", fitted.error().what, "see nn/README.md");
  std::vector<nn::Input> inputs;
  for (const nn::LabelledHand& h : nn::test::people(hand::allShapes(), 5001, 10, 5, 3))
    inputs.push_back(nn::normalise(fitted->network.ranges, h.value));
  report.text("\nforward pass beside FANN in {}, same weights, 31 postures, {} hands\n",
              kDouble ? "double" : "float", inputs.size());
  times(fitted->network, inputs, report);
  const Differences d = differencesOf(fitted->network, inputs);
  report.text(
      "  outputs differ by at most {:.1e}; from a pass in double MERLIN's by {:.1e}, FANN's by "
      "{:.1e}\n",
      d.between, d.ours, d.theirs);
  const auto most = [&](double d) { return Measured::of(d, inputs.size(), "hands"); };
  report.figure("difference_from_fann", most(d.between), "1");
  report.figure("error", most(d.ours), "1");
  report.figure("error.fann", most(d.theirs), "1");
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app("Recall compared with FANN with the same weights.");
  return app.run(
      merlin::bench::kDouble ? "posture beside FANN in double" : "posture beside FANN in float",
      argc, argv, merlin::bench::run);
}
