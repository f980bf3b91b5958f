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

// Poses in the order of time. Where the time goes back, or stands still for more than half a
// second, another session begins.
struct PathRecording {
  std::vector<std::string> labels;  // names of gestures, and kNoGesture
  std::vector<LabelledPose> poses;
  bool synthetic = false;

  // Index of the label, which is added if it is not there.
  std::uint32_t labelled(std::string_view name);
};

// Consecutive poses of one session.
std::vector<std::span<const LabelledPose>> sessionsOf(const PathRecording& recording);

// A take: consecutive poses of a session that have the label of one gesture.
struct Take {
  std::uint32_t label;
  std::int64_t first_ns, last_ns;
};
std::vector<Take> takesOf(std::span<const LabelledPose> session, const PathRecording& recording);

// Of each take the greatest stroke, by length and speed; and all strokes outside of the takes, as
// kNoGesture, unless they begin less than `after_take_s` after one: the way back is not ordinary
// motion. `lost`: set to the number of takes in which there is no stroke.
std::vector<LabelledStroke> strokesOf(const PathRecording& recording, double after_take_s,
                                      std::size_t& lost);

// Whether the one take of a gesture in `take` has a stroke, without which training leaves it out.
// Errors: kInvalidArgument: how little the hand moved in it, and what to do.
Result<Ok> checkTake(const PathRecording& take);

}  // namespace merlin::nn
