#include "nn/drift.h"

#include <algorithm>

namespace merlin::nn {
namespace {

// Limit of one visit's mean deviation, as a share of a sensor's range (which is 6 standard
// deviations over all postures). A larger deviation from a posture's mean is not drift, but another
// posture that was mistaken for this one.
constexpr float kFurthest = 0.15F;
// Greatest number of hands used of one visit; further ones add no information.
constexpr float kMostHands = 1e4F;

}  // namespace

DriftFollower::DriftFollower(const PostureNetwork& network, const PostureStatistics& statistics,
                             const DriftSettings& settings)
    : settings_(settings), recognise_(network), ranges_(network.ranges) {
  for (std::size_t k = 0; k < statistics.postures.size(); ++k) {
    const auto code = network.postures.code(statistics.postures[k]);
    if (!code) continue;
    mean_[*code] = statistics.mean[k];
    known_[*code] = true;
  }
}

Recognition DriftFollower::operator()(const Angles& value) noexcept {
  Angles still = value;
  for (std::size_t i = 0; i < kInputs; ++i)
    still[i] -= offset_[i] * (ranges_[i].high - ranges_[i].low);
  const Recognition seen = recognise_(still);
  const auto least = static_cast<float>(settings_.least_margin);
  if (settings_.share > 0 && seen.margin >= least && known_[seen.code])
    learn(seen.code, normalise(ranges_, still));
  return seen;
}

// A posture that is held for long counts as one visit, however many hands it has. Otherwise the way
// in which the person happens to hold it would be taken for drift.
void DriftFollower::learn(std::uint32_t code, const Input& hand) noexcept {
  if (code != visited_) {
    endVisit();
    visited_ = code;
  }
  if (hands_ >= kMostHands) return;
  for (std::size_t i = 0; i < kInputs; ++i) away_[i] += hand[i] - mean_[code][i];
  ++hands_;
}

void DriftFollower::endVisit() noexcept {
  const auto share = static_cast<float>(settings_.share), most = static_cast<float>(settings_.most);
  const bool counts = hands_ > 0 && hands_ >= static_cast<float>(settings_.least_hands);
  for (std::size_t i = 0; i < kInputs && counts; ++i) {
    const float away = std::clamp(away_[i] / hands_, -kFurthest, kFurthest);
    offset_[i] = std::clamp(offset_[i] + share * away, -most, most);
  }
  away_ = {};
  hands_ = 0;
}

void DriftFollower::reset() noexcept {
  offset_ = away_ = {};
  hands_ = 0;
}

}  // namespace merlin::nn
