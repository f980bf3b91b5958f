// Trains a posture network that generalises, and makes every choice from the labelled hands. Pure:
// one seed and one set of hands give the same network, byte for byte, on every machine.
//
// README.md, "Training", lists the steps and the data on which each choice is based.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "nn/data_set.h"
#include "nn/space.h"

namespace merlin::nn {

struct FitSettings {
  Phi phi = Phi::kSigmoid;  // not signum
  InputUnit unit = InputUnit::kRadians;
  std::uint64_t seed = 1998;
  std::size_t starts = 20;        // random assignments of codes with initial weights, >= 1
  std::size_t passes = 480;       // maximum number of passes with the best start, >= 1
  double validation_share = 0.1;  // share of each posture's hands, from the end; [0, 0.5]
  // Training goes on to the final passes once the mean squared error of a pass is below this, but
  // not before the noise has settled; >= 0, and 0 never ends it.
  double mse_limit = 0;
};

// One line of the learning curve.
struct CurvePoint {
  std::size_t pass;   // counted from 1 over all starts together
  double training;    // mean squared error, with noise
  double validation;  // without noise; NaN if no hands are set aside
  double noise;       // in standard deviations of a posture's hands
};

// The origin of a network's weights, as stored in its file.
struct Provenance {
  std::string how;  // one line for people
  std::uint64_t seed = 0;
  std::size_t samples = 0;
  double mse = 0.0;
  bool synthetic = false;  // trained on generated hands, not on recorded ones
};

struct Fitted {
  PostureNetwork network;
  PostureStatistics statistics;
  Provenance trained;
  std::vector<CurvePoint> curve;
  double training_accuracy = 0, validation_accuracy = 0;  // accuracies of the returned network
};

// Called after each pass with the finished share of the work. If it returns false, fit() stops and
// returns the network that it has reached.
using FitProgress = std::function<bool(double share, const CurvePoint& point)>;

// errors     kInvalidArgument: phi is signum, fewer than 2 or more than 32 postures, an invalid
//            name, a value that is not finite, no slot that ever changes, settings out of range.
// cost       1 to 2 s on one core for 31 postures; hardly more for more hands.
Result<Fitted> fit(std::span<const LabelledHand> hands, const FitSettings& settings,
                   const FitProgress& progress = {});

// The names of the postures in order of appearance, and each hand's index into them.
std::vector<std::string> posturesOf(std::span<const LabelledHand> hands,
                                    std::vector<std::size_t>& posture);

}  // namespace merlin::nn
