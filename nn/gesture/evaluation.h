// Evaluation of a gesture model on a recording, played as if it were live. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "nn/gesture/follower.h"
#include "nn/gesture/path_recording.h"

namespace merlin::nn {

struct GestureScore {
  std::size_t takes = 0;
  std::size_t right = 0;     // exactly one gesture was reported, the right one
  std::size_t missed = 0;    // no gesture was reported
  std::size_t wrong = 0;     // exactly one was reported, but another one
  std::size_t repeated = 0;  // several gestures were reported
  double rate() const {
    return takes > 0 ? static_cast<double>(right) / static_cast<double>(takes) : 0;
  }
};

struct GestureEvaluation {
  GestureScore all;
  std::map<std::string, GestureScore> of;  // by the gesture that was meant
  // How often the first gesture that was reported in a take of [meant] was [reported]; "" for none.
  std::map<std::string, std::map<std::string, std::size_t>> confusion;
  std::size_t invented = 0;                       // reported where nobody meant any
  std::map<std::string, std::size_t> inventions;  // the same, by reported gesture
  double ordinary_s = 0;                          // time in which nobody meant any
  double inventedPerTenMinutes() const {
    return ordinary_s > 0 ? 600 * static_cast<double>(invented) / ordinary_s : 0;
  }
};

// Adds the recording to the evaluation. A report belongs to the take with which its stroke shares
// time. Cost: that of playing the recording.
void evaluateGestures(const PathRecording& recording, const GestureModel& model,
                      GestureEvaluation& evaluation, const FollowerSettings& settings = {});

}  // namespace merlin::nn
