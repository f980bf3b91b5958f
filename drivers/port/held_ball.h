// HeldBall: publishes a ball's samples, and publishes a push again while it is held. A device that
// reports only changes is silent meanwhile, but readers of the samples take an old push for one
// whose release was lost. For the same reason the driver has to trigger the later effects of a held
// button.
#pragma once

#include <cstdint>

#include "daemon/base/clock.h"
#include "drivers/port/sample_sink.h"

namespace merlin {

// Part of a driver; as thread-bound as the driver. Allocates nothing.
class HeldBall {
 public:
  explicit HeldBall(SampleSink& sink) : sink_(sink) {}

  // Returns the sample, which the driver fills in before publish(), except for its times and its
  // counter.
  BallSample& sample() noexcept { return sample_; }
  // Returns whether the sample has a push or a twist.
  bool pushed() const noexcept;

  // Publishes the sample as measured at `at`.
  void publish(Timestamp at) noexcept;
  // Publishes the sample again if the ball is pushed and nothing was published for kAgain; calls
  // the sink's tick() when that is due.
  void hold(Timestamp now) noexcept;
  // Returns the longest time for which the driver may wait for bytes before it calls hold().
  Duration wait(Timestamp now) const noexcept;

  // Begins a new connection: buttons and pushes of an earlier one have ended.
  void restart() noexcept;
  // To be called at the end of open(). Publishes the sample if none was published since restart()
  // and the last one before had a button or push, whose end would not be seen otherwise.
  void settle(Timestamp now) noexcept;
  std::uint64_t samples() const noexcept { return samples_; }  // number over all connections

  static constexpr Duration kAgain = std::chrono::milliseconds(50);  // as a Spaceball sends pushes

 private:
  SampleSink& sink_;
  BallSample sample_{};
  bool held_ = false;   // the newest published sample has a button or a push
  bool ended_ = false;  // they ended with a connection, which was not published yet
  std::uint64_t samples_ = 0;
};

}  // namespace merlin
