// Hand: a glove and a tracker as one thing: joints by name, and a pose that is smooth and can be
// had for another moment. Pure.
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
// The slot of that name, or nothing.
std::optional<std::size_t> jointNamed(std::string_view name);

// Smooths with a low-pass whose cut-off rises with the hand's speed, so that a hand at rest does
// not tremble and a quick one is not late: G. Casiez et al., "1 Euro Filter: A Simple Speed-based
// Low-pass Filter for Noisy Input in Interactive Systems", CHI 2012. The delay that it adds is that
// of a first-order low-pass, 1 / (2 pi cut-off), and stands in every sample. Thread-bound.
class Hand {
 public:
  explicit Hand(const HandSettings& settings) : settings_(settings) {}

  // A record of the hand's station, with the newest of the glove, if there is one that is not older
  // than half a second.
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

// Where the hand will be, or was, at `when`, if it goes on as it does; no further than 0.1 s from
// the sample, since hands do not go on for long.
Pose poseAt(const HandSample& hand, Timestamp when);

}  // namespace merlin::hand
