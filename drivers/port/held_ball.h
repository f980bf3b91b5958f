// HeldBall: publishes a ball's samples, and publishes a push again while it is held. A device that
// only tells of changes is silent meanwhile, and whoever reads the samples takes an old push for
// one whose release was lost; what a held button does later has to be begun then.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

// Part of a driver; as thread-bound as the driver. Allocates nothing.
class HeldBall {
 public:
  explicit HeldBall(SampleSink& sink) : sink_(sink) {}

  // To be filled in before publish(), except for its times and its counter.
  BallSample& sample() noexcept { return sample_; }
  bool pushed() const noexcept;

  // Publishes the sample as measured at `at`.
  void publish(Timestamp at) noexcept;
  // Publishes it again if the ball is pushed and has not published for kAgain; calls the sink's
  // tick() when it is due.
  void hold(Timestamp now) noexcept;
  // Longest time for which the driver may wait for bytes before it calls hold().
  Duration wait(Timestamp now) const noexcept;

  // For a new connection: buttons and pushes of an earlier one are over.
  void restart() noexcept;
  // At the end of open(): publishes the sample if nothing was published since restart() and what
  // was published before held a button or a push, whose end nobody has seen.
  void settle(Timestamp now) noexcept;
  std::uint64_t samples() const noexcept { return samples_; }  // published, over all connections

  static constexpr Duration kAgain = std::chrono::milliseconds(50);  // as a Spaceball sends pushes

 private:
  SampleSink& sink_;
  BallSample sample_{};
  bool held_ = false;   // the newest sample that was published holds a button or a push
  bool ended_ = false;  // which is over, but not published
  std::uint64_t samples_ = 0;
};

}  // namespace merlin
