// DriftFollower: recognises postures while a glove's sensors drift, without labels. Pure.
//
// While the network is sure of a posture, the hand's distance from that posture's mean is partly
// the hand's own and partly the glove's drift. The drift is common to all postures, the rest is
// not, so the mean over many different postures is the drift; it is subtracted before recognition.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "nn/postures.h"
#include "nn/settings.h"
#include "nn/space.h"

namespace merlin::nn {

// A network with the statistics of its training, without which no drift is followed.
struct TrainedPostures {
  PostureNetwork network;
  PostureStatistics statistics;
};

// Thread-bound: it learns from what it recognises.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): there is one of it
class DriftFollower {
 public:
  // `statistics`: of the network's training; a posture that the network does not name is ignored.
  DriftFollower(const PostureNetwork& network, const PostureStatistics& statistics,
                const DriftSettings& settings);

  // Recognises a hand, as Recogniser does, after the drift so far was subtracted. Allocation-free;
  // about 0.1 us more than Recogniser.
  Recognition operator()(const Angles& value) noexcept;

  std::string_view name(std::uint32_t code) const noexcept { return recognise_.name(code); }

  // Forgets the drift: for another glove or another person.
  void reset() noexcept;

  // The drift so far, in scaled inputs (the range of a sensor is 1); at most settings.most each.
  const Input& offset() const noexcept { return offset_; }

 private:
  void learn(std::uint32_t code, const Input& hand) noexcept;
  void endVisit() noexcept;

  DriftSettings settings_;
  Recogniser recognise_;
  InputRanges ranges_;
  std::array<Input, kCodes> mean_{};
  std::array<bool, kCodes> known_{};
  Input offset_{}, away_{};  // `away_`: sum over the visit's hands of the distance from the mean
  float hands_ = 0;          // of the visit: a run of sure hands of one posture
  std::uint32_t visited_ = kNone;

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
};

}  // namespace merlin::nn
