// Governor: frame times in, triangles for the next frame out, so that the rate asked is held.
//
// [GOURLEY98] 5.4, figure 5.36 divides last second's triangles a second by the rate (row M3). That
// law takes cost for linear, reacts after a second and aims at the deadline itself, so it is late
// in half of its frames. Here the cost of a frame is modelled as
//
//   work = a + c T^p       a: clearing, read-back, presenting; measured. T: triangles.
//
// and T is chosen so that the work fills the period but for a head room m, which follows the share
// of late frames: late, m += g (1 - q); in time, m -= g q, so that in the long run a share q is
// late. One late frame may be a hiccup and changes nothing; two in a row act at once, on the worst
// figure seen, and never by growth; growth is gentle and waits for a gain worth it. README.md has
// figures and sources.
#pragma once

#include <array>
#include <cstddef>

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
  std::size_t budget() const noexcept { return static_cast<std::size_t>(triangles_); }

  // The same for a frame that has less than a period left, after one that ran over: what the model
  // says fits; 0 where not even the least does.
  std::size_t budgetFor(Duration available) const noexcept;

  // REQUIRES: cost.work > 0, 0 <= cost.fixed <= cost.work.
  void observe(const FrameCost& cost) noexcept;

  // The time that the model expects `triangles` to take, in seconds.
  double predict(std::size_t triangles) const noexcept;

  double headRoom() const noexcept { return head_room_; }  // share of the period
  double fixedSeconds() const noexcept { return fixed_; }  // a
  double coefficient() const noexcept { return per_; }     // c; 0 before the first frame
  Duration period() const noexcept { return period_; }

 private:
  void learnHeadRoom(bool late) noexcept;
  void learnCost(const FrameCost& cost) noexcept;
  void choose() noexcept;
  double medianWork() const noexcept;
  double trianglesIn(double seconds) const noexcept;

  GovernorSettings settings_;
  Duration period_;
  double triangles_;
  double head_room_ = 0.10;
  double fixed_ = 0;
  double per_ = 0;
  int late_in_a_row_ = 0;
  std::array<double, 3> work_{};  // the last frames' shares of the model, c by each of them
  std::size_t seen_ = 0;
};

}  // namespace merlin::render
