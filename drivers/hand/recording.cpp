#include "drivers/hand/recording.h"

#include <algorithm>

namespace merlin::hand {
namespace {

constexpr double kLag = 0.06;  // delay of a finger after its neighbour, share of the transition
constexpr std::size_t kFingers = 5, kSlotsOfAFinger = 4;

// Returns the smoothstep function of `x`: it rises from 0 to 1, with slope 0 at both ends.
double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

}  // namespace

double wayDone(std::size_t slot, double share) {
  const std::size_t finger = std::min(slot / kSlotsOfAFinger, kFingers - 1);
  const double late = kLag * static_cast<double>(finger);
  return smooth((share - late) / (1 - kLag * (kFingers - 1)));
}

std::vector<Shot> record(std::span<const Shape> shapes, const RecordingSettings& settings,
                         std::uint64_t seed) {
  std::vector<Person> people;
  for (std::size_t p = 0; p < settings.people; ++p)
    people.emplace_back(settings.first_person + p, settings.spread);
  std::vector<Shot> shots;
  shots.reserve(shapes.size() * people.size() * settings.takes * settings.per_take);
  Random random(seed);
  for (const Shape& shape : shapes) {
    for (const Person& person : people) {
      for (std::size_t t = 0; t < settings.takes; ++t) {
        const Angles joints = person.take(shape, random);
        for (std::size_t n = 0; n < settings.per_take; ++n)
          shots.push_back({shape.name, person.sense(joints, random)});
      }
    }
  }
  return shots;
}

std::vector<Shot> goThrough(std::span<const Shape> shapes, const Person& person, std::size_t hold,
                            std::size_t way, std::uint64_t seed) {
  std::vector<Shot> shots;
  Random random(seed);
  Angles from{};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Angles to = person.take(shapes[i], random);
    for (std::size_t n = 1; i > 0 && n <= way; ++n) {
      const double share = static_cast<double>(n) / static_cast<double>(way + 1);
      Angles joints{};
      for (std::size_t slot = 0; slot < kGloveSlots; ++slot)
        joints[slot] =
            from[slot] + (to[slot] - from[slot]) * static_cast<float>(wayDone(slot, share));
      shots.push_back({nullptr, person.sense(joints, random)});
    }
    for (std::size_t n = 0; n < hold; ++n)
      shots.push_back({shapes[i].name, person.sense(to, random)});
    from = to;
  }
  return shots;
}

}  // namespace merlin::hand
