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
  std::size_t starts = 20;        // random starts (codes and weights), >= 1
  std::size_t passes = 480;       // maximum number of passes with the best start, >= 1
  double validation_share = 0.1;  // share of each posture's hands, its last ones; [0, 0.5]
  // Once the noise has settled, training goes on to its final passes as soon as the mean squared
  // error of a pass is below this limit; >= 0. With 0, the limit has no effect.
  double mse_limit = 0;
};

// One line of the learning curve.
struct CurvePoint {
  std::size_t pass;  // counted from 1 over all starts together
  double training;   // mean squared error of the training hands, with noise
  // Mean squared error of the validation hands, without noise; computed in every fourth pass, NaN
  // in the others and if there are no validation hands.
  double validation;
  double noise;  // in standard deviations of a posture's hands
};

// The origin of a network's weights, as stored in its file.
struct Provenance {
  std::string how;  // description for people, one line
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
  double training_accuracy = 0, validation_accuracy = 0;  // of the returned network, 0..1
};

// Called after each pass with the finished share of the work. If it returns false, fit() stops and
// returns the network that it has reached.
using FitProgress = std::function<bool(double share, const CurvePoint& point)>;

// errors     kInvalidArgument: phi is signum, fewer than 2 or more than 32 postures, an invalid
//            name, a value that is not finite, all slots constant, settings out of range.
// cost       1 to 2 s on one core for 31 postures; depends little on the number of hands.
Result<Fitted> fit(std::span<const LabelledHand> hands, const FitSettings& settings,
                   const FitProgress& progress = {});

// Returns the names of the postures in order of first appearance. `posture` is set to the index of
// each hand's posture in this list.
std::vector<std::string> posturesOf(std::span<const LabelledHand> hands,
                                    std::vector<std::size_t>& posture);

}  // namespace merlin::nn
