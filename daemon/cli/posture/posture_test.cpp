// merlin posture test: prints the accuracy, the confusions and the margins of a posture network on
// labelled hands.
#include "daemon/cli/posture/posture.h"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "nn/evaluate.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// Number of the first synthetic person for tests; the shipped network was not trained on any person
// from this number on.
constexpr std::size_t kUnseen = 1001;
constexpr std::size_t kShown = 10;  // maximum number of confusions in the table

struct TestOptions {
  std::string network = "config/postures.json", data, beside;
  RecordingForm form;
  double margin = 0.3;
  bool json = false, follow = false;
};

Result<nn::Recording> testHands(const TestOptions& options, const nn::PostureNetwork& network) {
  if (!options.data.empty()) return readFor(network, options.data, options.form);
  return synthesize(
      {.first = kUnseen, .people = 20, .takes = 5, .per_take = 10, .postures = 8, .seed = 2});
}

nlohmann::ordered_json toJson(const nn::Evaluation& e, bool synthetic) {
  Json confusion = Json::array(), postures = Json::array();
  for (const nn::Confusion& c : e.confusions)
    confusion.push_back({{"shown", c.shown},
                         {"taken_for", c.taken_for.empty() ? Json(nullptr) : Json(c.taken_for)},
                         {"hands", c.hands}});
  for (const nn::PostureScore& p : e.postures)
    postures.push_back({{"posture", p.posture},
                        {"accuracy", p.score.accuracy()},
                        {"right", p.score.right},
                        {"total", p.score.total},
                        {"rejected", p.score.rejected},
                        {"least_margin", p.least_margin},
                        {"mean_margin", p.mean_margin}});
  return {{"accuracy", e.all.accuracy()}, {"right", e.all.right},
          {"total", e.all.total},         {"rejected", e.all.rejected},
          {"unsure", e.unsure},           {"right_and_sure", e.right_and_sure},
          {"synthetic", synthetic},       {"confusion", confusion},
          {"postures", postures}};
}

void printTable(const nn::Evaluation& e, bool synthetic, double margin) {
  printOut(
      "{} of {} {}hands right ({:.3f} %), {} recognised as no posture, {} as another; {} with a "
      "margin below {}\n",
      e.all.right, e.all.total, synthetic ? "synthetic " : "", 100 * e.all.accuracy(),
      e.all.rejected, e.all.total - e.all.right - e.all.rejected, e.unsure, margin);
  if (!e.confusions.empty()) printOut("\n  hands  shown                recognised as\n");
  for (std::size_t n = 0; n < std::min(kShown, e.confusions.size()); ++n) {
    const nn::Confusion& c = e.confusions[n];
    printOut("  {:5}  {:19}  {}\n", c.hands, c.shown, c.taken_for.empty() ? "-" : c.taken_for);
  }
  printOut("\n  posture                right         margin: least  mean\n");
  for (const nn::PostureScore& p : e.postures)
    printOut("  {:19}  {:5} / {:5}        {:5.2f}  {:5.2f}\n", p.posture, p.score.right,
             p.score.total, p.least_margin, p.mean_margin);
}

// Evaluates the network on the hands, with or without following the drift of the sensors. Errors:
// kInvalidArgument (the drift is to be followed, but the file lacks the means of the postures).
Result<nn::Evaluation> evaluate(const nn::NetworkFile& file,
                                std::span<const nn::LabelledHand> hands,
                                const TestOptions& options) {
  if (!options.follow) return nn::evaluate(file.network, hands, options.margin);
  if (!file.statistics)
    return Error{Errc::kInvalidArgument, options.network +
                                             ": has no /memory, the means of its postures, which "
                                             "are needed to follow drift: train the network again"};
  nn::DriftFollower follower(file.network, *file.statistics, {});
  return nn::evaluate(follower, hands, options.margin);
}

int test(const TestOptions& options) {
  const auto file = nn::loadNetwork(options.network);
  if (!file) return fail(file.error());
  const auto recording = testHands(options, file->network);
  if (!recording) return fail(recording.error());
  const auto evaluation = evaluate(*file, recording->hands, options);
  if (!evaluation) return fail(evaluation.error());
  const nn::Evaluation& e = *evaluation;
  auto json = toJson(e, recording->synthetic);
  if (!options.beside.empty()) {
    const auto train = readFor(file->network, options.beside, options.form);
    if (!train) return fail(train.error());
    const nn::Neighbours n = nn::neighbours(train->hands, recording->hands);
    json["nearest_mean"] = n.mean;
    json["nearest_neighbour"] = n.nearest;
    if (!options.json)
      printOut("for comparison, from {}: nearest mean {:.3f} %, nearest neighbour {:.3f} %\n",
               options.beside, 100 * n.mean, 100 * n.nearest);
  }
  if (options.json) {
    printJsonLine(json);
  } else {
    printTable(e, recording->synthetic, options.margin);
  }
  return kExitDone;
}

}  // namespace

void addPostureTest(Command posture, Run& run) {
  const auto options = std::make_shared<TestOptions>();
  Command command = posture.subcommand(
      "test",
      "Test a network on labelled hands: its accuracy, confusions and margins. Without DATA, on "
      "hands of synthetic people whom the shipped network was not trained on.\nExample: merlin "
      "posture test "
      "postures.json hands.csv --json");
  command.option("net,--network", options->network, "File of the network")
      .showDefault()
      .typeName("NET.json");
  command.option("hands,--data", options->data, "Labelled hands, CSV").typeName("DATA.csv");
  command
      .option("--beside", options->beside,
              "The training hands, CSV: also print, for comparison, the accuracy of the "
              "nearest-mean and nearest-neighbour classifiers on them")
      .typeName("TRAIN.csv");
  command
      .option("--margin", options->margin,
              "Margin, 0 to 1, below which the recognition of a hand counts as unsure")
      .range(0.0, 1.0)
      .showDefault();
  addForm(command, options->form);
  command.flag("--follow-drift", options->follow,
               "Follow the drift of the glove's sensors, without looking at the labels; for hands "
               "of one person in the order in which they were recorded");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return test(*options); }; });
}

}  // namespace merlin::cli
