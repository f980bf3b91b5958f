#include "drivers/emulate/motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "drivers/hand/recording.h"

namespace merlin::emulate {
namespace {

// Time of the transition from one hand shape or push to the next [s]; a phase that is shorter
// consists of a transition only.
constexpr double kTransition = 0.35;

using Ball = std::array<float, 6>;
constexpr Ball kRest{};
constexpr Ball kSpin{0, 0, 0, 0, 0.6F, 0};
constexpr Ball kPush{0.5F, 0, 0.4F, 0, 0, 0};
constexpr Ball kDown{0, -0.9F, 0, 0, 0, 0};
constexpr Ball kTumble{0, 0.2F, 0, 0.5F, -0.5F, 0.3F};

// A visitor turns the model, looks at it, pushes it, grasps it, lets go, tumbles it, puts it back,
// and looks.
constexpr Phase kVisit[] = {
    {3.0, "open", kSpin, 0, false},       {2.0, "open", kRest, 0, false},
    {2.0, "point", kPush, 0, false},      {1.0, "open", kRest, 0, true},
    {3.5, "fist", kRest, 0, true},        {2.0, "open", kRest, 0, false},
    {1.5, "thumb-up", kTumble, 0, false}, {0.3, "open", kRest, 1, false},
    {1.7, "victory", kRest, 0, false},    {1.5, "pinch", kRest, 0, false},
    {1.0, "hook", kRest, 0, false},       {4.5, "open", kRest, 0, false},
};
constexpr Phase kTurning[] = {{1000.0, "open", kSpin, 0, true}};
constexpr Phase kStill[] = {{1000.0, "open", kRest, 0, false}};
constexpr Phase kGrabbing[] = {{1.0, "open", kRest, 0, true}, {4.0, "fist", kRest, 0, true}};

// The places that merlin calibrate tracker requests: an origin, a point on the x axis (along the
// transmitter's y), one near the y axis (along its -x), straight ahead (turned by 40 degrees).
constexpr HandPlace kOrigin{}, kOnX{{0.60F, 0.45F, -0.15F}}, kOnY{{0.30F, 0.10F, -0.15F}},
    kAhead{{0.45F, 0.20F, -0.15F}, 40 * std::numbers::pi / 180};
constexpr Phase kAlignment[] = {{5, "open", kRest, 0, false, kOrigin},
                                {5, "open", kRest, 0, false, kOnX},
                                {5, "open", kRest, 0, false, kOnY},
                                {5, "open", kRest, 0, false, kAhead}};

// The pushes that merlin calibrate ball requests, of a ball that is mounted rotated by 90 degrees
// and whose counts at rest are not 0.
constexpr Phase kPushes[] = {
    {5, "open", {0.0015F, 0, 0, 0, -0.005F, 0}, 0, false},
    {5, "open", {0.1F, -0.8F, 0.05F, 0, 0, 0.2F}, 0, false},
    {5, "open", {0.7F, 0.1F, 0, 0, 0.2F, 0}, 0, false},
    {5, "open", {0, 0.05F, -0.9F, 0.1F, 0, 0}, 0, false},
    {5, "open", {0, 0.1F, 0, 0.1F, -0.8F, 0}, 0, false},
    {5, "open", {0, 0, 0.1F, 0.75F, 0.1F, 0}, 0, false},
    {5, "open", {0.1F, 0, 0, 0, 0, -0.9F}, 0, false},
};

// A visitor who works the operator's panel: button 3 is bound to the action operator_panel, which
// gives the ball to the panel and, the next time, takes it away. Each time the ball is pushed down,
// for well under half a second, after which the panel would select one more control; then button 1
// is held.
constexpr Phase kPanel[] = {
    {0.4, "open", kRest, 4, false}, {0.8, "open", kRest, 0, false}, {0.25, "open", kDown, 0, false},
    {0.6, "open", kRest, 0, false}, {1.2, "open", kRest, 1, false}, {0.8, "open", kRest, 0, false},
};

constexpr MotionScript kScripts[] = {
    {"visit", "a visitor turns the model, rests, grabs it with a fist, lets go", kVisit},
    {"turning", "the ball is twisted all the time", kTurning},
    {"still", "nobody is there: open hand, ball at rest, tracker noise only", kStill},
    {"grabbing", "fist and open hand in turn, the hand moves", kGrabbing},
    {"alignment", "the hand goes where merlin calibrate tracker asks, 5 s each", kAlignment},
    {"panel",
     "a visitor works the operator's panel with the ball: button 3 enters and leaves, button 1 "
     "presses",
     kPanel},
    {"pushes", "the ball is moved as merlin calibrate ball asks, 5 s each", kPushes},
};

float mix(float a, float b, double share) { return a + (b - a) * static_cast<float>(share); }

// Returns the smoothstep function of `x`: it rises from 0 to 1, with slope 0 at both ends.
double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

HandPlace mix(const HandPlace& a, const HandPlace& b, double share) {
  HandPlace place;
  for (std::size_t i = 0; i < 3; ++i)
    place.position_m[i] = mix(a.position_m[i], b.position_m[i], share);
  place.turn_rad = a.turn_rad + (b.turn_rad - a.turn_rad) * share;
  return place;
}

// Sets the pose of the hand in the transmitter's frame: `place` plus a slow sway, scaled by
// `amplitude` (0: no sway).
void placeHand(Motion& motion, const HandPlace& place, double seconds, double amplitude) {
  const double w = 2 * std::numbers::pi * seconds;
  const auto& p = place.position_m;
  motion.position_m = {p[0] + static_cast<float>(amplitude * 0.08 * std::sin(w / 2.7)),
                       p[1] + static_cast<float>(amplitude * 0.20 * std::sin(w / 3.5)),
                       p[2] + static_cast<float>(amplitude * 0.10 * std::sin(w / 2.3))};
  // half of the angle about z
  const double half = place.turn_rad / 2 + amplitude * 0.35 * std::sin(w / 4.1);
  motion.orientation_wxyz = {static_cast<float>(std::cos(half)), 0, 0,
                             static_cast<float>(std::sin(half))};
}

}  // namespace

Motion MotionScript::at(Duration t) const {
  double length = 0;
  for (const Phase& p : phases) length += p.seconds;
  double since = std::fmod(std::max(toSeconds(t), 0.0), length);
  std::size_t i = 0;
  while (i + 1 < phases.size() && since >= phases[i].seconds) since -= phases[i++].seconds;
  if (held) i = *held % phases.size();
  const Phase& now = phases[i];
  const Phase& before = held ? now : phases[(i + phases.size() - 1) % phases.size()];
  const double way = since / std::min(kTransition, now.seconds);
  const double share = smooth(way);

  Motion motion;
  const hand::Shape* from = hand::findShape(before.shape);
  const hand::Shape* to = hand::findShape(now.shape);
  assert(from && to);
  for (std::size_t s = 0; s < kGloveSlots; ++s) {
    motion.glove_rad[s] = mix(from->angle_rad[s], to->angle_rad[s], hand::wayDone(s, way));
  }
  for (std::size_t a = 0; a < 6; ++a) motion.ball[a] = mix(before.ball[a], now.ball[a], share);
  motion.ball_buttons = now.buttons;
  placeHand(motion, mix(before.place, now.place, share), toSeconds(t),
            mix(before.wave ? 1 : 0, now.wave ? 1 : 0, share));
  return motion;
}

std::span<const MotionScript> motionScripts() { return kScripts; }

const MotionScript* findMotionScript(std::string_view name) {
  for (const MotionScript& script : kScripts) {
    if (script.name == name) return &script;
  }
  return nullptr;
}

}  // namespace merlin::emulate
