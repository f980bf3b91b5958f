// Recordings of synthetic people: who holds which shape how often, and a hand that goes from one
// shape to the next. Pure, seeded.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/hand/people.h"

namespace merlin::hand {

struct Shot {
  const char* shape = nullptr;  // that is shown; nullptr on the way from one to another
  Angles angle_rad{};           // as the glove says it
};

struct RecordingSettings {
  std::uint64_t first_person = 1;  // seeds of Person: no two recordings share one by accident
  std::size_t people = 10;
  std::size_t takes = 1;     // of each shape by each person
  std::size_t per_take = 5;  // samples
  PeopleSettings spread{};
};

// All takes of the first shape first, person by person.
std::vector<Shot> record(std::span<const Shape> shapes, const RecordingSettings& settings,
                         std::uint64_t seed);

// How far a hand has come on its way from one shape to another, 0..1 with level ends, of a slot:
// fingers start one after the other, the thumb first. `share`: of the time that the way takes.
double wayDone(std::size_t slot, double share);

// One person who holds each shape for `hold` samples and takes `way` samples to the next.
std::vector<Shot> goThrough(std::span<const Shape> shapes, const Person& person, std::size_t hold,
                            std::size_t way, std::uint64_t seed);

}  // namespace merlin::hand
