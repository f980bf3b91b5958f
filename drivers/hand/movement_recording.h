// Recordings of synthetic people who move: sessions with gestures in time, and with ordinary motion
// that contains no gesture. Pure, seeded.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/hand/moving_person.h"

namespace merlin::hand {

// What people do before a wall without making a gesture.
enum class Ordinary : std::uint8_t {
  kPointing,    // points at one place of the wall after another
  kReaching,    // reaches for something in front and draws the hand back
  kTurning,     // moves and turns the model while the hand holds it
  kScratching,  // scratches the head
  kWalking,     // walks by with swinging arms
  kResting,     // stands with the hand down or before the chest
  kTalking,     // talks and moves the hand
};
inline constexpr const char* kOrdinaryNames[] = {"pointing", "reaching", "turning", "scratching",
                                                 "walking",  "resting",  "talking"};
inline constexpr std::size_t kOrdinaryKinds = std::size(kOrdinaryNames);

// A gesture that was made; the times of its first and last motion are by the clock of the samples.
struct MadeGesture {
  const char* name;
  std::int64_t began_ns, ended_ns;
};

// Samples of the tracker's station 1, in the transmitter's frame (x away from the cable towards the
// person, y left and z down as the person sees it), and the gestures that were made in them.
struct Performance {
  std::vector<TrackerSample> samples;
  std::vector<MadeGesture> made;
};

// Records a person who makes each gesture `times` times, all in random order. Before each gesture,
// the hand is raised to the place where the gesture begins and rests for a moment; after it, the
// hand moves on.
Performance makeGestures(const MovingPerson& person, std::size_t times, std::uint64_t seed);

// Records at least `seconds` of ordinary motion: of one kind, or of all kinds in turn.
Performance goAbout(const MovingPerson& person, double seconds, std::uint64_t seed);
Performance goAbout(const MovingPerson& person, Ordinary kind, double seconds, std::uint64_t seed);

}  // namespace merlin::hand
