// merlin posture train: trains a posture network on labelled hands, or cross-validates the
// training.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/posture/learning_curve.h"
#include "daemon/cli/posture/posture.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "nn/cross_validation.h"

namespace merlin::cli {
namespace {

struct TrainOptions {
  std::string data, output, curve, phi = "sigmoid";
  RecordingForm form;
  nn::FitSettings fit;
  std::size_t folds = 0;
  bool json = false;
};

// Returns the hands to train on: those of the given file or, without one, of the synthetic people
// on whom the shipped network was trained.
Result<nn::Recording> trainingHands(const TrainOptions& options) {
  if (!options.data.empty()) return readRecording(options.data, options.form);
  return synthesize({.people = 20, .takes = 2, .postures = 8});
}

// Calls `work` with a progress function for nn::fit() that draws a bar, and returns its result.
// `seconds` is set to the duration of `work`.
template <typename Work>
auto withBar(const std::string& title, double& seconds, const Work& work) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  ProgressBar bar(title, "passes", clock);
  std::size_t passes = 0;
  auto result = work([&](double share, const nn::CurvePoint& point) {
    passes = point.pass;
    bar.update(share, passes);
    return true;
  });
  if (result) bar.finish(passes);
  seconds = toSeconds(clock.now() - began);
  return result;
}

int crossValidate(const nn::Recording& recording, const TrainOptions& options) {
  std::vector<nn::FoldScore> scores;
  for (std::size_t fold = 0; fold < options.folds; ++fold) {
    double seconds = 0;
    const auto score =
        withBar(fmt::format("fold {} of {}", fold + 1, options.folds), seconds,
                [&](const nn::FitProgress& progress) {
                  return nn::scoreFold(recording.hands, options.folds, fold, options.fit, progress);
                });
    if (!score) return fail(score.error());
    printOut(
        "fold {}: {:.2f} % of {} hands right (nearest mean {:.2f} %, nearest neighbour "
        "{:.2f} %), {:.2f} s\n",
        fold + 1, 100 * score->accuracy, score->hands, 100 * score->neighbours.mean,
        100 * score->neighbours.nearest, seconds);
    scores.push_back(*score);
  }
  const nn::FoldScore mean = nn::meanOf(scores);
  printOut("{} folds: {:.2f} % right (nearest mean {:.2f} %, nearest neighbour {:.2f} %)\n",
           options.folds, 100 * mean.accuracy, 100 * mean.neighbours.mean,
           100 * mean.neighbours.nearest);
  return kExitDone;
}

int report(const TrainOptions& options, const nn::Fitted& fitted, double seconds) {
  if (!options.curve.empty()) {
    const auto written = writeFile(options.curve, curveSvg(fitted.curve, options.output));
    if (!written) return fail(written.error());
  }
  printOut("{}", curveText(fitted.curve));
  printOut(
      "{}: {} postures from {} hands{} in {:.2f} s; {:.2f} % of the training hands right, "
      "{:.2f} % of the validation hands\n",
      options.output, fitted.network.postures.size(), fitted.trained.samples,
      fitted.trained.synthetic ? " (synthetic)" : "", seconds, 100 * fitted.training_accuracy,
      100 * fitted.validation_accuracy);
  return kExitDone;
}

int train(TrainOptions options) {
  const auto writable = checkWritable({options.folds > 0 ? "" : options.output, options.curve});
  if (!writable) return fail(writable.error());
  const auto recording = trainingHands(options);
  if (!recording) return fail(recording.error());
  options.fit.phi = nn::phiNamed(options.phi).value_or(nn::Phi::kSigmoid);
  options.fit.unit = recording->unit;
  if (options.folds > 0) return crossValidate(*recording, options);
  double seconds = 0;
  auto fitted = withBar("training", seconds, [&](const nn::FitProgress& progress) {
    return nn::fit(recording->hands, options.fit, progress);
  });
  if (!fitted) return fail(fitted.error());
  fitted->trained.synthetic = recording->synthetic;
  const auto saved =
      nn::saveNetwork(options.output, {fitted->network, fitted->trained, fitted->statistics});
  if (!saved) return fail(saved.error());
  return report(options, *fitted, seconds);
}

}  // namespace

void addPostureTrain(Command posture, Run& run) {
  const auto options = std::make_shared<TrainOptions>();
  Command command = posture.subcommand(
      "train",
      "Train a network on labelled hands; without DATA, on the synthetic people that the shipped "
      "network was trained on.\nExample: merlin posture train hands.csv -o postures.json --curve "
      "curve.svg");
  command.option("data", options->data, "Labelled hands, CSV").typeName("DATA.csv");
  const Argument output =
      command.option("-o", options->output, "File of the network").typeName("FILE.json");
  command.option("--curve", options->curve, "Write the learning curve as an SVG chart")
      .typeName("FILE.svg");
  command.option("--seed", options->fit.seed, "Seed of all random numbers").showDefault();
  command.option("--phi", options->phi, "Activation function of the network's nodes")
      .oneOf({"sigmoid", "atan"})
      .showDefault();
  command
      .option("--starts", options->fit.starts,
              "Number of random starts that are tried; each chooses the postures' codes and the "
              "initial weights")
      .range(1, 1000)
      .showDefault();
  command
      .option("--passes", options->fit.passes,
              "Maximum number of passes over the hands when training goes on from the best start")
      .range(1, 1000000)
      .showDefault();
  command
      .option("--error", options->fit.mse_limit,
              "Go on to the final passes earlier, once the mean squared error of a pass is below "
              "this (but not in the first four fifths of --passes); 0: never")
      .range(0.0, 1.0)
      .showDefault();
  command
      .option("--folds", options->folds,
              "Cross-validate instead of writing a network: divide the hands into this number of "
              "parts; "
              "for each part, train on the others and test on it")
      .range(2, 100);
  addForm(command, options->form);
  command.callback([options, output, &run] {
    if (options->folds == 0 && !output.isGiven()) lacks("-o or --folds");
    run = [options] { return train(*options); };
  });
}

}  // namespace merlin::cli
