// FrameClock: the port (an interface) that says when each frame begins and when it is due.
// Implemented here by TimerFrameClock, a timer, and VblankFrameClock, which follows a display's
// vertical blanks.
//
// Frame k, counted from 0, begins at begin(k) and must have reached its outputs by deadline(k),
// which is when the next frame begins. This clock alone defines the deadlines by which frames count
// as late.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "daemon/base/clock.h"

namespace merlin::render::out {

// Thread-bound to the wall's thread.
class FrameClock {
 public:
  virtual ~FrameClock() = default;

  // Starts a sequence of frames with this period: frame 0 begins at `from`, or as soon after it as
  // this clock can. REQUIRES: period > 0.
  virtual void start(Timestamp from, Duration period) = 0;

  virtual Duration period() const noexcept = 0;

  // Returns when frame k begins; for a frame still to come, this is a prediction.
  virtual Timestamp begin(std::int64_t k) const noexcept = 0;
  Timestamp deadline(std::int64_t k) const noexcept { return begin(k + 1); }

  // Returns the number of the frame that is current at `now`; -1 before frame 0.
  virtual std::int64_t frameAt(Timestamp now) const noexcept = 0;

  // Waits until frame k begins and returns true, or returns false within 50 ms of a stop request.
  virtual bool waitFor(std::int64_t k, const std::stop_token& stop) noexcept = 0;

  // Reports when frame k was shown, so that the clock can correct its predictions.
  virtual void shown(std::int64_t k, Timestamp when) noexcept = 0;
};

// A display's vertical blanks: one at `last`, and one every `period` [> 0] before and after it.
struct Vblank {
  Timestamp last{};
  Duration period{};
};

// Frames timed by a Clock alone.
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
  // A timer does not adapt to when frames were shown.
  void shown(std::int64_t /*k*/, Timestamp /*when*/) noexcept override {}

 private:
  Clock& clock_;
  Timestamp start_{};
  Duration period_ = std::chrono::seconds(1);
};

// Frames that begin with every n-th vertical blank of a display (n >= 1), if the requested period
// is within 3 % of n of the display's periods. Otherwise, or if the display's last known blank is
// more than ten seconds old, frames are timed by a Clock alone. The begin of each frame is shifted
// towards the nearest blank by at most 1/16 of a period.
class VblankFrameClock final : public FrameClock {
 public:
  using Source = std::function<std::optional<Vblank>()>;
  // `clock` outlives this. `source` is called once a frame and returns the display's last blank, or
  // nothing if none is known.
  VblankFrameClock(Clock& clock, Source source) : clock_(clock), source_(std::move(source)) {}

  void start(Timestamp from, Duration period) override;
  Duration period() const noexcept override { return period_; }
  Timestamp begin(std::int64_t k) const noexcept override {
    return base_ + (k - base_k_) * period_;
  }
  std::int64_t frameAt(Timestamp now) const noexcept override;
  bool waitFor(std::int64_t k, const std::stop_token& stop) noexcept override;
  // Ignored, since the display's vertical blanks already tell when frames are shown.
  void shown(std::int64_t /*k*/, Timestamp /*when*/) noexcept override {}

 private:
  void follow(std::int64_t k);

  Clock& clock_;
  Source source_;
  Duration asked_ = std::chrono::seconds(1), period_ = asked_;
  std::int64_t base_k_ = 0;  // number of the frame that begins at base_
  Timestamp base_{};
};

}  // namespace merlin::render::out
