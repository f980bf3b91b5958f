// The subcommands of `merlin gesture`: functions that add them, and shared helpers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"
#include "nn/gesture/path_recording.h"

namespace merlin::cli {

void addGestureRecord(Command gesture, Run& run);
void addGestureTrain(Command gesture, Run& run);
void addGestureTest(Command gesture, Run& run);
void addGestureSynthesize(Command gesture, Run& run);

// Synthetic people, numbered from `first`: each makes every ready gesture `times` times, then moves
// without a gesture for `ordinary_s`, then performs each kind of ordinary motion alone for
// `kind_s`.
struct SyntheticMovers {
  std::size_t first = 1, people = 20, times = 5;
  double ordinary_s = 600, kind_s = 0;
  std::uint64_t seed = 1;
};

// Returns the labelled poses of the hand of the synthetic person with the number `person`. Memory:
// about 4 MB for ten minutes.
nn::PathRecording recordingOf(const SyntheticMovers& movers, std::size_t person);

// Returns the labelled strokes of all people of `movers`. `lost`: set to the number of takes
// without a stroke.
std::vector<nn::LabelledStroke> strokesOf(const SyntheticMovers& movers, std::size_t& lost);

// Time after a gesture in which strokes count neither as the gesture nor as ordinary motion [s].
inline constexpr double kAfterTake_s = 0.8;

}  // namespace merlin::cli
