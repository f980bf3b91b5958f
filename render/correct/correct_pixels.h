// Evaluates the formula of correction_map.h on the CPU.
#pragma once

#include <cstdint>

#include "render/correct/correction_map.h"

namespace merlin::render::correct {

// Computes rows first .. last - 1 of the output. `picture`: RGBA of the uncorrected picture,
// without padding, of the map's source size; `signal`: RGBA of the whole output, of the map's size.
using CorrectRows = void (*)(const CorrectionMap& map, const std::uint8_t* picture,
                             std::uint8_t* signal, int first, int last);

// Returns the fastest implementation for this CPU. All implementations give the same bits.
CorrectRows rowCorrector();

// Returns the implementation that runs on any CPU, for tests.
CorrectRows portableRowCorrector();

}  // namespace merlin::render::correct
