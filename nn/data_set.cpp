#include "nn/data_set.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::nn {

Result<std::vector<Example>> toExamples(std::span<const LabelledHand> hands,
                                        const PostureNetwork& network) {
  std::vector<Example> examples;
  examples.reserve(hands.size());
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const LabelledHand& hand = hands[h];
    const auto code = network.postures.code(hand.posture);
    if (!code) {
      return Error{
          Errc::kInvalidArgument,
          fmt::format(
              "example {} (counted from 0) shows \"{}\", which has no code among the {} postures",
              h, hand.posture, network.postures.size())};
    }
    for (std::size_t i = 0; i < kInputs; ++i) {
      if (std::isfinite(hand.value[i])) continue;
      return Error{Errc::kInvalidArgument,
                   fmt::format("hand {}: the angle of {} is {}; allowed: a finite number", h,
                               kInputNames[i], hand.value[i])};
    }
    examples.push_back({normalise(network.ranges, hand.value), *code});
  }
  return examples;
}

Score score(const PostureNetwork& network, std::span<const LabelledHand> hands) {
  const Recogniser recognise(network);
  Score s;
  for (const LabelledHand& hand : hands) {
    const auto name = recognise(hand.value).name;
    ++s.total;
    if (name.empty()) {
      ++s.rejected;
    } else if (name == hand.posture) {
      ++s.right;
    }
  }
  return s;
}

}  // namespace merlin::nn
