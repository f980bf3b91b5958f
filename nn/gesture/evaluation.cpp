#include "nn/gesture/evaluation.h"

#include <algorithm>

namespace merlin::nn {
namespace {

void count(const std::vector<std::string_view>& reported, const std::string& meant,
           GestureScore& score) {
  ++score.takes;
  if (reported.empty()) {
    ++score.missed;
  } else if (reported.size() > 1) {
    ++score.repeated;
  } else if (reported.front() == meant) {
    ++score.right;
  } else {
    ++score.wrong;
  }
}

void evaluateSession(std::span<const LabelledPose> session, const PathRecording& recording,
                     GestureFollower follower, GestureEvaluation& evaluation) {
  const std::vector<Take> takes = takesOf(session, recording);
  std::vector<std::vector<std::string_view>> reported(takes.size());
  for (const LabelledPose& p : session) {
    const auto gesture = follower.update(p.pose);
    if (!gesture) continue;
    const auto take = std::find_if(takes.begin(), takes.end(), [&](const Take& t) {
      return gesture->began_ns < t.last_ns && gesture->ended_ns > t.first_ns;
    });
    if (take != takes.end()) {
      reported[static_cast<std::size_t>(take - takes.begin())].push_back(gesture->name);
    } else {
      ++evaluation.invented;
      ++evaluation.inventions[std::string(gesture->name)];
    }
  }
  evaluation.ordinary_s +=
      1e-9 * static_cast<double>(session.back().pose.at_ns - session.front().pose.at_ns);
  for (std::size_t n = 0; n < takes.size(); ++n) {
    const std::string& meant = recording.labels[takes[n].label];
    evaluation.ordinary_s -= 1e-9 * static_cast<double>(takes[n].last_ns - takes[n].first_ns);
    count(reported[n], meant, evaluation.all);
    count(reported[n], meant, evaluation.of[meant]);
    ++evaluation.confusion[meant][reported[n].empty() ? "" : std::string(reported[n].front())];
  }
}

}  // namespace

void evaluateGestures(const PathRecording& recording, const GestureModel& model,
                      GestureEvaluation& evaluation, const FollowerSettings& settings) {
  for (const auto session : sessionsOf(recording))
    evaluateSession(session, recording, GestureFollower(model, settings), evaluation);
}

}  // namespace merlin::nn
