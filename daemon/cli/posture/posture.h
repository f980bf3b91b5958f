// merlin posture ...: functions that add its subcommands, and shared helpers.
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

// The unit named "raw" or "rad"; nothing for "auto".
std::optional<nn::InputUnit> unitNamed(const std::string& name);
// Adds the option --units.
void addUnits(Command command, std::string& units);

// Reads a recording and prints its notes to stderr.
Result<nn::Recording> readRecording(const std::string& path, std::optional<nn::InputUnit> unit);

// Reads a recording in the network's unit; raw counts for a network of angles are converted with
// the shipped calibration. Errors: those of readRecording(); kInvalidArgument if the recording has
// angles and the network takes raw counts.
Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              std::optional<nn::InputUnit> unit);

// Settings of synthesize(): `people` synthetic people from number `first` on, each of whom holds
// the first `postures` of hand::allShapes().
struct SyntheticPeople {
  std::size_t first = 1, people = 10, takes = 1, per_take = 5, postures = 31;
  std::uint64_t seed = 1;
};
nn::Recording synthesize(const SyntheticPeople& people);

}  // namespace merlin::cli
