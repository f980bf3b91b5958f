#include "daemon/wall/device_feed.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "daemon/base/commands.h"
#include "drivers/hand/hand.h"

namespace merlin::wall {
namespace {

// A ball that is pushed sends samples with at most this interval. If the last sample is a push and
// older than this, the sample of the release was lost, and the push is ignored.
constexpr Duration kPushLasts = std::chrono::milliseconds(500);

bool pushed(const BallSample& b) {
  const auto moves = [](float v) { return v != 0; };
  return std::any_of(std::begin(b.translation), std::end(b.translation), moves) ||
         std::any_of(std::begin(b.rotation), std::end(b.rotation), moves);
}

// Replaces the pose in `hand` by the pose predicted for the time `seen`, if `slots` has a
// HandSample that was computed from the same tracker sample.
void predictPose(const shm::DeviceSlots::Hand* slots, Timestamp seen, TrackerSample& hand) {
  const auto h = slots ? slots->samples->newest() : std::nullopt;
  if (!h || h->received_ns != hand.received_ns) return;
  const hand::Pose pose = hand::poseAt(*h, seen);
  std::copy(pose.position_m.begin(), pose.position_m.end(), hand.position_m);
  std::copy(pose.orientation_wxyz.begin(), pose.orientation_wxyz.end(), hand.orientation_wxyz);
}

// Actions by which a hand moves the model or the viewer. A hand that only points does not prevent
// another hand from doing so.
constexpr std::array kMoving = {actionIndex("grab"), actionIndex("fly")};
constexpr std::array kOfHand = {actionIndex("grab"), actionIndex("fly"), actionIndex("point_at")};

constexpr std::array kPointing = {actionIndex("point_at")};

bool holdsOneOf(const actions::ActionCounts& counts, std::span<const std::size_t> actions) {
  return std::any_of(actions.begin(), actions.end(), [&](std::size_t i) { return counts.held[i]; });
}

// Whether the actions of this source belong to the hand: it is the glove that the hand wears, or
// the ball whose buttons the hand holds.
bool isOfHand(const shm::DeviceSlots& devices, const FollowedHand& hand,
              const std::string& source) {
  const auto* const glove = devices.glove(hand.glove);
  return (glove && glove->name == source) || (!hand.buttons.empty() && hand.buttons == source);
}

// Whether a source that belongs to the hand holds one of the actions `of`.
bool holdsOneOf(const shm::DeviceSlots& devices, const actions::Actions& actions,
                const FollowedHand& hand, std::span<const std::size_t> of) {
  for (std::size_t i = 0; i < devices.actions.size(); ++i) {
    if (isOfHand(devices, hand, devices.actions[i].source) && holdsOneOf(actions.by_source[i], of))
      return true;
  }
  return false;
}

render::scene::HeldMotion motionOf(const actions::ActionCounts& used) {
  const auto between = [&](std::size_t minus, std::size_t plus) {
    return static_cast<int>(used.held[plus]) - static_cast<int>(used.held[minus]);
  };
  return {.right = between(actionIndex("move_left"), actionIndex("move_right")),
          .up = between(actionIndex("move_down"), actionIndex("move_up")),
          .nearer = between(actionIndex("zoom_out"), actionIndex("zoom_in")),
          .turn_right = between(actionIndex("turn_left"), actionIndex("turn_right")),
          .turn_up = between(actionIndex("turn_down"), actionIndex("turn_up")),
          .roll_right = between(actionIndex("roll_left"), actionIndex("roll_right"))};
}

// Returns the index in kAlignActions of an action, which is an index into kActions;
// kAlignActionCount if it is not there.
std::uint8_t alignActionOf(std::size_t action) {
  if (action >= kActions.size()) return kAlignActionCount;  // written by a newer release
  const auto* const found = std::find(std::begin(kAlignActions), std::end(kAlignActions),
                                      std::string_view(kActions[action]));
  return static_cast<std::uint8_t>(found - std::begin(kAlignActions));
}

bool isGlove(const shm::DeviceSlots& devices, const std::string& name) {
  return std::any_of(devices.gloves.begin(), devices.gloves.end(),
                     [&](const auto& glove) { return glove.name == name; });
}

bool isTouchSurface(const shm::DeviceSlots& devices, const std::string& name) {
  return std::any_of(devices.touches.begin(), devices.touches.end(),
                     [&](const auto& touch) { return touch.name == name; });
}

bool blanksOrFreezes(const actions::ActionCounts& counts) {
  return counts.begun[actionIndex("blank")] > 0 || counts.begun[actionIndex("freeze")] > 0;
}

void takeBegun(const actions::ActionCounts& used, WallInput& input) {
  const auto begun = [&](std::size_t action) { return used.begun[action]; };
  input.scene.reset_view = begun(actionIndex("reset_view"));
  input.scene.next_mode = begun(actionIndex("next_mode"));
  input.next_content = begun(actionIndex("next_content"));
  input.previous_content = begun(actionIndex("previous_content"));
  input.snapshot = begun(actionIndex("snapshot"));
  input.blank = begun(actionIndex("blank"));
  input.freeze = begun(actionIndex("freeze"));
}

bool acts(const actions::ActionCounts& counts) {
  const auto begins = [](std::uint32_t n) { return n > 0; };
  return std::any_of(counts.begun.begin(), counts.begun.end(), begins) ||
         std::find(counts.held.begin(), counts.held.end(), true) != counts.held.end();
}

}  // namespace

template <typename T>
std::optional<T> DeviceFeed::fresh(const shm::Channel<T>& channel,
                                   const shm::SeqSlot<DeviceHealth>& slot, Timestamp now) {
  const auto sample = channel.newest();
  const auto health = slot.read();
  if (!sample || !health) return std::nullopt;
  const bool well = health->state == HealthState::kOk &&
                    now - fromNanoseconds(health->updated_ns) < settings_.stale_after * 2;
  if (!well && now - fromNanoseconds(health->since_ns) >= settings_.stale_after)
    return std::nullopt;
  const Duration age = now - fromNanoseconds(sample->received_ns);
  age_ = std::min(age, age_.value_or(age));
  return sample;
}

// Returns the person to whom a device or a hand belongs; "" if none is configured.
std::string DeviceFeed::personOf(const std::string& device) const {
  const auto found = std::find_if(settings_.devices.begin(), settings_.devices.end(),
                                  [&](const OwnedDevice& d) { return d.device == device; });
  if (found != settings_.devices.end()) return found->person;
  const auto hand = std::find_if(settings_.hands.begin(), settings_.hands.end(),
                                 [&](const FollowedHand& h) { return h.name == device; });
  return hand == settings_.hands.end() ? std::string() : hand->person;
}

bool DeviceFeed::counts(const std::string& device) const {
  return !holder_ || personOf(device) == *holder_;
}

std::optional<TrackerSample> DeviceFeed::station(const shm::DeviceSlots& devices,
                                                 const FollowedStation& place, Timestamp now) {
  const auto* const tracker = devices.tracker(place.tracker);
  if (!tracker || place.station < 1) return std::nullopt;
  const auto index = static_cast<std::size_t>(place.station - 1);
  const auto sample = fresh(*tracker->stations[index], *tracker->health, now);
  if (!sample || now - fromNanoseconds(sample->received_ns) > settings_.stale_after)
    return std::nullopt;
  return sample;
}

std::optional<BallSample> DeviceFeed::readBall(const shm::DeviceSlots::Ball& slots, Timestamp now) {
  auto ball = fresh(*slots.samples, *slots.health, now);
  if (ball && pushed(*ball) && now - fromNanoseconds(ball->received_ns) > kPushLasts) {
    std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
    std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
  }
  return ball;
}

// Reads balls, touch surfaces and actions. Held actions count only while their device works, since
// a process that has ended cannot release them.
DeviceFeed::Acts DeviceFeed::readActs(const shm::DeviceSlots& devices, Timestamp now) {
  Acts acts;
  acts.actions = actions_.read(devices);
  const auto ends = [&](const std::string& device) {
    for (std::size_t i = 0; i < devices.actions.size(); ++i) {
      if (devices.actions[i].source == device) acts.actions.by_source[i].held = {};
    }
  };
  for (const auto& ball : devices.balls) {
    acts.balls.push_back(readBall(ball, now));
    if (!acts.balls.back() || leaves_out_ball_) ends(ball.name);
  }
  // After a restart, the process of the devices counts fingers and the wheel's notches from 0
  // again.
  const std::uint64_t run = devices.header->generation;
  if (std::exchange(touches_of_, run) != run) touches_.clear();
  touches_.resize(devices.touches.size());
  for (std::size_t i = 0; i < devices.touches.size(); ++i) {
    const auto touch = fresh(*devices.touches[i].samples, *devices.touches[i].health, now);
    acts.touches.push_back(touches_[i].update(touch ? &*touch : nullptr));
    if (!touch) ends(devices.touches[i].name);
  }
  for (const auto& glove : devices.gloves) {
    const auto sample = fresh(*glove.samples, *glove.health, now);
    if (!sample || now - fromNanoseconds(sample->received_ns) > settings_.stale_after)
      ends(glove.name);
  }
  return acts;
}

void DeviceFeed::takeTurns(const shm::DeviceSlots& devices, const Acts& now_acts, Timestamp now) {
  std::vector<std::string> acting;
  for (std::size_t i = 0; i < devices.balls.size(); ++i) {
    if (now_acts.balls[i] && pushed(*now_acts.balls[i]))
      acting.push_back(personOf(devices.balls[i].name));
  }
  for (std::size_t i = 0; i < devices.touches.size(); ++i) {
    if (now_acts.touches[i].fingers > 0 || now_acts.touches[i].moves())
      acting.push_back(personOf(devices.touches[i].name));
  }
  for (std::size_t i = 0; i < devices.actions.size(); ++i) {
    const bool panel = i + 1 == devices.actions.size();
    if (!panel && acts(now_acts.actions.by_source[i]))
      acting.push_back(personOf(devices.actions[i].source));
  }
  holder_ = turns_.update(now, acting);
}

// Returns the index of the acting hand; settings_.hands.size() if there is none. The hand that
// acted last remains the acting one while it holds an action, so that a second hand does not take
// over the model; but a hand that moves the model takes over from one that only points.
std::size_t DeviceFeed::handThatActs(const shm::DeviceSlots& devices,
                                     const actions::Actions& actions) {
  const auto holds = [&](std::size_t hand, std::span<const std::size_t> of) {
    return holdsOneOf(devices, actions, settings_.hands[hand], of);
  };
  const auto mayAct = [&](std::size_t hand) {
    return !holder_ || settings_.hands[hand].person == *holder_;
  };
  const std::size_t count = settings_.hands.size();
  using Held = std::span<const std::size_t>;
  for (const Held of : {Held(kMoving), Held(kOfHand)}) {
    if (hand_ < count && mayAct(hand_) && holds(hand_, of)) return hand_;
    for (std::size_t i = 0; i < count; ++i) {
      if (mayAct(i) && holds(i, of)) return i;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (mayAct(i)) return i;
  }
  return count;
}

void DeviceFeed::readHand(const shm::DeviceSlots& devices, const actions::Actions& actions,
                          Timestamp now, WallInput& input) {
  const std::size_t acting = handThatActs(devices, actions);
  for (std::size_t i = 0; i < settings_.hands.size(); ++i) {
    const FollowedHand& hand = settings_.hands[i];
    if (i == acting || !holdsOneOf(devices, actions, hand, kPointing)) continue;
    if (const auto other = predicted(devices, hand, now))
      input.scene.other_pointers.push_back(*other);
  }
  if (acting >= settings_.hands.size()) return;
  other_hand_ = std::exchange(hand_, acting) != acting;
  input.scene.hand = predicted(devices, settings_.hands[hand_], now);
  readPosture(devices, settings_.hands[hand_].glove, now, input);
}

// Returns the sample of the hand's station, with the pose predicted for the time when the next
// frame is visible; nothing if the station delivers none.
std::optional<TrackerSample> DeviceFeed::predicted(const shm::DeviceSlots& devices,
                                                   const FollowedHand& followed, Timestamp now) {
  auto hand = station(devices, followed.place, now);
  if (hand && until_visible_ > Duration::zero())
    predictPose(devices.hand(followed.name), now + until_visible_, *hand);
  return hand;
}

void DeviceFeed::readPosture(const shm::DeviceSlots& devices, const std::string& name,
                             Timestamp now, WallInput& input) {
  const auto* const glove = devices.glove(name);
  if (!glove) return;
  const auto shown = fresh(*glove->posture, *glove->health, now);
  if (!shown || now - fromNanoseconds(shown->received_ns) > settings_.stale_after) return;
  const auto held = glove->posture_state->read();
  static_assert(sizeof held->name == sizeof input.posture);
  if (held) std::copy(std::begin(held->name), std::end(held->name), input.posture.begin());
}

// Whether `source` is the glove or the ball (whose buttons are held) of another hand than the
// acting one, or a glove on no hand while the acting hand wears another glove. The actions grab,
// fly and point_at of such a source are ignored.
bool DeviceFeed::isOfAnotherHand(const shm::DeviceSlots& devices, const std::string& source) const {
  if (hand_ >= settings_.hands.size()) return false;
  const FollowedHand& acting = settings_.hands[hand_];
  if (isOfHand(devices, acting, source)) return false;
  return (devices.glove(acting.glove) && isGlove(devices, source)) ||
         std::ranges::any_of(settings_.hands, [&](const FollowedHand& hand) {
           return isOfHand(devices, hand, source);
         });
}

// Sets the part of `input` that comes from actions. Returns whether align_push is held, i.e. the
// ball moves a corner.
bool DeviceFeed::useActions(const shm::DeviceSlots& devices, const actions::Actions& actions,
                            WallInput& input) {
  actions::ActionCounts used;
  for (std::size_t i = 0; i < devices.actions.size(); ++i) {
    const std::string& source = devices.actions[i].source;
    const bool panel = i + 1 == devices.actions.size();
    if (!panel && !counts(source)) continue;
    actions::ActionCounts counts = actions.by_source[i];
    input.operator_panel += counts.begun[actionIndex("operator_panel")];
    if (isOfAnotherHand(devices, source)) {
      for (const std::size_t action : kOfHand) counts.held[action] = false;
    }
    const bool left_out = leaves_out_ball_ && devices.ball(source);
    if (left_out) counts.begun = {};
    input.by_fingers |= blanksOrFreezes(counts) && isTouchSurface(devices, source);
    used.add(counts);
    for (const std::size_t action : actions.in_order_by_source[i]) {
      const std::uint8_t align = alignActionOf(action);
      if (align < kAlignActionCount && !left_out) input.align.actions.push_back(align);
    }
  }
  // When another hand takes over the model, the model is released for one frame, so that the new
  // hand moves it from its present position.
  if (other_hand_ && moved_) {
    for (const std::size_t action : kMoving) used.held[action] = false;
  }
  moved_ = holdsOneOf(used, kMoving);
  input.scene.grab = used.held[actionIndex("grab")];
  input.scene.fly = used.held[actionIndex("fly")];
  input.scene.point_at = used.held[actionIndex("point_at")];
  input.scene.held = motionOf(used);
  takeBegun(used, input);
  return used.held[actionIndex("align_push")];
}

// Moves the selected corner by the ball's push if align_push is held (`held`); the ball then does
// not move the scene. A full push moves the corner at kFullPush_px_s; the speed grows with the cube
// of the push, so that small pushes move it by fractions of a pixel.
void DeviceFeed::moveCorner(Duration since_last, bool held, WallInput& input) const {
  auto& ball = input.scene.ball;
  if (!held || !ball) return;
  constexpr double kFullPush_px_s = 60;
  const double seconds = std::min(toSeconds(since_last), 0.1);  // limited if a frame took long
  const auto moved = [&](float push) {
    return kFullPush_px_s * seconds * static_cast<double>(push * push * push);
  };
  input.align.push = {moved(ball->translation[0]), -moved(ball->translation[1])};
  std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
  std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
}

// Uses the motion of the surface with the most fingers, and adds the turns of mouse wheels.
void DeviceFeed::readTouches(const shm::DeviceSlots& devices, const Acts& acts,
                             render::scene::TouchMotion& used) const {
  float by_wheel = 0;
  for (std::size_t i = 0; i < devices.touches.size(); ++i) {
    const auto& touch = acts.touches[i];
    if (!counts(devices.touches[i].name)) continue;
    if (touch.fingers == 0) by_wheel += touch.spread;
    if (touch.fingers > used.fingers) used = touch;
  }
  used.spread += by_wheel;
}

WallInput DeviceFeed::read(Timestamp now) {
  WallInput input;
  const Duration since_last = now - std::exchange(last_read_, now).value_or(now);
  age_.reset();
  other_hand_ = false;
  const shm::DeviceSlots* d = devices_.get(now);
  if (!d) return input;
  const Acts acts = readActs(*d, now);
  takeTurns(*d, acts, now);
  for (std::size_t i = 0; i < d->balls.size(); ++i) {
    const auto& ball = acts.balls[i];
    if (!ball || !counts(d->balls[i].name)) continue;
    const bool replaces = input.scene.ball && pushed(*ball) && !pushed(*input.scene.ball);
    if (!input.scene.ball || replaces) input.scene.ball = ball;
  }
  readTouches(*d, acts, input.scene.touch);
  readHand(*d, acts.actions, now, input);
  if (settings_.head.station > 0) input.head = station(*d, settings_.head, now);
  const bool align = useActions(*d, acts.actions, input);
  moveCorner(since_last, align, input);
  return input;
}

}  // namespace merlin::wall
