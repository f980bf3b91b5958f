// Recordings of synthetic people who move, smoothed as the hand's poses are, which is what the
// gesture follower receives at run time. Shared by the tests of nn/gesture and the benchmark.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/hand/hand.h"
#include "drivers/hand/movement_recording.h"
#include "nn/gesture/path_recording.h"

namespace merlin::nn::test {

inline void append(PathRecording& recording, const hand::Performance& performance) {
  recording.synthetic = true;
  hand::Hand smooth({});
  const WallAxes axes;
  std::size_t next = 0;
  for (const TrackerSample& sample : performance.samples) {
    const std::int64_t now_ns = sample.received_ns;
    while (next < performance.made.size() && performance.made[next].ended_ns < now_ns) ++next;
    const bool made = next < performance.made.size() && performance.made[next].began_ns <= now_ns;
    const HandSample hand = smooth.update(sample, std::nullopt);
    recording.poses.push_back({recording.labelled(made ? performance.made[next].name : kNoGesture),
                               axes.turned(now_ns, hand.position_m, hand.orientation_wxyz)});
  }
}

// Returns recordings of `count` people, numbered from `first`; each person makes every gesture
// `times` times.
inline PathRecording gesturesOf(std::uint64_t first, std::size_t count, std::size_t times,
                                std::uint64_t seed) {
  PathRecording recording;
  for (std::uint64_t n = first; n < first + count; ++n)
    append(recording, hand::makeGestures(hand::MovingPerson(n), times, seed * 1000 + n));
  return recording;
}

// Returns recordings of `count` people, numbered from `first`; each person makes ordinary motions
// for `seconds`.
inline PathRecording ordinaryOf(std::uint64_t first, std::size_t count, double seconds,
                                std::uint64_t seed) {
  PathRecording recording;
  for (std::uint64_t n = first; n < first + count; ++n)
    append(recording, hand::goAbout(hand::MovingPerson(n), seconds, seed * 1000 + n));
  return recording;
}

// Returns recordings of `count` people, numbered from `first`; each person makes one kind of
// ordinary motion for `seconds`.
inline PathRecording ordinaryOf(hand::Ordinary kind, std::uint64_t first, std::size_t count,
                                double seconds, std::uint64_t seed) {
  PathRecording recording;
  for (std::uint64_t n = first; n < first + count; ++n)
    append(recording, hand::goAbout(hand::MovingPerson(n), kind, seconds, seed * 1000 + n));
  return recording;
}

inline void join(PathRecording& to, const PathRecording& from) {
  to.synthetic = to.synthetic || from.synthetic;
  for (const LabelledPose& p : from.poses)
    to.poses.push_back({to.labelled(from.labels[p.label]), p.pose});
}

}  // namespace merlin::nn::test
