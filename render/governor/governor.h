// Governor: frame times in, triangles for the next frame out, so that the rate asked is held.
//
// [GOURLEY98] 5.4, figure 5.36 divides last second's triangles a second by the rate. That
// law takes cost for linear, reacts after a second and aims at the deadline itself, so it is late
// in a sixth of its frames. Here the cost of a frame is modelled as
//
//   work = a + c T^p       a: clearing, read-back, presenting; measured. T: triangles.
//
// and T is chosen so that the work fills the period but for a head room m, which follows the share
// of late frames: late, m += g (1 - q); in time, m -= g q, so that in the long run a share q is
// late. One late frame may be a hiccup and changes nothing; two in a row act at once, on the worst
// figure seen, and never by growth; one that missed two deadlines acts alone, and is taken back if
// the next frame shows that it was a hiccup. Growth is gentle and waits for a gain worth it.
// README.md has figures and sources.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "render/governor/settings.h"

namespace merlin::render {

// One frame that was drawn while something moved.
struct FrameCost {
  std::size_t triangles = 0;  // that were asked for
  Duration fixed{};           // of `work`: what does not depend on the triangles
  Duration work{};            // from the frame's begin to its last pixel, as if nothing had given
                              // way; > 0. More than the period counts as late in a row
  bool late = false;          // its last pixel came after its deadline
};

// Pure; thread-bound. Cost of a call: under a microsecond.
class Governor {
 public:
  // REQUIRES: rate_hz > 0, 0 < min_triangles <= first_triangles <= max_triangles,
  // 0 < late_share < 1.
  explicit Governor(const GovernorSettings& settings) noexcept;

  // Triangles for the next moving frame, all tiles together counting the model once.
  std::size_t budget() const noexcept;

  // The same for a frame that has less than a period left, after one that ran over: what the model
  // says fits; 0 where not even the least does.
  std::size_t budgetFor(Duration available) const noexcept;

  // Triangles whose frame takes `work`, by the model alone: without head room, and however many
  // were drawn last; the budget before anything was measured.
  std::size_t trianglesWithin(Duration work) const noexcept;

  // REQUIRES: cost.work > 0, 0 <= cost.fixed <= cost.work.
  void observe(const FrameCost& cost) noexcept;

  // Frames drawn for measuring, before the first that counts: fits a, c and, where the triangles
  // differ by a factor of two or more, p; head room for their noise; the budget is what then fits.
  // Frames as observe() wants them; none at all changes nothing.
  void calibrate(std::span<const FrameCost> frames);

  // Feed-forward: from the next frame on, triangles cost `ratio` times what they did (a cut to
  // other content, or to another view). REQUIRES: ratio > 0, finite.
  void expect(double ratio) noexcept;

  // By hand: so many triangles, within the least and the most, whatever the time; nothing gives it
  // back to the law. The law goes on learning.
  void hold(std::optional<std::size_t> triangles) noexcept { held_ = triangles; }
  bool held() const noexcept { return held_.has_value(); }

  // Another rate; the model stays, the budget is what fits the new period. REQUIRES: rate_hz > 0.
  void setRate(double rate_hz) noexcept;

  // The time that the model expects `triangles` to take, in seconds.
  double predict(std::size_t triangles) const noexcept;

  double headRoom() const noexcept { return head_room_; }  // share of the period
  double fixedSeconds() const noexcept { return fixed_; }  // a
  double coefficient() const noexcept { return per_; }     // c; 0 before the first frame
  double exponent() const noexcept { return exponent_; }   // p
  Duration period() const noexcept { return period_; }
  std::size_t least() const noexcept { return settings_.min_triangles; }

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
  double head_room_;
  double exponent_;
  double fixed_ = 0;
  double per_ = 0;                      // c; follows `trend_`, but not its noise
  double noise_ = 0;                    // median distance of ln c from its trend
  double trend_ = 0, slope_ = 0;        // ln c, and by how much it grows a frame
  std::array<double, 3> fixed_seen_{};  // of the last frames
  std::size_t seen_ = 0;
  double usual_ = 1;  // triangles of the last frames, but for one that was smaller
  bool was_smaller_ = false;
  int late_in_a_row_ = 0;
  std::optional<Model> before_;  // a single frame that was acted on
};

}  // namespace merlin::render
