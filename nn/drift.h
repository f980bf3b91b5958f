// DriftFollower: recognises postures while a glove's sensors drift, without labels. Pure.
//
// Where the network is sure of a posture, the hand's deviation from that posture's mean is the sum
// of the hand's own deviation and the glove's drift. The drift is the same for all postures, the
// own deviation is not, so the mean over many different postures is an estimate of the drift. The
// estimate is subtracted from each hand before recognition.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "nn/postures.h"
#include "nn/settings.h"
#include "nn/space.h"

namespace merlin::nn {

// A network with the statistics of its training hands. If the statistics are empty, drift is not
// followed.
struct TrainedPostures {
  PostureNetwork network;
  PostureStatistics statistics;
};

// Thread-bound: each recognition may change the estimate of the drift.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): there is one of it
class DriftFollower {
 public:
  // `statistics`: statistics of the network's training hands. Postures that the network does not
  // have are ignored.
  DriftFollower(const PostureNetwork& network, const PostureStatistics& statistics,
                const DriftSettings& settings);

  // Subtracts the estimated drift from a hand, recognises the hand as Recogniser does, and learns
  // from it if the margin is large enough. Allocation-free; takes about 0.1 us longer than
  // Recogniser.
  Recognition operator()(const Angles& value) noexcept;

  std::string_view name(std::uint32_t code) const noexcept { return recognise_.name(code); }

  // Sets the estimated drift to 0, as is needed for another glove or another person.
  void reset() noexcept;

  // Returns the estimated drift of each input as a share of the sensor's range, within
  // +-DriftSettings::most.
  const Input& offset() const noexcept { return offset_; }

 private:
  void learn(std::uint32_t code, const Input& hand) noexcept;
  void endVisit() noexcept;

  DriftSettings settings_;
  Recogniser recognise_;
  InputRanges ranges_;
  std::array<Input, kCodes> mean_{};
  std::array<bool, kCodes> known_{};
  Input offset_{}, away_{};  // `away_`: sum of the visit's deviations from the mean
  float hands_ = 0;          // hands in the present visit, a run of sure hands of one posture
  std::uint32_t visited_ = kNone;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

}  // namespace merlin::nn
