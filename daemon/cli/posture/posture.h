// The subcommands of `merlin posture`: functions that add them, and shared helpers.
#pragma once

#include <optional>
#include <string>

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

// The unit with the name "raw" or "rad"; nothing for "auto", which lets the reader decide.
std::optional<nn::InputUnit> unitNamed(const std::string& name);
// Adds the option --units.
void addUnits(Command command, std::string& units);

// Reads a recording of labelled hands and prints the reader's notes to stderr. `unit`: of the
// numbers; nothing: the reader decides by their size. Errors: those of nn::loadRecording().
Result<nn::Recording> readRecording(const std::string& path, std::optional<nn::InputUnit> unit);

// Reads a recording in the input unit of the network. If the network takes angles, raw counts are
// converted with the shipped calibration. Errors: those of readRecording(); kInvalidArgument if
// `unit` is radians and the network takes raw counts, or if a raw count is not from 0 to 255.
Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              std::optional<nn::InputUnit> unit);

// Settings of synthesize(): `people` synthetic people, numbered from `first`. Each of them takes
// each of the first `postures` of hand::allShapes() `takes` times, with `per_take` samples each.
struct SyntheticPeople {
  std::size_t first = 1, people = 10, takes = 1, per_take = 5, postures = 31;
  std::uint64_t seed = 1;
};
nn::Recording synthesize(const SyntheticPeople& people);

}  // namespace merlin::cli
