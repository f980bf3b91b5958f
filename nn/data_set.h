// Data sets for training and test: hands, each with the posture that it shows.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "nn/postures.h"

namespace merlin::nn {

struct LabelledHand {
  std::string posture;
  Angles value{};
};
using DataSet = std::vector<LabelledHand>;

// A training example: a hand's scaled inputs and the code that the network should return.
struct Example {
  Input x{};
  std::uint32_t code = 0;
};

// Converts labelled hands into training examples: scales the values by the network's ranges and
// looks up each posture's code. Errors: kInvalidArgument if the network's table lacks a posture or
// a value is not finite.
Result<std::vector<Example>> toExamples(std::span<const LabelledHand> hands,
                                        const PostureNetwork& network);

struct Score {
  std::size_t total = 0;
  std::size_t right = 0;
  // Hands that were recognised as no posture. The remaining hands were taken for a wrong posture.
  std::size_t rejected = 0;

  double accuracy() const noexcept {
    return total == 0 ? 0.0 : static_cast<double>(right) / static_cast<double>(total);
  }
};

// Recognises every hand with `network` and compares the result with the hand's label.
Score score(const PostureNetwork& network, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
