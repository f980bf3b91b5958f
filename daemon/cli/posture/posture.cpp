#include "daemon/cli/posture/posture.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
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

void addForm(Command command, RecordingForm& form) {
  command
      .option("--units", form.units,
              "Unit of the recording: rad (radians), raw (counts, degrees or any other unit of the "
              "sensors), or auto (raw if the absolute value of any number is above 6.3)")
      .oneOf({"auto", "rad", "raw"})
      .showDefault();
  command
      .option("--columns", form.columns,
              "What is in which column of the CSV, where its header does not say it: posture, for "
              "the label, and sensors by joint or slot, each with the column's name or its number "
              "from 1. If any sensor is named, all columns that are not named are left out: "
              "--columns posture=class,thumb-roll=3,index-mcp=IndexKnuckle")
      .typeName("WHAT=COLUMN,...")
      .repeatable()
      .separated(',');
}

Result<nn::Recording> readRecording(const std::string& path, const RecordingForm& form) {
  std::vector<nn::ChosenColumn> columns;
  for (const std::string& text : form.columns) {
    const std::size_t at = text.find('=');
    if (at == std::string::npos)
      return Error{Errc::kInvalidArgument,
                   fmt::format("--columns: \"{}\" is not WHAT=COLUMN, such as posture=class",
                               excerpt(text))};
    columns.push_back({text.substr(0, at), text.substr(at + 1)});
  }
  auto recording = nn::loadRecording(path, unitNamed(form.units), columns);
  if (!recording) return recording;
  for (const std::string& note : recording->notes) printError("{}: {}\n", path, note);
  return recording;
}

Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              RecordingForm form) {
  const bool raw = network.unit == nn::InputUnit::kRaw;
  if (raw && form.units == "rad")
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: has angles, but the network takes raw counts; give --units raw "
                             "if the numbers have the unit that the network was trained with",
                             path)};
  if (raw) form.units = "raw";
  auto recording = readRecording(path, form);
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
