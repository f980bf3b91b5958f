// Pace: decides the frame rate, and the size of the tiles, while something moves.
//
// A person may fix the rate and the detail. If not even frames of the coarsest detail meet their
// deadlines, tiles are drawn at half their width and height; after that at half the rate, then at a
// quarter (render/governor/degradation_ladder.h). The rate stays at least Governor::minRateHz():
// of 30 Hz, 15 and 10 Hz remain.
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

  // May be called on any thread; applied by the next update(). hold() fixes the cost of the detail
  // while something moves, nullopt: the governor chooses it. setRate() sets the frame rate,
  // nullopt: the configured one. REQUIRES: rate_hz > 0.
  void hold(std::optional<std::size_t> cost) noexcept;
  void setRate(std::optional<double> rate_hz) noexcept;
  // The range of costs that hold() may fix for the content that is shown; a cost outside is not
  // used. May be called on any thread.
  struct Limits {
    std::size_t least, most;
  };
  Limits limits() const noexcept { return {least_cost_.load(), most_cost_.load()}; }

  // To be called when another content is shown, and for the first one: sets the governor's lower
  // limit from its detail. If its detail has another unit than the one before, a cost that hold()
  // has fixed is dropped.
  void show(const render::content::DetailAxis& detail);

  // Replaces the configured rate, with the next update(). REQUIRES: rate_hz > 0.
  void configure(double rate_hz) noexcept { configured_hz_ = rate_hz; }

  // To be called before each frame: applies hold() and setRate(). Returns true if the period has
  // changed.
  bool update();

  // To be called after each deadline that passed while something moved. `coarsest`: its frame had
  // the coarsest detail, or there was no time to draw one. Returns true if the size of the tiles
  // has changed.
  bool observe(bool late, bool coarsest);
  // To be called after each moving frame. `coarser`: the operator's view was drawn coarser to save
  // time.
  void observeOperator(bool coarser);

  Duration period() const noexcept { return period_; }
  double askedHz() const noexcept { return asked_hz_; }
  int sizeDivisor() const noexcept { return ladder_.step() > 0 ? 2 : 1; }
  int rateDivisor() const noexcept { return divisorAt(ladder_.step()); }
  bool operatorIsCoarser() const noexcept { return operator_ladder_.step() > 0; }
  // Changes of the tiles' size, the rate and the operator's view, since the start.
  std::uint32_t changes() const noexcept { return changes_; }

 private:
  int mostDivisor() const noexcept;
  int divisorAt(int step) const noexcept;
  void limitLadder() noexcept;
  bool betterFits() const;
  void noteLimits() noexcept;

  render::governor::Governor& governor_;
  std::string unit_;  // of the content's detail; empty: none was shown
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
