// The network that MERLIN ships: synthetic hands, training, names, in one call. Pure, seeded.
#pragma once

#include <cstdint>
#include <span>

#include "daemon/base/result.h"
#include "nn/postures.h"
#include "nn/synthetic.h"
#include "nn/train.h"

namespace merlin::nn {

inline constexpr std::uint64_t kShippedSeed = 1998;  // of config/postures.json

struct TrainedNetwork {
  PostureNetwork network;
  Provenance trained;
  TrainReport report;
};

// Makes hands of `shapes` (the n-th gets evenCode(n)), and trains a sigmoid network on them.
//
// The weights are rounded to 1e-4: e^t differs in its last bit between processors, and the rounding
// keeps that out of the file. One seed and one list of shapes give one file, byte for byte; with
// kShippedSeed and the shapes of drivers/hand it is config/postures.json.
//
// errors     kInvalidArgument: more than kEvenCodes shapes, a name that is none or comes twice, an
//            angle that is not finite, no shapes.
// cost       about 2.5 s on one core for the eight shipped shapes.
Result<TrainedNetwork> trainShipped(std::span<const HandShape> shapes, std::uint64_t seed,
                                    const Progress& progress = {});

}  // namespace merlin::nn
