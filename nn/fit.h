// Training that generalises: from labelled hands to a posture network, with every choice made from
// the hands. Pure: one seed and one set of hands give one network, byte for byte, on every machine.
//
// Steps, in order, and the data that each choice is based on: README.md, "Training".
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
  std::size_t starts = 20;        // assignments of codes with weights to start from, >= 1
  std::size_t passes = 480;       // of the best of them, at most, >= 1
  double validation_share = 0.1;  // of each posture's hands, its last ones; [0, 0.5]
};

// One line of the learning curve.
struct CurvePoint {
  std::size_t pass;   // of all starts together, counted from 1
  double training;    // mean squared error, with noise
  double validation;  // without; NaN where nothing is set aside
  double noise;       // standard deviations of a posture's hands
};

// Where a network's weights come from, as its file says it.
struct Provenance {
  std::string how;  // for a person, one line
  std::uint64_t seed = 0;
  std::size_t samples = 0;
  double mse = 0.0;
  bool synthetic = false;  // trained on hands that nobody had
};

struct Fitted {
  PostureNetwork network;
  Memory memory;
  Provenance trained;
  std::vector<CurvePoint> curve;
  double training_accuracy = 0, validation_accuracy = 0;  // of the network that is returned
};

// Called after each pass with the share of the work that is done; false stops: what has been
// reached is returned.
using FitProgress = std::function<bool(double share, const CurvePoint& point)>;

// errors     kInvalidArgument: phi is signum, fewer than 2 or more than 32 postures, a name that is
//            none, a value that is not finite, no slot that ever changes, settings out of range.
// cost       1 to 2 s on one core for 31 postures; hardly more for more hands.
Result<Fitted> fit(std::span<const LabelledHand> hands, const FitSettings& settings,
                   const FitProgress& progress = {});

// Names of the postures in order of appearance, and each hand's index into them.
std::vector<std::string> posturesOf(std::span<const LabelledHand> hands,
                                    std::vector<std::size_t>& posture);

}  // namespace merlin::nn
