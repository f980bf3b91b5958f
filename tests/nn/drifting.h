// A synthetic person whose glove drifts during a session, as real gloves do: each sensor's offset
// and gain walk at random. Shared by the tests of nn and a benchmark.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "drivers/hand/recording.h"
#include "nn/data_set.h"

namespace merlin::nn::test {

// Standard deviations of the drift after a whole session. The drift makes a step before each take
// of a posture; of N steps in a session, each has 1 / sqrt(N) of these deviations.
struct SessionSettings {
  double offset = 0.18;     // of a sensor's zero, as a share of its range of angles
  double gain = 0.18;       // of the factor by which a sensor's angles are multiplied
  std::size_t rounds = 30;  // rounds of the session; in each the person takes every posture once
  std::size_t per_take = 5;
};

struct Session {
  DataSet first, second;  // the earlier and the later half, both in chronological order
};

// Returns a session in which the person takes every posture once in each round, in random order.
inline Session drifting(std::span<const hand::Shape> shapes, std::uint64_t person,
                        const SessionSettings& drift) {
  const hand::Person hand(person);
  Random random(person * 7919 + 5), walk(person * 104729 + 3);
  std::array<double, kInputs> offset{}, gain{};
  const double step = 1 / std::sqrt(static_cast<double>(drift.rounds * shapes.size()));
  std::vector<std::size_t> order(shapes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  Session session;
  for (std::size_t round = 0; round < drift.rounds; ++round) {
    for (std::size_t i = order.size() - 1; i > 0; --i)
      std::swap(order[i], order[random.below(i + 1)]);
    for (const std::size_t k : order) {
      for (std::size_t i = 0; i < kInputs; ++i) {
        offset[i] += step * drift.offset * walk.normal();
        gain[i] += step * drift.gain * walk.normal();
      }
      const hand::Angles joints = hand.take(shapes[k], random);
      for (std::size_t n = 0; n < drift.per_take; ++n) {
        LabelledHand shown{shapes[k].name, hand.sense(joints, random)};
        for (std::size_t i = 0; i < kInputs; ++i) {
          const auto [low, high, count] = hand::kJointSpans[i];
          shown.value[i] = static_cast<float>((1 + gain[i]) * static_cast<double>(shown.value[i]) +
                                              offset[i] * static_cast<double>(high - low));
        }
        shown.value[7] = 0;  // no glove measures the abduction of the index finger
        (2 * round < drift.rounds ? session.first : session.second).push_back(shown);
      }
    }
  }
  return session;
}

}  // namespace merlin::nn::test
