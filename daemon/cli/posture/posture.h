// The subcommands of `merlin posture`: functions that add them, and shared helpers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"
#include "nn/io/data_set_file.h"
#include "nn/io/network_file.h"

namespace merlin::cli {

void addPostureTrain(Command posture, Run& run);
void addPostureTest(Command posture, Run& run);
void addPostureAdapt(Command posture, Run& run);
void addPostureCollect(Command posture, Run& run);
void addPostureSynthesize(Command posture, Run& run);

// Returns the unit with the name "raw" or "rad"; nothing for "auto", with which the reader of the
// recording chooses the unit.
std::optional<nn::InputUnit> unitNamed(const std::string& name);

// Command-line options about how a recording is read.
struct RecordingForm {
  std::string units = "auto";        // "raw", "rad" or "auto" (unitNamed())
  std::vector<std::string> columns;  // "WHAT=COLUMN": see nn::ChosenColumn
};
// Adds the options --units and --columns, which set `form`.
void addForm(Command command, RecordingForm& form);

// Reads a recording of labelled hands and prints the reader's notes to stderr. Errors: those of
// nn::loadRecording(); kInvalidArgument (a column is not WHAT=COLUMN).
Result<nn::Recording> readRecording(const std::string& path, const RecordingForm& form);

// Reads a recording in the input unit of the network. Raw counts are converted to angles with the
// shipped calibration if the network takes angles. Errors: those of readRecording();
// kInvalidArgument (the given unit is radians and the network takes raw counts, or a raw count to
// convert is not from 0 to 255).
Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              RecordingForm form);

// Settings of synthesize(): `people` synthetic people, numbered from `first`. Each of them takes
// each of the first `postures` of hand::allShapes() `takes` times, with `per_take` samples each.
struct SyntheticPeople {
  std::size_t first = 1, people = 10, takes = 1, per_take = 5, postures = 31;
  std::uint64_t seed = 1;
};
nn::Recording synthesize(const SyntheticPeople& people);

}  // namespace merlin::cli
