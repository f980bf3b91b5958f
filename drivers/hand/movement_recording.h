// Recordings of synthetic people who move: sessions of gestures in time, and of ordinary motion in
// which nobody makes one. Pure, seeded.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/hand/moving_person.h"

namespace merlin::hand {

// What people do before a wall without making a gesture.
enum class Ordinary : std::uint8_t {
  kPointing,    // to one place of the wall after another
  kReaching,    // for something in front, and back
  kTurning,     // moves and turns the model while the hand holds it
  kScratching,  // the head
  kWalking,     // by, with swinging arms
  kResting,     // stands, the hand down or before the chest
  kTalking,     // with the hands
};
inline constexpr const char* kOrdinaryNames[] = {"pointing", "reaching", "turning", "scratching",
                                                 "walking",  "resting",  "talking"};
inline constexpr std::size_t kOrdinaryKinds = std::size(kOrdinaryNames);

// A gesture that was made, from its first motion to its last.
struct MadeGesture {
  const char* name;
  std::int64_t began_ns, ended_ns;
};

// What the tracker's station 1 says, in the transmitter's frame (x away from the cable towards the
// person, y left and z down as the person sees it), and what was meant.
struct Performance {
  std::vector<TrackerSample> samples;
  std::vector<MadeGesture> made;
};

// The person makes each gesture `times` times, all in random order, with what lies between them:
// the hand is raised and brought to where the gesture begins, rests a moment, and is taken back.
Performance makeGestures(const MovingPerson& person, std::size_t times, std::uint64_t seed);

// At least `seconds` of ordinary motion; of one kind, or of all in turn.
Performance goAbout(const MovingPerson& person, double seconds, std::uint64_t seed);
Performance goAbout(const MovingPerson& person, Ordinary kind, double seconds, std::uint64_t seed);

}  // namespace merlin::hand
