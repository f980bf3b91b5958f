#include "daemon/wall/device_feed.h"

#include <algorithm>

#include "daemon/base/commands.h"
#include "drivers/hand/hand.h"

namespace merlin::wall {
namespace {

// A pushed ball sends at least this often; a push that is older is a lost "let go".
constexpr Duration kPushLasts = std::chrono::milliseconds(500);

bool pushed(const BallSample& b) {
  const auto moves = [](float v) { return v != 0; };
  return std::any_of(std::begin(b.translation), std::end(b.translation), moves) ||
         std::any_of(std::begin(b.rotation), std::end(b.rotation), moves);
}

// The smoothed hand of the same record, if the devices' side wears that station as its hand.
void foresee(const shm::DevicesSegment& devices, Timestamp seen, TrackerSample& hand) {
  const auto h = devices.hand.newest();
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

void DeviceFeed::readPosture(const shm::DevicesSegment& devices, Timestamp now, WallInput& input) {
  const auto shown = fresh(devices.posture, devices.health[shm::kGlove], now);
  if (!shown || now - fromNanoseconds(shown->received_ns) > stale_after_) return;
  const auto held = devices.posture_state.read();
  static_assert(sizeof held->name == sizeof input.posture);
  if (held) std::copy(std::begin(held->name), std::end(held->name), input.posture.begin());
}

// Held actions count only while their device works: a process that has ended cannot release them.
void DeviceFeed::readActions(const shm::DevicesSegment& devices, Timestamp now, WallInput& input) {
  const auto glove = fresh(devices.glove, devices.health[shm::kGlove], now);
  const bool glove_works = glove && now - fromNanoseconds(glove->received_ns) <= stale_after_;
  const actions::Actions actions = actions_.read(
      devices,
      {glove_works, fresh(devices.ball, devices.health[shm::kBall], now).has_value(), true});
  const auto begun = [&](std::size_t action) { return actions.begun[action]; };
  const auto held = [&](std::size_t action) { return actions.held[action]; };
  input.scene.grab = held(actionIndex("grab"));
  input.scene.fly = held(actionIndex("fly"));
  input.scene.point_at = held(actionIndex("point_at"));
  input.scene.reset_view = begun(actionIndex("reset_view"));
  input.scene.next_mode = begun(actionIndex("next_mode"));
  input.next_content = begun(actionIndex("next_content"));
  input.snapshot = begun(actionIndex("snapshot"));
}

WallInput DeviceFeed::read(Timestamp now) {
  WallInput input;
  age_.reset();
  const shm::DevicesSegment* d = devices_.get(now);
  if (!d) return input;
  auto& ball = input.scene.ball;
  ball = fresh(d->ball, d->health[shm::kBall], now);
  if (ball && pushed(*ball) && now - fromNanoseconds(ball->received_ns) > kPushLasts) {
    std::fill(std::begin(ball->translation), std::end(ball->translation), 0.0F);
    std::fill(std::begin(ball->rotation), std::end(ball->rotation), 0.0F);
  }
  auto& hand = input.scene.hand;
  const auto station = static_cast<std::size_t>(hand_station_ - 1);
  hand = fresh(d->tracker[station], d->health[shm::kTracker], now);
  if (hand && now - fromNanoseconds(hand->received_ns) > stale_after_) hand.reset();
  if (hand && ahead_ > Duration::zero()) foresee(*d, now + ahead_, *hand);
  readPosture(*d, now, input);
  readActions(*d, now, input);
  return input;
}

}  // namespace merlin::wall
