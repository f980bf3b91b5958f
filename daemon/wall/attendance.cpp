#include "daemon/wall/attendance.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace merlin::wall {
namespace {

bool isPushed(const BallSample& ball) {
  const auto pushes = [](float axis) { return axis != 0; };
  return std::ranges::any_of(ball.translation, pushes) ||
         std::ranges::any_of(ball.rotation, pushes);
}

// Whether a bound input or the command `move` acts on what is shown. Each such action counts as a
// new touch, however soon it follows another one.
bool acts(const WallInput& input) {
  const render::scene::SceneInput& scene = input.scene;
  const bool stepped = !scene.step.way_m.isZero(0) || !scene.step.turn_rad.isZero(0);
  const bool aligned = !input.align.actions.empty();
  return stepped || aligned || scene.reset_view > 0 || scene.next_mode > 0 ||
         input.next_content > 0 || input.previous_content > 0 || input.snapshot > 0 ||
         input.operator_panel > 0;
}

}  // namespace

void Attendance::toggleBlank() {
  const std::lock_guard lock(mutex_);
  asked_.blank = !asked_.blank;
}

void Attendance::toggleFreeze() {
  const std::lock_guard lock(mutex_);
  asked_.freeze = !asked_.freeze;
}

void Attendance::touch() {
  const std::lock_guard lock(mutex_);
  asked_.touched = true;
}

void Attendance::attend() {
  const std::lock_guard lock(mutex_);
  asked_.attended = true;
}

void Attendance::switchPlaylist(bool on) {
  const std::lock_guard lock(mutex_);
  asked_.playlist = on;
}

void Attendance::nextOfPlaylist() {
  const std::lock_guard lock(mutex_);
  asked_.next = true;
}

// Whether a bound input belongs to the touch that has just ended black or frozen. A pinch or a long
// press triggers its action some time after its first finger or button has touched, which has ended
// that state at once.
bool Attendance::isOfEndingTouch(const WallInput& input, Timestamp now) {
  constexpr auto kGone = std::numeric_limits<std::uint32_t>::max();
  if (fingers_ > ended_.fingers) ended_.finger_last = now;
  if ((buttons_ & ~ended_.buttons) != 0) ended_.button_last = now;
  const bool finger = now - ended_.finger_last < kPause;
  const bool button = now - ended_.button_last < kPause;
  if (!finger) ended_.fingers = kGone;
  if (!button) ended_.buttons = kGone;
  return input.by_fingers ? finger : button;
}

Attendance::Asked Attendance::takeAsked(const WallInput& input, Timestamp now) {
  Asked asked;
  {
    const std::lock_guard lock(mutex_);
    asked = std::exchange(asked_, {});
  }
  const bool late = isOfEndingTouch(input, now);  // must not begin again what it has ended
  asked.blank ^= input.blank % 2 == 1 && (blank_ || !late || !ended_.blank);
  asked.freeze ^= input.freeze % 2 == 1 && (frozen_ || !late || !ended_.frozen);
  return asked;
}

// Whether the hand acts, i.e. begins an action or moves while it holds one. Holding an action is
// not enough, since a hand at rest may hold it for ever, for example a glove that lies on a table.
bool Attendance::handMoves(const render::scene::SceneInput& input) {
  const std::array holding{input.grab, input.fly, input.point_at};
  const auto before = std::exchange(holding_, holding);
  bool moves = false;
  for (std::size_t i = 0; i < holding.size(); ++i) moves |= holding[i] && !before[i];
  if (!input.hand || std::ranges::none_of(holding, std::identity())) return moves;
  const auto& at = input.hand->position_m;
  const float way = std::hypot(at[0] - hand_m_[0], at[1] - hand_m_[1], at[2] - hand_m_[2]);
  moves |= way > kHandMoves_m;
  if (moves) std::copy(std::begin(at), std::end(at), hand_m_.begin());
  return moves;
}

// Determines how fingers and mouse wheels act. Contact alone does not count, since a finger or an
// object may rest on a touch surface for ever. A mouse's wheel counts without a finger. A finger
// that leaves does not undo blank and freeze; nor do moving fingers that remain from the gesture
// that caused that state.
Attendance::Motion Attendance::fingersMove(const render::scene::TouchMotion& touch) {
  const std::uint32_t before = std::exchange(fingers_, touch.fingers);
  const bool come = touch.fingers > before, go = touch.fingers < before;
  of_gesture_ = come ? 0 : std::min(of_gesture_, touch.fingers);
  const std::array moved{touch.right, touch.up, touch.spread, touch.turn_rad};
  float most = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    fingers_moved_[i] += moved[i];
    most = std::max(most, std::abs(fingers_moved_[i]));
  }
  const bool move = most > kFingersMove;
  if (come || go || move) fingers_moved_ = {};
  return {.touches = come || go || move,
          .wakes = come || (move && !go && of_gesture_ == 0),
          .lets_go = go};
}

// Determines how the input acts: a push of the ball, its buttons, held motion actions, fingers,
// mouse wheels, and a hand that moves.
Attendance::Motion Attendance::motionOf(const WallInput& input) {
  const auto& ball = input.scene.ball;
  const std::uint32_t buttons = ball ? ball->buttons : 0;
  const std::uint32_t before = std::exchange(buttons_, buttons);
  const bool pressed = (buttons & ~before) != 0, released = (before & ~buttons) != 0;
  const bool pushed = (ball && isPushed(*ball)) || input.scene.held.moves() || input.panel_pushed ||
                      input.align.push != state::Offset{};
  const bool other = handMoves(input.scene) || pushed || pressed;
  const Motion fingers = fingersMove(input.scene.touch);
  return {.touches = other || fingers.touches,
          .wakes = other || fingers.wakes,
          .lets_go = released || fingers.lets_go};
}

Attendance::Frame Attendance::update(WallInput& input, Timestamp now) {
  const Asked asked = takeAsked(input, now);
  const Ended before{blank_, frozen_, fingers_, buttons_, now, now};
  const Motion motion = motionOf(input);
  const bool paused = !last_motion_ || now - *last_motion_ >= kPause;
  const bool acted = acts(input) || asked.touched;
  const bool bound = input.blank > 0 || input.freeze > 0;
  if (motion.touches || motion.lets_go || acted || bound) last_motion_ = now;
  if (bound) ended_ = {};
  if (bound && input.by_fingers) of_gesture_ = fingers_;
  if (acted || (motion.wakes && paused && !bound)) {
    if (blank_ || frozen_) ended_ = before;
    blank_ = frozen_ = false;
  }
  blank_ ^= asked.blank;
  frozen_ ^= asked.freeze;

  if (asked.playlist) *asked.playlist ? playlist_.on() : playlist_.off();
  if (asked.next) playlist_.next();
  if (asked.next || asked.playlist.value_or(false)) blank_ = frozen_ = false;
  Frame frame;
  frame.held = blank_ || frozen_;
  const Duration elapsed = now - std::exchange(last_update_, now).value_or(now);
  // While the wall is black or frozen, no time passes for the playlist.
  frame.playlist = playlist_.update(frame.held ? Duration::zero() : elapsed,
                                    motion.touches || acted || asked.attended);
  if (frame.held)
    input.scene = {};
  else
    input.scene.turn_rad_s = frame.playlist.turn_rad_s;
  if (blank_) frame.playlist.light = 0;
  light_ = frame.playlist.light;
  return frame;
}

Playlist::Due Attendance::due() const noexcept {
  return blank_ || frozen_ ? Playlist::Due{} : playlist_.due();
}

Attendance::Shown Attendance::shown() const noexcept {
  if (blank_) return Shown::kBlank;
  return frozen_ ? Shown::kFrozen : Shown::kPicture;
}

}  // namespace merlin::wall
