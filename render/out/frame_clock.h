// Port: when a frame has to be there. A timer here; a display's vertical blank, or a time that
// several machines agreed on, are others.
//
// Frame k, counted from 0, begins at begin(k) and has to be with its outputs by deadline(k), which
// is when the next one begins. Late is what this clock says was late: nobody else compares times.
#pragma once

#include <cstdint>
#include <stop_token>

#include "daemon/base/clock.h"

namespace merlin::render {

// Thread-bound to the wall's thread.
class FrameClock {
 public:
  virtual ~FrameClock() = default;

  // Frames of `period` from now on: frame 0 begins at `from`, or as soon after it as this clock
  // can. REQUIRES: period > 0.
  virtual void start(Timestamp from, Duration period) = 0;

  virtual Duration period() const noexcept = 0;

  // Predicted, for a k that is still to come.
  virtual Timestamp begin(std::int64_t k) const noexcept = 0;
  Timestamp deadline(std::int64_t k) const noexcept { return begin(k + 1); }

  // The newest frame whose begin has come at `now`; -1 before frame 0.
  virtual std::int64_t frameAt(Timestamp now) const noexcept = 0;

  // Waits until frame k begins. False within 50 ms of a stop that is asked for.
  virtual bool waitFor(std::int64_t k, const std::stop_token& stop) noexcept = 0;

  // An output says when frame k was shown, so that predictions follow what it really does.
  virtual void shown(std::int64_t k, Timestamp when) noexcept = 0;
};

// Frames by the machine's clock alone.
class TimerFrameClock final : public FrameClock {
 public:
  // `clock` outlives this.
  explicit TimerFrameClock(Clock& clock) noexcept : clock_(clock) {}

  void start(Timestamp from, Duration period) override {
    start_ = from;
    period_ = period;
  }
  Duration period() const noexcept override { return period_; }
  Timestamp begin(std::int64_t k) const noexcept override { return start_ + k * period_; }
  std::int64_t frameAt(Timestamp now) const noexcept override {
    return now < start_ ? -1 : (now - start_) / period_;
  }
  bool waitFor(std::int64_t k, const std::stop_token& stop) noexcept override {
    return clock_.sleepUntil(begin(k), stop);
  }
  // Nothing that is shown moves a timer.
  void shown(std::int64_t /*k*/, Timestamp /*when*/) noexcept override {}

 private:
  Clock& clock_;
  Timestamp start_{};
  Duration period_ = std::chrono::seconds(1);
};

}  // namespace merlin::render
