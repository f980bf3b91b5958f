// merlin gesture test: measures how often gestures are recognised in a recording, and how often a
// gesture is reported that nobody made.
#include "daemon/cli/gesture/gesture.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "nn/gesture/evaluation.h"
#include "nn/io/gesture_file.h"
#include "nn/io/path_file.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// Synthetic people for tests; the shipped gestures were not trained on them.
const SyntheticMovers kUnseenMovers{
    .first = 1001, .people = 20, .times = 5, .ordinary_s = 600, .kind_s = 0, .seed = 2};

struct TestGestureOptions {
  std::string gestures = "config/gestures.json", data;
  bool json = false;
};

struct Tested {
  nn::GestureEvaluation evaluation;
  bool synthetic = true;
};

// Evaluates the model on the recording `data` or, if it is empty, on the unseen synthetic people.
// Errors: those of nn::loadPaths().
Result<Tested> evaluate(const nn::GestureModel& model, const std::string& data) {
  Tested tested;
  if (data.empty()) {
    for (std::size_t n = 0; n < kUnseenMovers.people; ++n)
      nn::evaluateGestures(recordingOf(kUnseenMovers, kUnseenMovers.first + n), model,
                           tested.evaluation);
    return tested;
  }
  const auto recording = nn::loadPaths(data);
  if (!recording) return recording.error();
  tested.synthetic = recording->synthetic;
  nn::evaluateGestures(*recording, model, tested.evaluation);
  return tested;
}

nlohmann::ordered_json toJson(const Tested& tested) {
  const nn::GestureEvaluation& e = tested.evaluation;
  Json gestures = Json::array(), confusion = Json::array();
  for (const auto& [name, score] : e.of)
    gestures.push_back({{"gesture", name},
                        {"accuracy", score.rate()},
                        {"takes", score.takes},
                        {"right", score.right},
                        {"missed", score.missed},
                        {"wrong", score.wrong},
                        {"repeated", score.repeated}});
  for (const auto& [meant, row] : e.confusion) {
    for (const auto& [reported, takes] : row)
      confusion.push_back({{"meant", meant},
                           {"reported", reported.empty() ? Json(nullptr) : Json(reported)},
                           {"takes", takes}});
  }
  return {{"accuracy", e.all.rate()},
          {"takes", e.all.takes},
          {"right", e.all.right},
          {"missed", e.all.missed},
          {"wrong", e.all.wrong},
          {"repeated", e.all.repeated},
          {"invented", e.invented},
          {"ordinary_s", e.ordinary_s},
          {"invented_per_10_min", e.inventedPerTenMinutes()},
          {"synthetic", tested.synthetic},
          {"gestures", gestures},
          {"confusion", confusion}};
}

void printTable(const Tested& tested) {
  const nn::GestureEvaluation& e = tested.evaluation;
  printOut(
      "{} of {} {}takes right ({:.2f} %), {} missed, {} reported as another gesture, {} as "
      "several; {} gestures invented in {:.0f} s of other motion ({:.2f} in ten minutes)\n",
      e.all.right, e.all.takes, tested.synthetic ? "synthetic " : "", 100 * e.all.rate(),
      e.all.missed, e.all.wrong, e.all.repeated, e.invented, e.ordinary_s,
      e.inventedPerTenMinutes());
  if (e.all.takes > 0)
    printOut("\n  gesture                           right  missed  wrong  several\n");
  for (const auto& [name, score] : e.of)
    printOut("  {:31}  {:5} / {:5}  {:6}  {:5}  {:7}\n", name, score.right, score.takes,
             score.missed, score.wrong, score.repeated);
}

int test(const TestGestureOptions& options) {
  const auto file = nn::loadGestures(options.gestures);
  if (!file) return fail(file.error());
  const auto tested = evaluate(file->model, options.data);
  if (!tested) return fail(tested.error());
  if (options.json) {
    printJsonLine(toJson(*tested));
  } else {
    printTable(*tested);
  }
  return kExitDone;
}

}  // namespace

void addGestureTest(Command gesture, Run& run) {
  const auto options = std::make_shared<TestGestureOptions>();
  Command command = gesture.subcommand(
      "test",
      "Test trained gestures on a recording, played as if it were live: how many takes are "
      "recognised, and how many gestures are reported outside of them. Without DATA, on synthetic "
      "people on whom the shipped gestures were not trained.\nExample: merlin gesture test "
      "gestures.json takes.csv --json");
  command.option("gestures,--gestures", options->gestures, "File of the trained gestures")
      .showDefault()
      .typeName("GESTURES.json");
  command.option("data,--data", options->data, "Recorded takes, CSV").typeName("DATA.csv");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return test(*options); }; });
}

}  // namespace merlin::cli
