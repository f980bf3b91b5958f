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
  sink_.publish(sample_);
}

void HeldBall::hold(Timestamp now) noexcept {
  if (pushed() && now - fromNanoseconds(sample_.received_ns) >= kAgain) publish(now);
}

Duration HeldBall::wait() const noexcept { return pushed() ? kAgain : kIdleWait; }

void HeldBall::restart() noexcept {
  const BallSample last = sample_;
  sample_ = {};
  sample_.counter = last.counter;
  sample_.received_ns = last.received_ns;
}

}  // namespace merlin
