// Data sets: hands with the posture that each shows, for training and for test.
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

// Training example: a hand as the network sees it, and the code that it should answer.
struct Example {
  Input x{};
  std::uint32_t code = 0;
};

// Errors: kInvalidArgument: a posture that the network's table does not name, an angle that is not
// finite.
Result<std::vector<Example>> toExamples(std::span<const LabelledHand> hands,
                                        const PostureNetwork& network);

struct Score {
  std::size_t total = 0;
  std::size_t right = 0;
  std::size_t rejected = 0;  // no posture at all; total - right - rejected were taken for another

  double accuracy() const noexcept {
    return total == 0 ? 0.0 : static_cast<double>(right) / static_cast<double>(total);
  }
};

// Recognises every hand, and compares names.
Score score(const PostureNetwork& network, std::span<const LabelledHand> hands);

}  // namespace merlin::nn
