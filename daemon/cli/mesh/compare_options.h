// The command-line options of a comparison of surfaces.
#pragma once

#include "daemon/cli/arguments.h"
#include "render/compare/compare.h"

namespace merlin::cli {

// Adds the options --samples, --seed, --width and --threads.
void addCompareOptions(Command command, render::compare::CompareSettings& settings);

}  // namespace merlin::cli
