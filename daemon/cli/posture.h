// merlin posture ...: how each of its subcommands adds itself, and what they share.
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

// "auto", "raw" or "rad" to a unit; nothing for "auto".
std::optional<nn::InputUnit> unitNamed(const std::string& name);
void addUnits(Command command, std::string& units);

// A recording, its notes printed to stderr.
Result<nn::Recording> readRecording(const std::string& path, std::optional<nn::InputUnit> unit);

// A recording in the network's unit: as it stands, or raw counts made angles by the shipped
// calibration. Errors: those of reading; kInvalidArgument: angles for a network of raw counts.
Result<nn::Recording> readFor(const nn::PostureNetwork& network, const std::string& path,
                              std::optional<nn::InputUnit> unit);

// Synthetic people who hold the first `postures` of hand::allShapes(), from person `first` on.
struct SyntheticPeople {
  std::size_t first = 1, people = 10, takes = 1, per_take = 5, postures = 31;
  std::uint64_t seed = 1;
};
nn::Recording synthesize(const SyntheticPeople& people);

}  // namespace merlin::cli
