// PathRecording: poses of hands with labels, and the labelled strokes in them. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "nn/gesture/pose.h"
#include "nn/gesture/training.h"

namespace merlin::nn {

struct LabelledPose {
  std::uint32_t label = 0;  // index into PathRecording::labels
  HandPose pose;
};

// Labelled poses, in order of time within a session. A new session begins where the time goes back,
// or where two poses are more than half a second apart.
struct PathRecording {
  std::vector<std::string> labels;  // names of gestures, and kNoGesture
  std::vector<LabelledPose> poses;
  bool synthetic = false;

  // Returns the index of the label, which is added if it is missing.
  std::uint32_t labelled(std::string_view name);
};

// Returns the sessions of a recording, each as its consecutive poses; valid as long as the
// recording does not change.
std::vector<std::span<const LabelledPose>> sessionsOf(const PathRecording& recording);

// A take: consecutive poses of a session that all have the label of one gesture.
struct Take {
  std::uint32_t label;
  std::int64_t first_ns, last_ns;
};
// Returns the takes of a session, in order of time.
std::vector<Take> takesOf(std::span<const LabelledPose> session, const PathRecording& recording);

// Returns the greatest stroke of each take (by length times greatest speed), labelled with the
// take's gesture, and all strokes outside of the takes, labelled kNoGesture. Strokes that begin
// less than `after_take_s` after a take are left out, since the hand's way back is not ordinary
// motion. A stroke belongs to a take that covers at least half of its duration. `lost` is set to
// the number of takes without a stroke.
std::vector<LabelledStroke> strokesOf(const PathRecording& recording, double after_take_s,
                                      std::size_t& lost);

// Checks that `take`, a recording of one take of a gesture, contains a stroke; training leaves out
// takes without one. Errors: kInvalidArgument if there is no stroke; the message says how far and
// how fast the hand moved, and what to do.
Result<Ok> checkTake(const PathRecording& take);

}  // namespace merlin::nn
