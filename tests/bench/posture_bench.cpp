// ./dev bench posture: training compared with the simplest classifiers on people not used for
// training, adaptation to one more person, gloves that drift, flicker of the reported postures, and
// recall. The comparison with FANN is in fann_bench.cpp.
//
// All hands are synthetic. Absolute times differ between machines; the ratios are between times of
// one run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

#include <fmt/format.h>

#include "nn/adapt.h"
#include "nn/drift.h"
#include "nn/evaluate.h"
#include "nn/fit.h"
#include "nn/hold.h"
#include "nn/train.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/nanoseconds.h"
#include "tests/nn/drifting.h"
#include "tests/nn/shipped.h"

namespace merlin::bench {
namespace {

using nn::DataSet;

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

DataSet people(std::size_t first, std::size_t count, std::size_t per_take, std::uint64_t seed) {
  return nn::test::people(hand::allShapes(), first, count, per_take, seed);
}

// Returns the value of a training that succeeded; ends the benchmark if it failed.
template <typename T>
const T& expect(const Result<T>& result, const char* subject) {
  if (!result) didNotRun(subject, result.error().what, "see nn/README.md");
  return *result;
}

Measured accuracyOf(const nn::PostureNetwork& network, const DataSet& hands) {
  return Measured::of(nn::score(network, hands).accuracy(), hands.size(), "hands");
}

void recall(const nn::PostureNetwork& network, const DataSet& hands, Report& report) {
  const nn::Recogniser recognise(network);
  volatile std::uint32_t sink = 0;
  const Measured ns =
      nanoseconds([&](std::size_t n) { sink = recognise(hands[n % 1024].value).code; });
  report.text("recall, scaling and names and all: {:.0f} ns\n", ns.value());
  report.figure("recall", ns, "ns");
}

// Measures the accuracy of the method of 1998 in its simplest form: consecutive numbers as codes,
// the glove's fixed ranges, gradient descent over all examples.
Measured plainAccuracy(const DataSet& train, const DataSet& test) {
  nn::PostureNetwork network;
  std::vector<std::size_t> posture;
  const auto names = nn::posturesOf(train, posture);
  for (std::size_t k = 0; k < names.size(); ++k)
    (void)network.postures.add(static_cast<std::uint32_t>(k), names[k]);
  const auto examples = nn::toExamples(train, network);
  const auto trained = nn::train(nn::initialWeights(1), *examples,
                                 {.rate = 5, .max_iterations = 1500, .mse_limit = 1e-4});
  network.weights = expect(trained, "the plain descent").weights;
  return accuracyOf(network, test);
}

nn::Fitted trainingTable(Report& report) {
  report.text(
      "\n31 postures x 50 hands of 10 people, tested on 10 others (synthetic)\n"
      "  seed  network %  nearest mean %  nearest neighbour %  rejected  training s (CPU)\n");
  nn::Fitted first;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DataSet train = people(1 + 100 * (seed - 1), 10, 5, seed), test = people(5001, 10, 5, 99);
    const double began = cpuSeconds();
    const auto result = nn::fit(train, {});
    const double took = cpuSeconds() - began;
    const nn::Fitted& fitted = expect(result, "the training");
    const nn::Score s = nn::score(fitted.network, test);
    const Measured accuracy = accuracyOf(fitted.network, test);
    const nn::Neighbours n = nn::neighbours(train, test);
    report.text("  {:4}  {:9.2f}  {:14.2f}  {:19.2f}  {:8}  {:16.2f}\n", seed, 100 * accuracy,
                100 * n.mean, 100 * n.nearest, s.rejected, took);
    report.figure(fmt::format("accuracy.seed{}", seed), accuracy, "1");
    report.figure(fmt::format("training.seed{}", seed), Measured::of(took, 1, "trainings"), "s");
    if (seed == 1) {
      const Measured plain = plainAccuracy(train, test);
      report.text("        {:.2f} % with running numbers as codes and plain descent\n",
                  100 * plain);
      report.figure("accuracy.plain_descent", plain, "1");
      first = fitted;
    }
  }
  return first;
}

void adapting(const nn::Fitted& fitted, Report& report) {
  report.text(
      "\nadapting to one person more, 200 hands of each posture\n"
      "  person  theirs before %  after %  ten others before %  after %  s (CPU)\n");
  const DataSet others = people(5001, 10, 5, 7);
  for (const std::size_t person : {9001U, 9002U, 9003U}) {
    const DataSet own = people(person, 1, 200, 1), later = people(person, 1, 50, 2);
    const double began = cpuSeconds();
    const auto result = nn::adapt(fitted.network, fitted.statistics, own, 1);
    const double took = cpuSeconds() - began;
    const nn::PostureNetwork& adapted = expect(result, "the adapting").network;
    const Measured before = accuracyOf(fitted.network, later), after = accuracyOf(adapted, later);
    report.text("  {:6}  {:15.2f}  {:7.2f}  {:19.2f}  {:7.2f}  {:7.2f}\n", person, 100 * before,
                100 * after, 100 * accuracyOf(fitted.network, others),
                100 * accuracyOf(adapted, others), took);
    report.figure(fmt::format("accuracy.person{}", person), before, "1");
    report.figure(fmt::format("accuracy.person{}.adapted", person), after, "1");
  }
}

// Trains with the first half of each person's session and tests with the second half. These people
// influenced no choice of the training method.
void drifts(Report& report) {
  constexpr std::uint64_t kFirst = 4001, kPeople = 20;
  std::size_t hands = 0, faults = 0, followed = 0;
  double by_mean = 0, by_hand = 0;
  for (std::uint64_t person = kFirst; person < kFirst + kPeople; ++person) {
    const nn::test::Session session = nn::test::drifting(hand::allShapes(), person, {});
    const auto result = nn::fit(session.first, {});
    const nn::Fitted& fitted = expect(result, "the training");
    nn::DriftFollower follow(fitted.network, fitted.statistics, {});
    const auto count = static_cast<std::size_t>(std::count_if(
        session.second.begin(), session.second.end(),
        [&](const nn::LabelledHand& h) { return follow(h.value).name != h.posture; }));
    const nn::Score s = nn::score(fitted.network, session.second);
    const nn::Neighbours n = nn::neighbours(session.first, session.second);
    hands += s.total;
    faults += s.total - s.right;
    followed += count;
    by_mean += (1 - n.mean) / static_cast<double>(kPeople);
    by_hand += (1 - n.nearest) / static_cast<double>(kPeople);
  }
  const Measured alone = shareOf(faults, hands, "hands"), with = shareOf(followed, hands, "hands");
  report.text(
      "\n{} people whose gloves drift in a session, 31 postures; the first half trains, the second "
      "tests\n"
      "  faults in {} hands: network {} ({:.2f} %), network and drift followed {} ({:.2f} %), "
      "nearest mean {:.2f} %, nearest neighbour {:.2f} %\n",
      kPeople, hands, faults, 100 * alone, followed, 100 * with, 100 * by_mean, 100 * by_hand);
  report.figure("drift.faults", alone, "1");
  report.figure("drift.faults.followed", with, "1");
  report.figure("drift.faults.nearest_neighbour", Measured::of(by_hand, kPeople, "people"), "1");
}

struct Flicker {
  std::size_t reported = 0, missed = 0, invented = 0, repeated = 0;
};

// Compares the reported names with the intended ones, in order. A name out of order counts as
// wrong, unless only the intended name before it was missed.
Flicker countOf(const std::vector<std::string>& reported, std::span<const hand::Shape> meant) {
  Flicker f;
  f.reported = reported.size();
  std::vector<bool> seen(meant.size());
  std::size_t now = 0;  // index of the last posture that was reported correctly
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
  // names reported with hold time and hysteresis, and without them
  std::vector<std::string> held, plain;
};

Reported reportedBy(const nn::PostureNetwork& network, std::span<const hand::Shot> shots) {
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

void printFlicker(std::size_t person, const char* what, const Flicker& f, Report& report) {
  report.text("  {}  {:25}  {:8}  {:6}  {:8}  {:8}\n", person, what, f.reported, f.missed,
              f.repeated, f.invented);
  const auto invented = shareOf(f.invented, f.reported, "postures reported");
  report.figure(fmt::format("person{}.{}.invented", person, what), invented, "1");
}

void flicker(const nn::Fitted& fitted, Report& report) {
  const auto ten = hand::allShapes().subspan(0, 10);
  report.text(
      "\nten postures, 1 s each, 0.35 s from one to the next, 100 records a second\n"
      "  {:31}  reported  missed  repeated  invented\n",
      "person");
  for (const std::size_t person : {9001U, 9002U, 9003U}) {
    const auto shots = hand::goThrough(ten, hand::Person(person), 100, 35, 1);
    const auto result = nn::adapt(fitted.network, fitted.statistics, people(person, 1, 200, 1), 1);
    const Reported unseen = reportedBy(fitted.network, shots),
                   known = reportedBy(expect(result, "the adapting").network, shots);
    printFlicker(person, "never seen, held", countOf(unseen.held, ten), report);
    printFlicker(person, "never seen, as recognised", countOf(unseen.plain, ten), report);
    printFlicker(person, "adapted to, held", countOf(known.held, ten), report);
    printFlicker(person, "adapted to, as recognised", countOf(known.plain, ten), report);
  }
}

bool run(Report& report) {
  note("training");
  const nn::Fitted fitted = trainingTable(report);
  note("adapting");
  adapting(fitted, report);
  note("drift");
  drifts(report);
  flicker(fitted, report);
  report.text("\n");
  recall(fitted.network, people(5001, 10, 5, 3), report);
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "The posture network: training, adapting, drift, flicker, recall.");
  return app.run("posture", argc, argv, merlin::bench::run);
}
