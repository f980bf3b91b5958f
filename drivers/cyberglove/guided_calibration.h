// Calibrates a glove for one person, from a few poses that the person holds one after the other.
// Pure.
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

// Returns the poses that the person has to hold, in this order.
std::span<const GuidedStep> guidedPoses();

// Statistics of each sensor while a pose is held, and over all poses.
class GuidedCalibration {
 public:
  void begin(std::size_t pose);  // starts or restarts a pose; later samples belong to it
  void add(const GloveSample& sample);

  // count(): number of records in the current pose. low(), high(): smallest and largest raw value
  // of a slot in all poses so far; 0 if there is none.
  int count() const noexcept { return poses_[pose_].count; }
  std::uint8_t low(std::size_t slot) const noexcept { return low_[slot]; }
  std::uint8_t high(std::size_t slot) const noexcept { return high_[slot]; }

  // Returns `settings` with new offsets and gains; slots without a sensor keep theirs. Errors:
  // kMalformed, naming a pose without records, or every sensor that moved too little.
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
