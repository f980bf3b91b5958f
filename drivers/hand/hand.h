// Hand: combines the samples of a glove and a tracker into named joints and a smoothed pose, which
// can be extrapolated to another moment. Pure.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/hand/settings.h"
#include "drivers/port/samples.h"

namespace merlin::hand {

// Names of slots 0 to 22: "thumb_roll", "thumb_mcp", ... "wrist_yaw".
extern const std::array<std::string_view, kGloveSlots> kJointNames;
// Returns the slot with this joint name; nothing if there is none.
std::optional<std::size_t> jointNamed(std::string_view name);

// Smooths with a low-pass filter whose cut-off rises with the hand's speed, so that a hand at rest
// does not tremble and a fast one has little delay: G. Casiez et al., "1 Euro Filter: A Simple
// Speed-based Low-pass Filter for Noisy Input in Interactive Systems", CHI 2012. It delays the pose
// by 1 / (2 pi cut-off), like any first-order low-pass; each sample states this delay.
// Thread-bound.
class Hand {
 public:
  explicit Hand(const HandSettings& settings) : settings_(settings) {}

  // Processes a record of the tracker's station on the hand, and returns the hand. `glove`: the
  // glove's newest record, which is used if it is less than half a second old.
  HandSample update(const TrackerSample& tracker, const std::optional<GloveSample>& glove);

 private:
  void start(const TrackerSample& tracker);
  void follow(const TrackerSample& tracker, float dt_s);

  HandSettings settings_;
  HandSample hand_{};
  bool started_ = false;
};

struct Pose {
  std::array<float, 3> position_m;
  std::array<float, 4> orientation_wxyz;
};

// Returns the pose of the hand at `when`, extrapolated with the velocities of the sample; the delay
// of the smoothing is compensated. The extrapolation covers at most 0.1 s, because a hand does not
// keep its velocity for long.
Pose poseAt(const HandSample& hand, Timestamp when);

}  // namespace merlin::hand
