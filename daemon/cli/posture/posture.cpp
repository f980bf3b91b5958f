#include "daemon/cli/posture/posture.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/hand/recording.h"

namespace merlin::cli {
namespace {

constexpr float kMostCount = 255;  // largest raw count

// Converts raw counts to angles with the shipped calibration; sensor slots that were not measured
// are not changed. `path`: for messages. Errors: kInvalidArgument (a value is not a raw count).
Result<nn::Recording> toRadians(nn::Recording recording, const std::string& path) {
  const CybergloveSettings calibration;
  for (nn::LabelledHand& hand : recording.hands) {
    for (std::size_t i = 0; i < nn::kInputs; ++i) {
      if (!recording.measured[i]) continue;
      if (hand.value[i] < 0 || hand.value[i] > kMostCount)
        return Error{
            Errc::kInvalidArgument,
            fmt::format(
                "{}: {} is {}, which is not a raw count of a glove (0 to {}), so it cannot be "
                "converted to the angles that the network takes; train a network on such "
                "data",
                path, nn::kInputNames[i], hand.value[i], kMostCount)};
      hand.value[i] = (hand.value[i] - calibration.offset[i]) * calibration.gain[i];
    }
  }
  recording.unit = nn::InputUnit::kRadians;
  printError("{}: raw counts converted to angles with the shipped calibration\n", path);
  return recording;
}

}  // namespace

std::optional<nn::InputUnit> unitNamed(const std::string& name) {
  if (name == "raw") return nn::InputUnit::kRaw;
  if (name == "rad") return nn::InputUnit::kRadians;
  return std::nullopt;
}

void addUnits(Command command, std::string& units) {
  command
      .option("--units", units,
              "Unit of the recording: rad (radians), raw (counts, degrees or any other unit of the "
              "sensors), or auto (raw if the absolute value of any number is above 6.3)")
      .oneOf({"auto", "rad", "raw"})
      .showDefault();
}

Result<nn::Recording> readRecording(const std::string& path, std::optional<nn::InputUnit> unit) {
  auto recording = nn::loadRecording(path, unit);
  if (!recording) return recording;
  for (const std::string& note : recording->notes) printError("{}: {}\n", path, note);
  return recording;
}

Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              std::optional<nn::InputUnit> unit) {
  const bool raw = network.unit == nn::InputUnit::kRaw;
  if (raw && unit == nn::InputUnit::kRadians)
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: has angles, but the network takes raw counts; give --units raw "
                             "if the numbers have the unit that the network was trained with",
                             path)};
  auto recording = readRecording(path, raw ? nn::InputUnit::kRaw : unit);
  if (!recording || recording->unit == network.unit) return recording;
  return toRadians(*std::move(recording), path);
}

nn::Recording synthesize(const SyntheticPeople& people) {
  hand::RecordingSettings settings;
  settings.first_person = people.first;
  settings.people = people.people;
  settings.takes = people.takes;
  settings.per_take = people.per_take;
  const auto shapes = hand::allShapes().first(std::min(people.postures, hand::allShapes().size()));
  nn::Recording recording;
  recording.synthetic = true;
  recording.measured.fill(true);
  for (const hand::Shot& shot : hand::record(shapes, settings, people.seed))
    recording.hands.push_back({shot.shape, shot.angle_rad});
  return recording;
}

void addPosture(Command app, Run& run) {
  Command posture = app.subcommand(
      "posture", "The posture network: collect labelled hands, train, test, adapt, synthesize.");
  posture.requireSubcommand();
  addPostureCollect(posture, run);
  addPostureTrain(posture, run);
  addPostureTest(posture, run);
  addPostureAdapt(posture, run);
  addPostureSynthesize(posture, run);
}

}  // namespace merlin::cli
