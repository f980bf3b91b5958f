#include "drivers/hand/movement_recording.h"

#include <algorithm>
#include <cmath>

#include "drivers/hand/actor.h"

namespace merlin::hand {

Performance makeGestures(const MovingPerson& person, std::size_t times, std::uint64_t seed) {
  Random random(seed * 0x9E3779B97F4A7C15 + 21);
  std::vector<const MovingGesture*> order;
  for (const MovingGesture& gesture : movingGestures()) order.insert(order.end(), times, &gesture);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  Actor actor(person, seed);
  for (const MovingGesture* const gesture : order) actor.makeGesture(*gesture);
  return actor.finish();
}

Performance goAbout(const MovingPerson& person, double seconds, std::uint64_t seed) {
  Random random(seed * 0x9E3779B97F4A7C15 + 22);
  Actor actor(person, seed);
  while (actor.seconds() < seconds)
    actor.goAbout(static_cast<Ordinary>(random.below(kOrdinaryKinds)));
  return actor.finish();
}

Performance goAbout(const MovingPerson& person, Ordinary kind, double seconds, std::uint64_t seed) {
  Actor actor(person, seed);
  while (actor.seconds() < seconds) actor.goAbout(kind);
  return actor.finish();
}

}  // namespace merlin::hand
