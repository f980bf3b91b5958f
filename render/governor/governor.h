// Governor: from the measured times of frames, computes the triangle budget of the next frame such
// that the requested frame rate is held.
//
// [GOURLEY98] 5.4, figure 5.36 divides the triangles drawn in the last second by the frame rate.
// That control law assumes a linear cost, reacts after a second and leaves no margin before the
// deadline, so a sixth of its frames are late. Here the cost of a frame is modelled as
//
//   work = a + c T^p       a: time to clear, read back and present, measured; T: triangles
//
// T is chosen such that the work fills the period except for a margin, the head room m (a share of
// the period). m is learnt: a late frame adds g (1 - q) to m, a frame in time subtracts g q, so
// that in the long run a share q of the frames is late. A single late frame may be an outlier and
// does not change the cost model. Two in a row change it at once, to the higher of its own cost and
// that of the frame, and the budget can only fall. A single frame that missed two deadlines
// changes it at once, too; this is undone if the next frame shows that it was an outlier. The
// budget grows slowly, and only if the gain exceeds a dead band. README.md has figures and sources.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "render/governor/settings.h"

namespace merlin::render::governor {

// One frame that was drawn while something moved.
struct FrameCost {
  std::size_t triangles = 0;  // requested number of triangles
  Duration fixed{};           // part of `work` that does not depend on the triangles
  // Time (> 0) from the frame's begin to its last pixel, as if no view had been drawn coarser to
  // save time. If longer than the period, the frame counts as one of the late frames in a row.
  Duration work{};
  bool late = false;  // the last pixel was finished after the deadline
};

// Pure; thread-bound. Cost of a call: under a microsecond.
class Governor {
 public:
  // REQUIRES: rate_hz > 0, 0 < min_triangles <= first_triangles <= max_triangles,
  // 0 < late_share < 1.
  explicit Governor(const GovernorSettings& settings) noexcept;

  // Returns the triangle budget of the next frame while something moves. A triangle of the model
  // counts once, however many tiles show it.
  std::size_t budget() const noexcept;

  // Returns the budget of a frame that has only `available` left until its deadline, because the
  // previous frame overran: the number of triangles that the cost model expects to fit, at most
  // budget(); 0 if not even least() fit. Returns budget() if it is held, before the first
  // measurement, and if almost the whole period is left.
  std::size_t budgetFor(Duration available) const noexcept;

  // Returns the number of triangles of a frame that takes `work` according to the cost model,
  // without head room and independent of the last budget, within least() and max_triangles. Returns
  // budget() before the first measurement.
  std::size_t costWithin(Duration work) const noexcept;

  // Learns from a frame that was drawn while something moved, and sets the budget of the next one.
  // REQUIRES: cost.work > 0, 0 <= cost.fixed <= cost.work.
  void observe(const FrameCost& cost) noexcept;

  // Fits the model to frames that were drawn only to measure their cost: a, c and, if triangle
  // counts differ by a factor of two or more, p. Sets the head room from the noise of these frames,
  // and the budget to what then fits. Requirements as for observe(). Without frames nothing
  // changes.
  void calibrate(std::span<const FrameCost> frames);

  // Feed-forward: from the next frame on, the same triangles take `ratio` times as long (since
  // another content or another view is shown). REQUIRES: ratio > 0, finite.
  void expect(double ratio) noexcept;

  // Fixes the budget to this number of triangles, clamped to least() and max_triangles, whatever
  // the frame time, until the next call; nullopt returns to the computed budget. The model
  // continues to learn meanwhile.
  void hold(std::optional<std::size_t> triangles) noexcept { held_ = triangles; }
  bool held() const noexcept { return held_.has_value(); }

  // Changes the frame rate. The model is kept, and the budget becomes what fits the new period.
  // REQUIRES: rate_hz > 0.
  void setRate(double rate_hz) noexcept;

  // To be called for a content whose detail is not measured in triangles, with the lowest cost at
  // which it is still recognisable: least() becomes the lower one of this and min_triangles.
  // nullopt: the content has triangles. REQUIRES: least_useful > 0.
  void setLeastUseful(std::optional<std::size_t> least_useful) noexcept;

  // Replaces the limits and the share of late frames, but not the rate, which setRate() changes.
  // The model is kept, and the budget stays as far as the limits allow. REQUIRES: validate() finds
  // nothing.
  void setLimits(const GovernorSettings& settings) noexcept;

  // Returns the time that the cost model expects for `triangles` [s].
  double predict(std::size_t triangles) const noexcept;

  double headRoom() const noexcept { return head_room_; }  // share of the period
  double fixedSeconds() const noexcept { return fixed_; }  // a
  double coefficient() const noexcept { return per_; }     // c; 0 before the first frame
  double exponent() const noexcept { return exponent_; }   // p
  Duration period() const noexcept { return period_; }
  // Returns the lower limit of the budget for the content that is shown.
  std::size_t least() const noexcept {
    return std::min(settings_.min_triangles, least_useful_.value_or(settings_.min_triangles));
  }
  // Returns the upper limit of the budget.
  std::size_t most() const noexcept { return settings_.max_triangles; }
  // Returns the lowest frame rate that the caller may set because frames are late.
  double minRateHz() const noexcept { return settings_.min_rate_hz; }

 private:
  struct Model {
    double fixed, per, triangles;
  };
  void learnHeadRoom(bool late) noexcept;
  void learnFixed(double fixed) noexcept;
  void learnCost(const FrameCost& cost) noexcept;
  void learnFrom(double size, double now) noexcept;
  void learnExponent(double size, double off) noexcept;
  void follow(double now) noexcept;
  double unrest() const noexcept;
  void jumpTo(double per) noexcept;
  void actOnTheWorst(double fixed, double per) noexcept;
  void takeBack() noexcept;
  void startOver() noexcept;
  void choose() noexcept;
  double clamped(double triangles) const noexcept;
  double trianglesIn(double seconds) const noexcept;
  double fitting(double seconds) const noexcept;

  GovernorSettings settings_;
  Duration period_;
  double triangles_;
  std::optional<std::size_t> held_;
  std::optional<std::size_t> least_useful_;
  double head_room_;
  double exponent_;
  double fixed_ = 0;
  double per_ = 0;                // c; follows exp(trend_), but not its noise
  double noise_ = 0;              // estimated median distance of a frame's ln c from the trend
  double trend_ = 0, slope_ = 0;  // filtered ln c, and its growth per frame
  std::array<double, 3> fixed_seen_{};  // a of the last three frames [s]
  std::size_t seen_ = 0;
  double usual_ = 1;  // triangles of the last frame that was not much smaller than those before it
  bool was_smaller_ = false;
  int late_in_a_row_ = 0;
  std::optional<Model> before_;  // the model before a single late frame changed it
};

}  // namespace merlin::render::governor
