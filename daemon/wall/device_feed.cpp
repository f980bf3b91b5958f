#include "daemon/wall/device_feed.h"

#include <algorithm>

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

render::SceneInput DeviceFeed::read(Timestamp now) {
  render::SceneInput input;
  age_.reset();
  const shm::DevicesSegment* d = devices_.get(now);
  if (!d) return input;
  input.ball = fresh(d->ball, d->health[shm::kBall], now);
  if (input.ball && pushed(*input.ball) &&
      now - fromNanoseconds(input.ball->received_ns) > kPushLasts) {
    std::fill(std::begin(input.ball->translation), std::end(input.ball->translation), 0.0F);
    std::fill(std::begin(input.ball->rotation), std::end(input.ball->rotation), 0.0F);
  }
  const auto station = static_cast<std::size_t>(hand_station_ - 1);
  input.hand = fresh(d->tracker[station], d->health[shm::kTracker], now);
  input.glove = fresh(d->glove, d->health[shm::kGlove], now);
  input.posture = fresh(d->posture, d->health[shm::kGlove], now);
  // The line may live while the glove is silent: a posture nobody shows any more lets go.
  if (input.posture && now - fromNanoseconds(input.posture->received_ns) > stale_after_)
    input.posture.reset();
  // What is held, rather than what one record shows; another machine's samples have the latter
  // only.
  if (const auto held = d->posture_state.read(); held && input.posture) {
    std::copy(std::begin(held->name), std::end(held->name), input.posture->name);
    input.posture->code = held->code;
    input.posture->since_ns = held->since_ns;
  }
  if (input.hand && now - fromNanoseconds(input.hand->received_ns) > stale_after_)
    input.hand.reset();
  if (input.hand && ahead_ > Duration::zero()) foresee(*d, now + ahead_, *input.hand);
  return input;
}

}  // namespace merlin::wall
