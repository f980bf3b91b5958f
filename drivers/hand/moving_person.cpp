#include "drivers/hand/moving_person.h"

#include <algorithm>
#include <cmath>

namespace merlin::hand {
namespace {

constexpr MovingGesture kGestures[] = {
    {"swipe_left", 0.38, {{-0.48, 0, 0}, {0, 0.5, 0}}, 0, 0},
    {"swipe_right", 0.38, {{0.48, 0, 0}, {0, -0.5, 0}}, 0, 0},
    {"swipe_up", 0.37, {{0, 0.40, 0}, {0.5, 0, 0}}, 0, 0},
    {"swipe_down", 0.37, {{0, -0.40, 0}, {-0.5, 0, 0}}, 0, 0},
    {"push", 0.37, {{0, 0.02, -0.34}, {0.3, 0, 0}}, 0, 0},
    {"pull", 0.37, {{0, -0.02, 0.34}, {-0.1, 0, 0}}, 0, 0},
    {"circle_clockwise", 0.85, {}, 0.14, 1},
    {"circle_counterclockwise", 0.85, {}, 0.14, -1},
    {"twist_left", 0.36, {{-0.01, 0, 0}, {0, 0, -1.35}}, 0, 0},
    {"twist_right", 0.36, {{0.01, 0, 0}, {0, 0, 1.35}}, 0, 0},
};

constexpr double kRates_hz[] = {30, 60, 90, 120};
constexpr double kLeastTurns = 0.95;  // least number of turns of a circle
constexpr double kWindUp = 0.25;      // share of people who swing back before a stroke

std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xCBF29CE484222325;  // FNV-1a
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return h;
}

double factor(double deviation, Random& random) { return std::exp(deviation * random.normal()); }

double lengthOf(const Vector3& v) { return std::hypot(v[0], v[1], v[2]); }

TrackerTraits drawTracker(Random& random) {
  TrackerTraits t;
  t.rate_hz = kRates_hz[random.below(std::size(kRates_hz))];
  t.jitter_s = random.uniform(0.0003, 0.003);
  t.position_m = 0.0008 * factor(0.5, random);
  t.turn_rad = 0.003 * factor(0.5, random);
  t.lost = random.uniform(0, 0.02);
  t.gap_every_s = random.uniform(10, 40);
  return t;
}

}  // namespace

// The constant deviations of one person from the average in one gesture.
struct MovingPerson::Habit {
  double size = 1, time = 1, skew = 1;
  Vector3 slant_rad{}, bow{};
  double start_rad = 0, turns = 1, aspect = 1, plane_rad = 0, roll_rad = 0;
  bool winds_up = false;
  double windup = 0.3;  // length of the swing back, share of the stroke
};

std::span<const MovingGesture> movingGestures() { return kGestures; }

const MovingGesture* findMovingGesture(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(kGestures), std::end(kGestures),
                   [&](const MovingGesture& gesture) { return gesture.name == name; });
  return found == std::end(kGestures) ? nullptr : found;
}

MovingPerson::MovingPerson(std::uint64_t seed, const MoverSettings& settings)
    : settings_(settings), seed_(seed) {
  if (seed == 0) return;
  Random random(seed * 0x9E3779B97F4A7C15 + 11);
  size_ = factor(settings.size_person, random);
  time_ = factor(settings.time_person, random);
  tremor_m_ = 0.0004 * factor(0.5, random);
  returns_ = random.uniform(0, 0.7);
  return_speed_ = random.uniform(0.35, 0.8);
  body_ = product(aboutAxis(1, settings.body_yaw_rad * random.normal()),
                  aboutAxis(0, settings.body_lean_rad * random.normal()));
  for (std::size_t axis = 0; axis < 3; ++axis)
    mount_ = product(mount_, aboutAxis(axis, settings.mount_rad * random.normal()));
  tracker_ = drawTracker(random);
}

MovingPerson::Habit MovingPerson::habitOf(const MovingGesture& gesture) const {
  Habit habit;
  if (seed_ == 0) return habit;
  Random random(seed_ * 0x9E3779B97F4A7C15 ^ hash(gesture.name));
  habit.size = factor(settings_.size_habit, random);
  habit.time = factor(settings_.time_habit, random);
  habit.skew = factor(0.12, random);
  for (double& slant : habit.slant_rad) slant = settings_.slant_habit_rad * random.normal();
  for (double& bow : habit.bow) bow = settings_.bow_habit * random.normal();
  habit.start_rad = 0.6 * random.normal() + (random.uniform() < 0.15 ? std::numbers::pi : 0);
  habit.turns = random.uniform(1.0, 1.35);
  habit.aspect = factor(0.15, random);
  habit.plane_rad = 0.25 * random.normal();
  habit.roll_rad = 0.12 * random.normal();
  habit.winds_up = random.uniform() < kWindUp;
  habit.windup = random.uniform(0.15, 0.4);
  return habit;
}

double MovingPerson::vary(double deviation, Random& random) const {
  return seed_ == 0 ? 1 : factor(deviation, random);
}

double MovingPerson::stray(double deviation, Random& random) const {
  return seed_ == 0 ? 0 : deviation * random.normal();
}

MovingPerson::Take MovingPerson::take(const MovingGesture& gesture, Random& random) const {
  const Habit habit = habitOf(gesture);
  Take take;
  Move& stroke = take.stroke;
  const double size = size_ * habit.size * vary(settings_.size_take, random);
  stroke.seconds = gesture.seconds * time_ * habit.time * vary(settings_.time_take, random);
  stroke.skew = habit.skew;
  if (gesture.radius_m > 0) {
    goRound(stroke, gesture, habit, size, random);
    return take;
  }
  goAlong(stroke, gesture, habit, size, random);
  take.winds_up = habit.winds_up && random.uniform() < 0.7;
  if (!take.winds_up) return take;
  take.windup.seconds = stroke.seconds * random.uniform(0.7, 1.1);
  for (std::size_t i = 0; i < 3; ++i) {
    take.windup.way.position_m[i] = -habit.windup * stroke.way.position_m[i];
    take.windup.way.turn_rad[i] = -habit.windup * stroke.way.turn_rad[i];
  }
  return take;
}

void MovingPerson::goRound(Move& circle, const MovingGesture& gesture, const Habit& habit,
                           double size, Random& random) const {
  circle.radius_m = {gesture.radius_m * size * habit.aspect, gesture.radius_m * size};
  const double turns = std::max(kLeastTurns, habit.turns + stray(0.08, random));
  circle.turns = gesture.turns * turns;
  circle.seconds *= turns;
  circle.start_rad = habit.start_rad + stray(0.2, random);
  circle.plane_rad = habit.plane_rad + stray(0.1, random);
  for (double& way : circle.way.position_m) way = stray(0.02, random);
}

void MovingPerson::goAlong(Move& stroke, const MovingGesture& gesture, const Habit& habit,
                           double size, Random& random) const {
  Quaternion slant{1, 0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double angle = habit.slant_rad[axis] + stray(settings_.slant_take_rad, random);
    slant = product(slant, aboutAxis(axis, angle));
  }
  stroke.way.position_m = rotated(slant, gesture.way.position_m);
  const double length = size * lengthOf(gesture.way.position_m);
  for (std::size_t i = 0; i < 3; ++i) {
    stroke.way.position_m[i] *= size;
    stroke.way.turn_rad[i] =
        gesture.way.turn_rad[i] * habit.size * vary(settings_.size_take, random);
    stroke.bow_m[i] = (habit.bow[i] + stray(settings_.bow_take, random)) * length;
  }
  if (gesture.way.turn_rad[2] == 0) {
    stroke.way.turn_rad[2] = habit.roll_rad + stray(0.06, random);
  } else {  // a twist also displaces the hand
    for (double& way : stroke.way.position_m) way += stray(0.015, random);
  }
}

}  // namespace merlin::hand
