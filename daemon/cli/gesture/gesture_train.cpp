// merlin gesture train: trains gestures on recorded takes. merlin gesture synthesize: creates takes
// of synthetic people for tests.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/gesture/gesture.h"
#include "daemon/cli/print.h"
#include "nn/io/gesture_file.h"
#include "nn/io/path_file.h"

namespace merlin::cli {
namespace {

// The synthetic people on whom the shipped gestures were trained. Tests use people from number 1001
// on.
const SyntheticMovers kTrained{
    .first = 1, .people = 300, .times = 6, .ordinary_s = 600, .kind_s = 60, .seed = 1};
// The synthetic people whose ordinary motion is added to a recording that has none.
const SyntheticMovers kOrdinary{
    .first = 1, .people = 40, .times = 0, .ordinary_s = 600, .kind_s = 60, .seed = 1};

struct TrainGestureOptions {
  std::string data, output;
  nn::GestureTrainingSettings settings;
};

struct TrainingStrokes {
  std::vector<nn::LabelledStroke> strokes;
  std::size_t lost = 0;  // takes without a stroke
  bool synthetic = true;
  std::string how;
};

// Returns why the recording has no stroke of ordinary motion, as a clause for a message.
const char* whyNoOrdinary(const nn::PathRecording& recording) {
  const auto& labels = recording.labels;
  return std::find(labels.begin(), labels.end(), nn::kNoGesture) == labels.end()
             ? "has no ordinary motion (the label none)"
             : "its ordinary motion (the label none) has no stroke to learn from";
}

// Returns the strokes to train on: those of the recording that the options name or, without one, of
// kTrained. Adds the ordinary motion of kOrdinary to a recording without any. Errors: those of
// nn::loadPaths().
Result<TrainingStrokes> trainingStrokes(const TrainGestureOptions& options) {
  TrainingStrokes training;
  if (options.data.empty()) {
    training.strokes = strokesOf(kTrained, training.lost);
    training.how = fmt::format("{} synthetic people, {} takes of each gesture by each of them",
                               kTrained.people, kTrained.times);
    return training;
  }
  const auto recording = nn::loadPaths(options.data);
  if (!recording) return recording.error();
  training.synthetic = recording->synthetic;
  training.strokes = nn::strokesOf(*recording, kAfterTake_s, training.lost);
  training.how = "recording " + options.data.substr(options.data.find_last_of('/') + 1);
  const auto isNone = [](const nn::LabelledStroke& s) { return s.gesture == nn::kNoGesture; };
  if (std::any_of(training.strokes.begin(), training.strokes.end(), isNone)) return training;
  printError("{}: {}, so the ordinary motion of {} synthetic people is used\n", options.data,
             whyNoOrdinary(*recording), kOrdinary.people);
  std::size_t none = 0;
  for (nn::LabelledStroke& stroke : strokesOf(kOrdinary, none))
    training.strokes.push_back(std::move(stroke));
  training.synthetic = true;
  training.how += ", ordinary motion of synthetic people";
  return training;
}

int trainGestureFile(const TrainGestureOptions& options) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  const auto training = trainingStrokes(options);
  if (!training) return fail(training.error());
  auto model = nn::trainGestures(training->strokes, options.settings);
  if (!model) {
    Error error = model.error();
    error.what = (options.data.empty() ? "synthetic people" : options.data) + ": " + error.what;
    return fail(error);
  }
  const auto ordinary = static_cast<std::uint64_t>(
      std::count_if(training->strokes.begin(), training->strokes.end(),
                    [](const auto& s) { return s.gesture == nn::kNoGesture; }));
  const std::uint64_t meant = training->strokes.size() - ordinary;
  const nn::GestureFile file{*std::move(model),
                             {training->how.substr(0, 200), meant, ordinary, training->synthetic}};
  if (const auto saved = nn::saveGestures(options.output, file); !saved) return fail(saved.error());
  printOut("{}: {} gestures from {} takes{} and {} strokes of ordinary motion in {:.1f} s\n",
           options.output, file.model.gestures.size(), meant,
           training->synthetic ? " (synthetic)" : "", ordinary, toSeconds(clock.now() - began));
  if (training->lost > 0)
    printError("{} takes were left out: the hand did not move in them, or not as one stroke\n",
               training->lost);
  return kExitDone;
}

struct SynthesizeGestureOptions {
  SyntheticMovers movers{.people = 5, .ordinary_s = 60};
  std::string output;
};

int synthesizeGestures(const SynthesizeGestureOptions& options) {
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  nn::PathRecording all;
  all.synthetic = true;
  for (std::size_t n = 0; n < options.movers.people; ++n) {
    const nn::PathRecording one = recordingOf(options.movers, options.movers.first + n);
    for (const nn::LabelledPose& p : one.poses)
      all.poses.push_back({all.labelled(one.labels[p.label]), p.pose});
  }
  if (const auto saved = nn::savePaths(options.output, all); !saved) return fail(saved.error());
  printOut("{}: {} poses of {} synthetic people\n", options.output, all.poses.size(),
           options.movers.people);
  return kExitDone;
}

}  // namespace

void addGestureTrain(Command gesture, Run& run) {
  const auto options = std::make_shared<TrainGestureOptions>();
  Command command = gesture.subcommand(
      "train",
      "Train gestures on recorded takes; without DATA, on the synthetic people that the shipped "
      "gestures were trained on. Ordinary motion, in which no gesture must be recognised, comes "
      "from the takes with the label none; without such takes, from synthetic people.\nExample: "
      "merlin gesture train gestures.csv -o gestures.json");
  command.option("data", options->data, "Recorded takes, CSV").typeName("DATA.csv");
  command.option("-o", options->output, "File of the trained gestures")
      .required()
      .typeName("FILE.json");
  command
      .option("--worth", options->settings.worth,
              "How many takes may be missed so that one stroke of the recorded ordinary motion is "
              "not taken for a gesture")
      .range(0.0, 1000.0)
      .showDefault();
  command.callback([options, &run] { run = [options] { return trainGestureFile(*options); }; });
}

void addGestureSynthesize(Command gesture, Run& run) {
  const auto options = std::make_shared<SynthesizeGestureOptions>();
  Command command = gesture.subcommand(
      "synthesize",
      "Create takes of synthetic people, for tests; no real person was measured.\nExample: merlin "
      "gesture synthesize -o takes.csv --people 5 --first 1001");
  command.option("-o", options->output, "The CSV file").required().typeName("FILE.csv");
  SyntheticMovers& movers = options->movers;
  const auto count = [&](const char* name, std::size_t& value, const char* help, std::size_t least,
                         std::size_t most) {
    command.option(name, value, help).range(least, most).showDefault();
  };
  count("--first", movers.first, "Number of the first person; each number is a different person", 1,
        1 << 30);
  count("--people", movers.people, "Number of people", 1, 100);
  count("--times", movers.times, "Number of takes of each gesture by each person", 0, 100);
  command.option("--ordinary", movers.ordinary_s, "Ordinary motion of each person in seconds")
      .range(0.0, 3600.0)
      .showDefault();
  command.option("--seed", movers.seed, "Seed of the random numbers").showDefault();
  command.callback([options, &run] { run = [options] { return synthesizeGestures(*options); }; });
}

}  // namespace merlin::cli
