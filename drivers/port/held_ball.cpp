#include "drivers/port/held_ball.h"

#include <algorithm>
#include <iterator>

namespace merlin {
namespace {

constexpr Duration kIdleWait = std::chrono::milliseconds(250);  // as Device::poll() allows

}  // namespace

bool HeldBall::pushed() const noexcept {
  const auto moves = [](float share) { return share != 0; };
  return std::any_of(std::begin(sample_.translation), std::end(sample_.translation), moves) ||
         std::any_of(std::begin(sample_.rotation), std::end(sample_.rotation), moves);
}

void HeldBall::publish(Timestamp at) noexcept {
  const std::int64_t ns = toNanoseconds(at);
  constexpr std::int64_t kLongest_us = 10'000'000;
  const std::int64_t since_us = (ns - sample_.received_ns) / 1000;
  sample_.period_us =
      static_cast<std::uint32_t>(std::clamp<std::int64_t>(since_us, 0, kLongest_us));
  sample_.received_ns = ns;
  ++sample_.counter;
  ++samples_;
  ended_ = false;
  held_ = pushed() || sample_.buttons != 0 || sample_.keys[0] != 0;
  sink_.publish(sample_);
}

void HeldBall::hold(Timestamp now) noexcept {
  if (pushed() && now - fromNanoseconds(sample_.received_ns) >= kAgain) publish(now);
  tickIfDue(sink_, now);
}

Duration HeldBall::wait(Timestamp now) const noexcept {
  return untilDue(sink_, now, pushed() ? kAgain : kIdleWait);
}

void HeldBall::restart() noexcept {
  const BallSample last = sample_;
  sample_ = {};
  sample_.counter = last.counter;
  sample_.received_ns = last.received_ns;
  ended_ = held_;
}

void HeldBall::settle(Timestamp now) noexcept {
  if (ended_) publish(now);
}

}  // namespace merlin
