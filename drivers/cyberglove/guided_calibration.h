// A person's own calibration of a glove, from a few poses that are held one after the other. Pure.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/port/guided_step.h"
#include "drivers/port/samples.h"

namespace merlin::cyberglove {

std::span<const GuidedStep> guidedPoses();

// Statistics of each sensor while a pose is held, and over all poses.
class GuidedCalibration {
 public:
  void begin(std::size_t pose);  // what comes from now on belongs to it; again: anew
  void add(const GloveSample& sample);

  // Records of the pose under way; smallest and largest raw value of a slot so far, 0 for none.
  int count() const noexcept { return poses_[pose_].count; }
  std::uint8_t low(std::size_t slot) const noexcept { return low_[slot]; }
  std::uint8_t high(std::size_t slot) const noexcept { return high_[slot]; }

  // Offsets and gains. Slots that the glove has no sensor for keep those of `settings`.
  // Errors: kMalformed, with every sensor that moved by too little, and poses without records.
  Result<CybergloveSettings> solve(const CybergloveSettings& settings) const;

 private:
  struct Pose {
    int count = 0;
    std::array<double, kGloveSlots> sum{};
  };
  std::vector<Pose> poses_ = std::vector<Pose>(guidedPoses().size());
  std::size_t pose_ = 0;
  std::array<std::uint8_t, kGloveSlots> low_{}, high_{};
};

}  // namespace merlin::cyberglove
