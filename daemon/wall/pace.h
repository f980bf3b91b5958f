// Pace: decides the frame rate and the size of the tiles while something moves.
//
// A person may fix the rate and the detail. If not even frames of the coarsest detail meet their
// deadlines, tiles are drawn at half their width and height; if that is not enough, the rate is
// halved, and then quartered (render/governor/degradation_ladder.h). But the rate is never lowered
// below Governor::minRateHz(): with a minimum of 10 Hz, the lower rates for 30 Hz are 15 and 10 Hz.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/base/clock.h"
#include "render/content/content.h"
#include "render/governor/degradation_ladder.h"
#include "render/governor/governor.h"

namespace merlin::wall {

// Thread-bound, except hold(), setRate() and limits().
class Pace {
 public:
  // `governor` must outlive this object.
  explicit Pace(render::governor::Governor& governor);

  // Both may be called on any thread and are applied by the next update(). hold() fixes the cost of
  // the detail while something moves; nullopt: the governor chooses it. setRate() sets the frame
  // rate; nullopt: the configured one. REQUIRES: rate_hz > 0.
  void hold(std::optional<std::size_t> cost) noexcept;
  void setRate(std::optional<double> rate_hz) noexcept;
  // Range of the costs that hold() may fix for the content that is shown; the governor clamps other
  // costs to it. May be called on any thread.
  struct Limits {
    std::size_t least, most;
  };
  Limits limits() const noexcept { return {least_cost_.load(), most_cost_.load()}; }

  // Sets the governor's lower limit for a content. To be called for the first content, and each
  // time that another content is shown. If the detail of the new content has another unit than that
  // of the old one, the cost that hold() has fixed is no longer used.
  void show(const render::content::DetailAxis& detail);

  // Replaces the configured rate; the next update() applies it. REQUIRES: rate_hz > 0.
  void configure(double rate_hz) noexcept { configured_hz_ = rate_hz; }

  // Applies hold(), setRate() and configure(). To be called before each frame. Returns true if the
  // period has changed.
  bool update();

  // Decides whether the tiles' size or the rate changes. To be called after each deadline that
  // passed while something moved. `late`: the deadline was missed. `coarsest`: the frame had the
  // coarsest detail, or there was no time to draw one. Returns true if the size of the tiles has
  // changed; update() applies a changed rate.
  bool observe(bool late, bool coarsest);
  // Decides whether operatorIsCoarser() changes. To be called after each moving frame. `coarser`:
  // the operator's view of this frame was drawn coarser to save time.
  void observeOperator(bool coarser);

  Duration period() const noexcept { return period_; }
  double askedHz() const noexcept { return asked_hz_; }
  int sizeDivisor() const noexcept { return ladder_.step() > 0 ? 2 : 1; }
  int rateDivisor() const noexcept { return divisorAt(ladder_.step()); }
  bool operatorIsCoarser() const noexcept { return operator_ladder_.step() > 0; }
  // Number of changes of the tiles' size, the rate and operatorIsCoarser() since the start.
  std::uint32_t changes() const noexcept { return changes_; }

 private:
  int mostDivisor() const noexcept;
  int divisorAt(int step) const noexcept;
  void limitLadder() noexcept;
  bool betterFits() const;
  void noteLimits() noexcept;

  render::governor::Governor& governor_;
  std::string unit_;  // unit of the content's detail; empty: no content was shown yet
  double configured_hz_;
  double asked_hz_;
  Duration period_;
  // The first step halves the size of the tiles, each further one lowers the rate.
  render::governor::DegradationLadder ladder_{3};
  render::governor::DegradationLadder operator_ladder_{1};
  std::uint32_t changes_ = 0;
  std::atomic<std::size_t> least_cost_{0}, most_cost_{0};
  std::atomic<std::int64_t> held_cost_{-1};  // -1: the governor chooses
  std::atomic<double> set_rate_hz_{0};       // 0: the configured rate
};

}  // namespace merlin::wall
