// Recordings of synthetic people: several people who hold each shape several times, or one hand
// that goes from shape to shape. Pure, seeded.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/hand/people.h"

namespace merlin::hand {

struct Shot {
  const char* shape = nullptr;  // name of the held shape; nullptr in a transition between two
  Angles angle_rad{};           // joint angles as the glove measures them
};

struct RecordingSettings {
  std::uint64_t first_person = 1;  // seed of the first Person; the others have the next ones
  std::size_t people = 10;
  std::size_t takes = 1;     // number of times that each person takes each shape
  std::size_t per_take = 5;  // number of samples in each take
  PeopleSettings spread{};
};

// Returns the samples of several people, ordered by shape, then by person, then by take.
std::vector<Shot> record(std::span<const Shape> shapes, const RecordingSettings& settings,
                         std::uint64_t seed);

// Returns the progress of a slot in the transition from one shape to another, 0..1; its slope is 0
// at both ends. The fingers start one after the other, the thumb first. `share`: elapsed share of
// the transition's time.
double wayDone(std::size_t slot, double share);

// Returns the samples of one person, who holds each shape for `hold` samples; a transition between
// two shapes takes `way` samples.
std::vector<Shot> goThrough(std::span<const Shape> shapes, const Person& person, std::size_t hold,
                            std::size_t way, std::uint64_t seed);

}  // namespace merlin::hand
