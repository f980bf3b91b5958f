#include "drivers/hand/actor.h"

#include <algorithm>
#include <cmath>

namespace merlin::hand {
namespace {

constexpr double kFull = 2 * std::numbers::pi;
constexpr double kAhead_s = 1;  // maximum overlap of a move with the plan before it
constexpr double kLongestGap_s = 0.25;
constexpr double kSway_m = 0.006, kSway_hz[] = {0.19, 0.27, 0.34}, kTremor_hz[] = {8.3, 9.1, 10.2};
constexpr Vector3 kDown{0.18, -0.40, -0.08};  // hand relative to the middle of the shoulders [m]
constexpr Vector3 kReady{0.15, -0.05, -0.38};
// Duration of an unhurried reach: a constant, plus shares for its length and its roll.
constexpr double kReach_s = 0.40, kReach_s_per_m = 0.6, kReach_s_per_rad = 0.15;
constexpr double kStand_m = 1.2, kFar_m = 1.5;  // distances from the transmitter
constexpr std::int64_t kStart_ns = 1'000'000'000;

}  // namespace

Actor::Actor(const MovingPerson& person, std::uint64_t seed)
    : person_(person),
      random_(seed * 0x9E3779B97F4A7C15 + 31),
      noise_(seed * 0x9E3779B97F4A7C15 + 32),
      hand_({kDown, {}}),
      body_({{0.3 * random_.normal(), 0, kStand_m + 0.2 * random_.normal()}, {}}),
      gap_at_s_(random_.uniform(1, 2 * person.tracker().gap_every_s)) {
  for (double& phase : phase_) phase = kFull * random_.uniform();
}

void Actor::wait(double seconds) {
  planned_s_ += seconds;
  sample(planned_s_ - kAhead_s);
}

void Actor::move(const HandState& way, double seconds, double bow) {
  Move m;
  m.begin_s = planned_s_;
  m.seconds = seconds;
  m.way = way;
  for (double& b : m.bow_m) b = bow * random_.normal();
  hand_.add(m);
  wait(seconds);
}

void Actor::goTo(const Vector3& place, double roll_rad, double bow, double seconds) {
  const HandState end = hand_.end();
  HandState way{};
  for (std::size_t i = 0; i < 3; ++i) {
    way.position_m[i] = place[i] * person_.size() - end.position_m[i];
    way.turn_rad[i] = -end.turn_rad[i];
  }
  way.turn_rad[2] += roll_rad;
  if (seconds == 0) {
    const double way_m = std::hypot(way.position_m[0], way.position_m[1], way.position_m[2]);
    seconds = pace(0.85, 1.4) *
              (kReach_s + kReach_s_per_m * way_m + kReach_s_per_rad * std::abs(way.turn_rad[2]));
  }
  move(way, seconds, bow);
}

double Actor::pace(double low_s, double high_s) {
  return person_.tempo() * random_.uniform(low_s, high_s);
}

Vector3 Actor::about(const Vector3& place, double deviation) {
  Vector3 p = place;
  for (double& x : p) x += deviation * random_.normal();
  return p;
}

// The hand moves to a place from which the stroke has room, rests there for a short time, makes the
// gesture, and either goes back at once or stays and moves on later.
void Actor::makeGesture(const MovingGesture& gesture) {
  const MovingPerson::Take take = person_.take(gesture, random_);
  Vector3 start = about(kReady, 0.04);
  for (std::size_t i = 0; i < 3; ++i) start[i] -= 0.5 * gesture.way.position_m[i];
  goTo(start, -0.5 * gesture.way.turn_rad[2], 0.03);
  wait(random_.uniform(0.05, 0.7));
  if (take.winds_up) {
    Move windup = take.windup;
    windup.begin_s = planned_s_;
    hand_.add(windup);
    wait(windup.seconds + random_.uniform(-0.08, 0.05));
  }
  Move stroke = take.stroke;
  stroke.begin_s = planned_s_;
  hand_.add(stroke);
  const auto ns = [](double s) { return kStart_ns + static_cast<std::int64_t>(s * 1e9); };
  done_.made.push_back({gesture.name, ns(planned_s_), ns(planned_s_ + stroke.seconds)});
  wait(stroke.seconds);
  if (gesture.radius_m == 0 && random_.uniform() < person_.returns()) {
    wait(random_.uniform(-0.05, 0.2));
    HandState back{};
    const double share = random_.uniform(0.5, 1.0);
    for (std::size_t i = 0; i < 3; ++i) {
      back.position_m[i] = -share * stroke.way.position_m[i];
      back.turn_rad[i] = -share * stroke.way.turn_rad[i];
    }
    move(back, stroke.seconds * share / person_.return_speed(), 0.02);
  }
  wait(random_.uniform(0.3, 1.2));
  if (random_.uniform() < 0.3) {
    goTo(about(kDown, 0.04), 0, 0.03);
    wait(random_.uniform(0.3, 1.5));
  }
}

void Actor::goAbout(Ordinary kind) {
  switch (kind) {
    case Ordinary::kPointing: return point();
    case Ordinary::kReaching: return reach();
    case Ordinary::kTurning: return turnModel();
    case Ordinary::kScratching: return scratch();
    case Ordinary::kWalking: return walk();
    case Ordinary::kResting: return rest();
    case Ordinary::kTalking: return talk();
  }
}

void Actor::point() {
  goTo(about({0.1, 0.05, -0.50}, 0.06), 0.2 * random_.normal(), 0.03);
  for (std::uint64_t n = 2 + random_.below(5); n > 0; --n) {
    wait(random_.uniform(0.3, 2.0));
    const Vector3 way{0.16 * random_.normal(), 0.10 * random_.normal(), 0.03 * random_.normal()};
    const double length = std::hypot(way[0], way[1], way[2]);
    HandState there = hand_.end();
    for (std::size_t i = 0; i < 3; ++i)
      there.position_m[i] = there.position_m[i] / person_.size() + way[i];
    goTo(there.position_m, 0.2 * random_.normal(), 0.02, pace(0.4, 0.7) + 0.5 * length);
  }
  wait(random_.uniform(0.3, 1));
  goTo(about(kDown, 0.04), 0, 0.03);
  wait(random_.uniform(0.2, 2));
}

void Actor::reach() {
  const Vector3 from = about(random_.uniform() < 0.5 ? kDown : kReady, 0.04);
  goTo(from, 0, 0.03);
  wait(random_.uniform(0.2, 1.5));
  Vector3 to = about({0.15, -0.1, -0.6}, 0.12);
  goTo(to, 0.5 * random_.normal(), 0.04);
  wait(random_.uniform(0.2, 1.5));
  goTo(from, 0, 0.04);
  wait(random_.uniform(0.3, 2));
}

void Actor::turnModel() {
  goTo(about(kReady, 0.05), 0, 0.03);
  for (std::uint64_t n = 2 + random_.below(6); n > 0; --n) {
    wait(random_.uniform(0, 0.8));
    HandState way{};
    for (double& w : way.position_m) w = 0.09 * random_.normal();
    for (double& t : way.turn_rad) t = 0.35 * random_.normal();
    way.turn_rad[2] = 0.6 * random_.normal();
    const HandState end = hand_.end();
    for (std::size_t i = 0; i < 3; ++i) {  // start away from the stroke, towards the middle
      way.position_m[i] += 0.5 * (kReady[i] * person_.size() - end.position_m[i]);
      way.turn_rad[i] -= 0.6 * end.turn_rad[i];
    }
    move(way, pace(0.6, 1.6), 0.02);
  }
  wait(random_.uniform(0.2, 1));
}

void Actor::scratch() {
  goTo(about({0.06, 0.18, -0.12}, 0.03), 0.6, 0.04);
  const double hz = random_.uniform(2.5, 5), size = random_.uniform(0.012, 0.03);
  for (std::uint64_t n = 4 + random_.below(10); n > 0; --n) {
    const double sign = n % 2 == 0 ? 1 : -1;
    move({{0.3 * size * sign, size * sign, 0}, {}}, 0.5 / hz);
  }
  wait(random_.uniform(0, 0.3));
  goTo(about(random_.uniform() < 0.7 ? kDown : kReady, 0.05), 0, 0.04);
  wait(random_.uniform(0.3, 2));
}

// A step takes half a second or so; the arm swings the other way with each step.
void Actor::walk() {
  goTo(about(kDown, 0.03), 0, 0.02);
  const double step_s = pace(0.48, 0.62), swing = random_.uniform(0.05, 0.22);
  const double step_m = random_.uniform(0.4, 0.7);
  double angle = kFull * random_.uniform();
  const Vector3 stands = body_.end().position_m;
  if (std::hypot(stands[0], stands[2] - kStand_m) > kFar_m)  // at the end of the cable: turn back
    angle = std::atan2(kStand_m - stands[2], -stands[0]);
  const Vector3 ahead{std::cos(angle), 0, std::sin(angle)};
  for (std::uint64_t n = 3 + random_.below(6); n > 0; --n) {
    Move step;
    step.begin_s = planned_s_ - 0.1;
    step.seconds = step_s + 0.2;
    step.way.position_m = {ahead[0] * step_m, 0, ahead[2] * step_m};
    step.bow_m = {0, 0.02, 0};
    body_.add(step);
    const double sign = n % 2 == 0 ? swing : -swing;
    move({{sign * ahead[0], 0.1 * std::abs(sign), sign * ahead[2]}, {0, 0, 0.1 * sign}}, step_s);
  }
  wait(random_.uniform(0.5, 1.5));
}

void Actor::rest() {
  goTo(about(random_.uniform() < 0.6 ? kDown : kReady, 0.05), 0.2 * random_.normal(), 0.03);
  wait(random_.uniform(2, 8));
}

// Moves the hand as a speaker does: with small and brisk movements, seldom with large ones.
void Actor::talk() {
  goTo(about({0.15, -0.12, -0.28}, 0.05), 0.3 * random_.normal(), 0.03);
  for (std::uint64_t n = 4 + random_.below(8); n > 0; --n) {
    const Vector3 to = about({0.15, -0.10, -0.30}, random_.uniform(0.02, 0.09));
    goTo(to, 0.35 * random_.normal(), 0.02, pace(0.28, 0.65));
    wait(random_.uniform(-0.08, 0.5));
  }
  wait(random_.uniform(0.2, 1));
}

void Actor::sample(double until_s) {
  const TrackerTraits& tracker = person_.tracker();
  for (; next_s_ < until_s; next_s_ += 1 / tracker.rate_hz) {
    ++counter_;
    if (next_s_ >= gap_at_s_) {
      gap_until_s_ = next_s_ + noise_.uniform(0.04, kLongestGap_s);
      gap_at_s_ = next_s_ + noise_.uniform(0.2, 2) * tracker.gap_every_s;
    }
    const bool lost = noise_.uniform() < tracker.lost || next_s_ < gap_until_s_;
    if (!lost) take(next_s_);
  }
}

void Actor::take(double t_s) {
  HandState hand = hand_.at(t_s);
  const HandState stand = body_.at(t_s);
  for (std::size_t i = 0; i < 3; ++i) {
    hand.position_m[i] +=
        kSway_m * std::sin(kFull * kSway_hz[i] * t_s + phase_[i]) +
        person_.tremor_m() * std::sin(kFull * kTremor_hz[i] * t_s + phase_[i + 3]);
    hand.turn_rad[i] += 0.02 * std::sin(kFull * kSway_hz[i] * t_s + phase_[i]);
  }
  const TrackerTraits& tracker = person_.tracker();
  Vector3 at = rotated(person_.body(), hand.position_m);
  Quaternion q = product(product(person_.body(), orientationOf(hand)), person_.mount());
  for (std::size_t i = 0; i < 3; ++i) {
    at[i] += stand.position_m[i] + tracker.position_m * noise_.normal();
    q = product(q, aboutAxis(i, tracker.turn_rad * noise_.normal()));
  }
  TrackerSample sample{};
  const double late_s = tracker.jitter_s * std::abs(noise_.normal());
  sample.received_ns =
      std::max(last_ns_ + 1, kStart_ns + static_cast<std::int64_t>((t_s + late_s) * 1e9));
  last_ns_ = sample.received_ns;
  sample.counter = counter_;
  sample.station = 1;
  // The transmitter's axes: x towards the person, y left, z down.
  const auto f = [](double x) { return static_cast<float>(x); };
  const std::array<float, 3> position{f(at[2]), f(-at[0]), f(-at[1])};
  const std::array<float, 4> turn{f(q[0]), f(q[3]), f(-q[1]), f(-q[2])};
  std::copy(position.begin(), position.end(), sample.position_m);
  std::copy(turn.begin(), turn.end(), sample.orientation_wxyz);
  sample.error = ' ';
  done_.samples.push_back(sample);
}

Performance Actor::finish() {
  sample(planned_s_);
  return std::move(done_);
}

}  // namespace merlin::hand
