// ./dev bench posture: training beside the simplest classifiers on people never seen, adapting to
// one more, postures that flicker or do not, and recall. Beside FANN: fann_bench.cpp.
//
// All hands are synthetic. Absolute times differ from machine to machine; ratios are of one run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include <fmt/format.h>

#include "nn/adapt.h"
#include "nn/evaluate.h"
#include "nn/fit.h"
#include "nn/hold.h"
#include "nn/train.h"
#include "tests/bench/nanoseconds.h"
#include "tests/nn/shipped.h"

namespace merlin::bench {
namespace {

using nn::DataSet;

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

DataSet people(std::size_t first, std::size_t count, std::size_t per_take, std::uint64_t seed) {
  return nn::test::people(hand::allShapes(), first, count, per_take, seed);
}

void recall(const nn::PostureNetwork& network, const DataSet& hands) {
  const nn::Recogniser recognise(network);
  volatile std::uint32_t sink = 0;
  const double ns =
      nanoseconds([&](std::size_t n) { sink = recognise(hands[n % 1024].value).code; });
  fmt::print("recall, scaling and names and all: {:.0f} ns\n", ns);
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

// The names that were reported, beside those that were meant, in their order. What comes out of its
// turn was never meant there, unless only the next one was missed.
Flicker countOf(const std::vector<std::string>& reported, std::span<const hand::Shape> meant) {
  Flicker f;
  f.reported = reported.size();
  std::vector<bool> seen(meant.size());
  std::size_t now = 0;  // the last one that was reported rightly
  for (const std::string& name : reported) {
    const auto at = std::find_if(meant.begin(), meant.end(),
                                 [&](const hand::Shape& s) { return s.name == name; });
    const auto index = static_cast<std::size_t>(at - meant.begin());
    if (at == meant.end() || index < now || index > now + 2) {
      ++f.invented;
    } else if (seen[index]) {
      ++f.repeated;
    } else {
      seen[index] = true;
      now = index;
    }
  }
  f.missed = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), false));
  return f;
}

struct Reported {
  std::vector<std::string> held, plain;  // with hold and hysteresis, and without
};

Reported report(const nn::PostureNetwork& network, std::span<const hand::Shot> shots) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  const nn::Recogniser recognise(network);
  Reported r;
  nn::PostureHold hold({});
  std::string last;
  std::uint32_t entered = 0;
  for (std::size_t n = 0; n < shots.size(); ++n) {
    const nn::Recognition seen = recognise(shots[n].angle_rad);
    if (seen.name != last && !seen.name.empty()) r.plain.emplace_back(seen.name);
    last = seen.name;
    const nn::Held& h = hold.update(seen, static_cast<std::int64_t>(n) * kPeriod_ns);
    if (h.entered != entered) r.held.emplace_back(recognise.name(h.code));
    entered = h.entered;
  }
  return r;
}

void printFlicker(std::size_t person, const char* what, const Flicker& f) {
  fmt::print("  {}  {:25}  {:8}  {:6}  {:8}  {:8}\n", person, what, f.reported, f.missed,
             f.repeated, f.invented);
}

void flicker(const nn::Fitted& fitted) {
  const auto ten = hand::allShapes().subspan(0, 10);
  fmt::print(
      "\nten postures, 1 s each, 0.35 s from one to the next, 100 records a second\n"
      "  {:31}  reported  missed  repeated  invented\n",
      "person");
  for (const std::size_t person : {9001U, 9002U, 9003U}) {
    const auto shots = hand::goThrough(ten, hand::Person(person), 100, 35, 1);
    const auto adapted =
        nn::adapt(fitted.network, fitted.memory, people(person, 1, 200, 1), 1)->network;
    const Reported unseen = report(fitted.network, shots), known = report(adapted, shots);
    printFlicker(person, "never seen, held", countOf(unseen.held, ten));
    printFlicker(person, "never seen, as recognised", countOf(unseen.plain, ten));
    printFlicker(person, "adapted to, held", countOf(known.held, ten));
    printFlicker(person, "adapted to, as recognised", countOf(known.plain, ten));
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
