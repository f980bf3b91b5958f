#include "daemon/wall/device_feed.h"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/base/commands.h"
#include "drivers/hand/hand.h"

namespace merlin::wall {
namespace {

// A ball that is pushed sends samples at least this often. If the last sample is an older push, the
// sample of its release was lost, and the push is ignored.
constexpr Duration kPushLasts = std::chrono::milliseconds(500);

bool pushed(const BallSample& b) {
  const auto moves = [](float v) { return v != 0; };
  return std::any_of(std::begin(b.translation), std::end(b.translation), moves) ||
         std::any_of(std::begin(b.rotation), std::end(b.rotation), moves);
}

// Replaces the hand's pose by the one predicted for the time `seen`, if shared memory has a
// smoothed hand that was computed from the same tracker sample.
void predictPose(const shm::DeviceSlots& devices, Timestamp seen, TrackerSample& hand) {
  const auto h = devices.hand->newest();
  if (!h || h->received_ns != hand.received_ns) return;
  const hand::Pose pose = hand::poseAt(*h, seen);
  std::copy(pose.position_m.begin(), pose.position_m.end(), hand.position_m);
  std::copy(pose.orientation_wxyz.begin(), pose.orientation_wxyz.end(), hand.orientation_wxyz);
}

}  // namespace

template <typename T>
std::optional<T> DeviceFeed::fresh(const shm::Channel<T>& channel,
                                   const shm::SeqSlot<DeviceHealth>& slot, Timestamp now) {
  const auto sample = channel.newest();
  const auto health = slot.read();
  if (!sample || !health) return std::nullopt;
  const bool well = health->state == HealthState::kOk &&
                    now - fromNanoseconds(health->updated_ns) < stale_after_ * 2;
  if (!well && now - fromNanoseconds(health->since_ns) >= stale_after_) return std::nullopt;
  const Duration age = now - fromNanoseconds(sample->received_ns);
  age_ = std::min(age, age_.value_or(age));
  return sample;
}

std::optional<TrackerSample> DeviceFeed::station(const shm::DeviceSlots& devices, int number,
                                                 Timestamp now) {
  const auto index = static_cast<std::size_t>(number - 1);
  const auto sample = fresh(*devices.tracker[index], *devices.tracker_health, now);
  if (!sample || now - fromNanoseconds(sample->received_ns) > stale_after_) return std::nullopt;
  return sample;
}

void DeviceFeed::readPosture(const shm::DeviceSlots& devices, Timestamp now, WallInput& input) {
  const auto shown = fresh(*devices.posture, *devices.glove_health, now);
  if (!shown || now - fromNanoseconds(shown->received_ns) > stale_after_) return;
  const auto held = devices.posture_state->read();
  static_assert(sizeof held->name == sizeof input.posture);
  if (held) std::copy(std::begin(held->name), std::end(held->name), input.posture.begin());
}

// Held actions count only while their device works: a process that has ended cannot release them.
// Returns whether the ball moves a corner.
bool DeviceFeed::readActions(const shm::DeviceSlots& devices, Timestamp now, WallInput& input) {
  const auto glove = fresh(*devices.glove, *devices.glove_health, now);
  const bool glove_works = glove && now - fromNanoseconds(glove->received_ns) <= stale_after_;
  const bool ball_works = fresh(*devices.ball, *devices.ball_health, now).has_value();
  const actions::Actions actions =
      actions_.read(devices, {glove_works, ball_works && !leaves_out_ball_, true});
  const auto begun = [&](std::size_t action) {
    const std::uint32_t by_ball = actions.begun_by[shm::kBallActions][action];
    return actions.begun[action] - (leaves_out_ball_ ? by_ball : 0);
  };
  const auto held = [&](std::size_t action) { return actions.held[action]; };
  input.scene.grab = held(actionIndex("grab"));
  input.scene.fly = held(actionIndex("fly"));
  input.scene.point_at = held(actionIndex("point_at"));
  input.scene.reset_view = begun(actionIndex("reset_view"));
  input.scene.next_mode = begun(actionIndex("next_mode"));
  input.operator_panel = actions.begun[actionIndex("operator_panel")];
  input.next_content = begun(actionIndex("next_content"));
  input.snapshot = begun(actionIndex("snapshot"));
  input.blank = begun(actionIndex("blank"));
  input.freeze = begun(actionIndex("freeze"));
  constexpr std::array kAlign = {actionIndex("align_output_next"), actionIndex("align_corner_next"),
                                 actionIndex("align_left"),        actionIndex("align_right"),
                                 actionIndex("align_up"),          actionIndex("align_down"),
                                 actionIndex("align_undo"),        actionIndex("align_redo"),
                                 actionIndex("next_testcard")};
  static_assert(kAlign.size() == kAlignActionCount);
  for (std::size_t i = 0; i < kAlign.size(); ++i) input.align.begun[i] = begun(kAlign[i]);
  return held(actionIndex("align_push"));
}

// A full push moves the selected corner by kFullPush_px_s; the speed grows with the cube of the
// push, so that fractions of a pixel can be set. Meanwhile the ball does not move the scene.
void DeviceFeed::moveCorner(Duration since_last, bool held, WallInput& input) const {
  auto& ball = input.scene.ball;
  if (!held || !ball) return;
  constexpr double kFullPush_px_s = 60;
  const double seconds = std::min(toSeconds(since_last), 0.1);  // limited after a long frame
  const auto moved = [&](float push) {
    return kFullPush_px_s * seconds * static_cast<double>(push * push * push);
  };
  input.align.push = {moved(ball->translation[0]), -moved(ball->translation[1])};
  std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
  std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
}

WallInput DeviceFeed::read(Timestamp now) {
  WallInput input;
  const Duration since_last = now - std::exchange(last_read_, now).value_or(now);
  age_.reset();
  const shm::DeviceSlots* d = devices_.get(now);
  if (!d) return input;
  auto& ball = input.scene.ball;
  ball = fresh(*d->ball, *d->ball_health, now);
  if (ball && pushed(*ball) && now - fromNanoseconds(ball->received_ns) > kPushLasts) {
    std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
    std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
  }
  auto& hand = input.scene.hand;
  hand = station(*d, hand_station_, now);
  if (head_station_ > 0) input.head = station(*d, head_station_, now);
  if (hand && ahead_ > Duration::zero()) predictPose(*d, now + ahead_, *hand);
  readPosture(*d, now, input);
  const bool align = readActions(*d, now, input);
  moveCorner(since_last, align, input);
  return input;
}

}  // namespace merlin::wall
