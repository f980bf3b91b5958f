#include "daemon/cli/gesture/gesture.h"

#include "drivers/hand/hand.h"
#include "drivers/hand/movement_recording.h"

namespace merlin::cli {
namespace {

// Appends the poses of the performance to the recording, smoothed as merlind smooths the pose of a
// hand, and labelled with the gesture that is being made.
void append(nn::PathRecording& recording, const hand::Performance& performance) {
  hand::Hand smooth({});
  const nn::WallAxes axes;
  std::size_t next = 0;
  const auto& made = performance.made;
  for (const TrackerSample& sample : performance.samples) {
    const std::int64_t now_ns = sample.received_ns;
    while (next < made.size() && made[next].ended_ns < now_ns) ++next;
    const bool meant = next < made.size() && made[next].began_ns <= now_ns;
    const HandSample hand = smooth.update(sample, std::nullopt);
    recording.poses.push_back({recording.labelled(meant ? made[next].name : nn::kNoGesture),
                               axes.turned(now_ns, hand.position_m, hand.orientation_wxyz)});
  }
}

}  // namespace

nn::PathRecording recordingOf(const SyntheticMovers& movers, std::size_t person) {
  const hand::MovingPerson who(person);
  std::uint64_t seed = movers.seed * 1'000'003 + person * 17;
  nn::PathRecording recording;
  recording.synthetic = true;
  if (movers.times > 0) append(recording, hand::makeGestures(who, movers.times, seed));
  if (movers.ordinary_s > 0) append(recording, hand::goAbout(who, movers.ordinary_s, ++seed));
  for (std::size_t kind = 0; movers.kind_s > 0 && kind < hand::kOrdinaryKinds; ++kind)
    append(recording, hand::goAbout(who, static_cast<hand::Ordinary>(kind), movers.kind_s, ++seed));
  return recording;
}

std::vector<nn::LabelledStroke> strokesOf(const SyntheticMovers& movers, std::size_t& lost) {
  std::vector<nn::LabelledStroke> strokes;
  lost = 0;
  for (std::size_t n = 0; n < movers.people; ++n) {
    std::size_t lost_here = 0;
    const auto theirs =
        nn::strokesOf(recordingOf(movers, movers.first + n), kAfterTake_s, lost_here);
    strokes.insert(strokes.end(), theirs.begin(), theirs.end());
    lost += lost_here;
  }
  return strokes;
}

void addGesture(Command app, Run& run) {
  Command gesture = app.subcommand(
      "gesture", "Gestures in time (swipe, circle, push, twist): record, train, test, synthesize.");
  gesture.requireSubcommand();
  addGestureRecord(gesture, run);
  addGestureTrain(gesture, run);
  addGestureTest(gesture, run);
  addGestureSynthesize(gesture, run);
}

}  // namespace merlin::cli
