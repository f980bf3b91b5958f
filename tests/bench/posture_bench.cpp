// ./dev bench posture: recall beside FANN with the same weights, training beside the simplest
// classifiers on people never seen, adapting to one more, and postures that flicker or do not.
//
// All hands are synthetic. Absolute times differ from machine to machine; ratios are of one run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "drivers/hand/recording.h"
#include "nn/adapt.h"
#include "nn/evaluate.h"
#include "nn/fit.h"
#include "nn/hold.h"
#include "nn/train.h"

#ifdef MERLIN_FANN
#include <floatfann.h>
#endif

namespace merlin::bench {
namespace {

using nn::DataSet;

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

DataSet people(std::size_t first, std::size_t count, std::size_t per_take, std::uint64_t seed,
               std::size_t takes = 1) {
  hand::RecordingSettings s;
  s.first_person = first;
  s.people = count;
  s.takes = takes;
  s.per_take = per_take;
  DataSet hands;
  for (const hand::Shot& shot : hand::record(hand::allShapes(), s, seed))
    hands.push_back({shot.shape, shot.angle_rad});
  return hands;
}

// Nanoseconds of one call of f(n), the least of several rounds.
template <typename F>
double nanoseconds(F f) {
  constexpr int kCalls = 200'000, kRounds = 7;
  const SystemClock clock;
  double least = 1e9;
  for (int r = 0; r < kRounds; ++r) {
    const Timestamp began = clock.now();
    for (int n = 0; n < kCalls; ++n) f(static_cast<std::size_t>(n));
    least = std::min(least, 1e9 * toSeconds(clock.now() - began) / kCalls);
  }
  return least;
}

#ifdef MERLIN_FANN
struct FannDeleter {
  void operator()(fann* net) const { fann_destroy(net); }
};
using FannNetwork = std::unique_ptr<fann, FannDeleter>;

// The same network in FANN: its sigmoid is 1 / (1 + e^(-2 s t)), so s = 1/2.
FannNetwork toFann(const nn::Weights& weights) {
  constexpr unsigned kHidden0 = nn::kInputs + 1, kOutput0 = kHidden0 + nn::kHidden + 1;
  FannNetwork net(fann_create_standard(3, nn::kInputs, nn::kHidden, nn::kOutputs));
  fann_set_activation_function_hidden(net.get(), FANN_SIGMOID);
  fann_set_activation_function_output(net.get(), FANN_SIGMOID);
  fann_set_activation_steepness_hidden(net.get(), 0.5F);
  fann_set_activation_steepness_output(net.get(), 0.5F);
  std::vector<fann_connection> all(fann_get_total_connections(net.get()));
  fann_get_connection_array(net.get(), all.data());
  for (fann_connection& c : all) {
    c.weight = c.to_neuron >= kOutput0
                   ? weights.output[c.to_neuron - kOutput0][c.from_neuron - kHidden0]
                   : weights.hidden[c.to_neuron - kHidden0][c.from_neuron];
  }
  fann_set_weight_array(net.get(), all.data(), static_cast<unsigned>(all.size()));
  return net;
}

void besideFann(const nn::PostureNetwork& network, const std::vector<nn::Input>& x) {
  const FannNetwork net = toFann(network.weights);
  const auto lanes = nn::toLanes(network.weights);
  double most = 0;
  nn::LanePass<float> pass;
  std::vector<nn::Input> inputs = x;
  for (nn::Input& in : inputs) {
    const float* out = fann_run(net.get(), in.data());
    nn::propagate(network.phi, lanes, in.data(), pass);
    for (std::size_t k = 0; k < nn::kOutputs; ++k)
      most = std::max(most,
                      std::abs(static_cast<double>(out[k]) - static_cast<double>(pass.output[k])));
  }
  volatile float sink = 0;
  const double theirs =
      nanoseconds([&](std::size_t n) { sink = *fann_run(net.get(), inputs[n % 1024].data()); });
  const double ours = nanoseconds([&](std::size_t n) {
    nn::propagate(network.phi, lanes, inputs[n % 1024].data(), pass);
    sink = pass.output[0];
  });
  fmt::print(
      "forward pass, same weights: MERLIN {:.0f} ns, FANN {:.0f} ns, {:.1f} times faster; "
      "outputs differ by at most {:.1e}\n",
      ours, theirs, theirs / ours, most);
}
#else
void besideFann(const nn::PostureNetwork&, const std::vector<nn::Input>&) {
  fmt::print("forward pass beside FANN: skipped, libfann-dev was not there when this was built\n");
}
#endif

void recall(const nn::PostureNetwork& network, const DataSet& hands) {
  const nn::Recogniser recognise(network);
  volatile std::uint32_t sink = 0;
  const double ns =
      nanoseconds([&](std::size_t n) { sink = recognise(hands[n % 1024].value).code; });
  fmt::print("recall, scaling and names and all: {:.0f} ns\n", ns);
  std::vector<nn::Input> x;
  for (const nn::LabelledHand& hand : hands) x.push_back(nn::normalise(network.ranges, hand.value));
  besideFann(network, x);
}

// The 1998 way, as plain as it can be: running numbers as codes, ranges of the glove, descent down
// the gradient of everything.
double plainAccuracy(const DataSet& train, const DataSet& test) {
  nn::PostureNetwork network;
  std::vector<std::size_t> posture;
  const auto names = nn::posturesOf(train, posture);
  for (std::size_t k = 0; k < names.size(); ++k)
    (void)network.postures.add(static_cast<std::uint32_t>(k), names[k]);
  const auto examples = nn::toExamples(train, network);
  const auto trained = nn::train(nn::initialWeights(1), *examples,
                                 {.rate = 5, .max_iterations = 1500, .mse_limit = 1e-4});
  if (!trained) return 0;
  network.weights = trained->weights;
  return nn::score(network, test).accuracy();
}

nn::Fitted trainingTable() {
  fmt::print(
      "\n31 postures x 50 hands of 10 people, tested on 10 others (synthetic)\n"
      "  seed  network %  nearest mean %  nearest neighbour %  rejected  training s (CPU)\n");
  nn::Fitted first;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DataSet train = people(1 + 100 * (seed - 1), 10, 5, seed), test = people(5001, 10, 5, 99);
    const double began = cpuSeconds();
    auto fitted = nn::fit(train, {});
    const double took = cpuSeconds() - began;
    const nn::Score s = nn::score(fitted->network, test);
    const nn::Neighbours n = nn::neighbours(train, test);
    fmt::print("  {:4}  {:9.2f}  {:14.2f}  {:19.2f}  {:8}  {:16.2f}\n", seed, 100 * s.accuracy(),
               100 * n.mean, 100 * n.nearest, s.rejected, took);
    if (seed == 1) {
      fmt::print("        {:.2f} % with running numbers as codes and plain descent\n",
                 100 * plainAccuracy(train, test));
      first = *std::move(fitted);
    }
  }
  return first;
}

void adapting(const nn::Fitted& fitted) {
  fmt::print(
      "\nadapting to one person more, 200 hands of each posture\n"
      "  person  theirs before %  after %  ten others before %  after %  s (CPU)\n");
  const DataSet others = people(5001, 10, 5, 7);
  for (const std::size_t person : {9001U, 9002U, 9003U}) {
    const DataSet own = people(person, 1, 200, 1), later = people(person, 1, 50, 2);
    const double began = cpuSeconds();
    const auto adapted = nn::adapt(fitted.network, fitted.memory, own, 1);
    const double took = cpuSeconds() - began;
    fmt::print("  {:6}  {:15.2f}  {:7.2f}  {:19.2f}  {:7.2f}  {:7.2f}\n", person,
               100 * nn::score(fitted.network, later).accuracy(),
               100 * nn::score(adapted->network, later).accuracy(),
               100 * nn::score(fitted.network, others).accuracy(),
               100 * nn::score(adapted->network, others).accuracy(), took);
  }
}

struct Flicker {
  std::size_t reported = 0, missed = 0, invented = 0, repeated = 0;
};

// The names in the order in which they were reported, beside those that were meant.
Flicker countOf(const std::vector<std::string>& reported, std::span<const hand::Shape> meant) {
  Flicker f;
  f.reported = reported.size();
  std::size_t next = 0;
  for (const std::string& name : reported) {
    if (next < meant.size() && name == meant[next].name) {
      ++next;
    } else if (next > 0 && name == meant[next - 1].name) {
      ++f.repeated;
    } else {
      ++f.invented;
    }
  }
  f.missed = meant.size() - next;
  return f;
}

void flicker(const nn::Fitted& fitted) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  const auto ten = hand::allShapes().subspan(0, 10);
  const nn::Recogniser recognise(fitted.network);
  fmt::print(
      "\nten postures, 1 s each, 0.35 s from one to the next, 100 records a second\n"
      "  person             reported  missed  repeated  invented\n");
  for (const std::size_t person : {9001U, 9002U, 9003U}) {
    const auto shots = hand::goThrough(ten, hand::Person(person), 100, 35, 1);
    std::vector<std::string> plain, held;
    nn::PostureHold hold({});
    std::string last;
    std::uint32_t entered = 0;
    for (std::size_t n = 0; n < shots.size(); ++n) {
      const nn::Recognition seen = recognise(shots[n].angle_rad);
      if (seen.name != last && !seen.name.empty()) plain.emplace_back(seen.name);
      last = seen.name;
      const nn::Held& h = hold.update(seen, static_cast<std::int64_t>(n) * kPeriod_ns);
      if (h.entered != entered) held.emplace_back(recognise.name(h.code));
      entered = h.entered;
    }
    const Flicker with = countOf(held, ten), without = countOf(plain, ten);
    fmt::print("  {:6} held      {:8}  {:6}  {:8}  {:8}\n", person, with.reported, with.missed,
               with.repeated, with.invented);
    fmt::print("         not held  {:8}  {:6}  {:8}  {:8}\n", without.reported, without.missed,
               without.repeated, without.invented);
  }
}

int run() {
  const nn::Fitted fitted = trainingTable();
  adapting(fitted);
  flicker(fitted);
  fmt::print("\n");
  recall(fitted.network, people(5001, 10, 5, 3));
  return 0;
}

}  // namespace
}  // namespace merlin::bench

int main() { return merlin::bench::run(); }
