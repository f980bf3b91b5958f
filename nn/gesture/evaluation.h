// Evaluates a gesture model on a recording, whose poses are recognised one after another as in live
// use. Pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "nn/gesture/follower.h"
#include "nn/gesture/path_recording.h"

namespace merlin::nn {

struct GestureScore {
  std::size_t takes = 0;
  std::size_t right = 0;     // takes with exactly one reported gesture, the right one
  std::size_t missed = 0;    // takes without a reported gesture
  std::size_t wrong = 0;     // takes with exactly one reported gesture, a wrong one
  std::size_t repeated = 0;  // takes with several reported gestures
  double rate() const {
    return takes > 0 ? static_cast<double>(right) / static_cast<double>(takes) : 0;
  }
};

struct GestureEvaluation {
  GestureScore all;
  std::map<std::string, GestureScore> of;  // scores of each gesture that was meant
  // confusion[meant][reported]: number of takes of the gesture `meant` in which `reported` was the
  // first reported gesture; `reported` is "" for takes without a report.
  std::map<std::string, std::map<std::string, std::size_t>> confusion;
  std::size_t invented = 0;                       // gestures reported outside of all takes
  std::map<std::string, std::size_t> inventions;  // `invented` by reported gesture
  double ordinary_s = 0;                          // time outside of all takes
  double inventedPerTenMinutes() const {
    return ordinary_s > 0 ? 600 * static_cast<double>(invented) / ordinary_s : 0;
  }
};

// Evaluates `model` on the recording and adds the result to `evaluation`. A reported gesture
// belongs to the first take that overlaps its stroke in time. Cost: one GestureFollower::update()
// for each pose.
void evaluateGestures(const PathRecording& recording, const GestureModel& model,
                      GestureEvaluation& evaluation, const FollowerSettings& settings = {});

}  // namespace merlin::nn
