#include "daemon/wall/pace.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace merlin::wall {
namespace {

constexpr std::string_view kTriangles = "triangles";  // unit of models and of min_triangles
constexpr int kSmallerTiles = 1;     // step of the ladder with smaller tiles at full rate
constexpr int kMostRateDivisor = 4;  // even if min_rate_hz allows a larger one

}  // namespace

Pace::Pace(render::governor::Governor& governor)
    : governor_(governor),
      configured_hz_(1 / toSeconds(governor.period())),
      asked_hz_(configured_hz_),
      period_(governor.period()) {
  limitLadder();
  noteLimits();
}

void Pace::hold(std::optional<std::size_t> cost) noexcept {
  held_cost_.store(cost ? static_cast<std::int64_t>(*cost) : -1);
}

void Pace::setRate(std::optional<double> rate_hz) noexcept {
  set_rate_hz_.store(rate_hz.value_or(0));
}

void Pace::show(const render::content::DetailAxis& detail) {
  const std::string_view unit = detail.unit();
  governor_.setLeastUseful(unit == kTriangles ? std::nullopt : std::optional(detail.leastUseful()));
  if (!unit_.empty() && unit != unit_) {
    hold(std::nullopt);  // a held cost is meaningless in another unit
    governor_.hold(std::nullopt);
  }
  unit_ = unit;
  noteLimits();
}

void Pace::noteLimits() noexcept {
  least_cost_.store(governor_.least());
  most_cost_.store(governor_.most());
}

bool Pace::update() {
  noteLimits();
  const std::int64_t held = held_cost_.load();
  governor_.hold(held < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(held)));
  const double set_hz = set_rate_hz_.load();
  asked_hz_ = set_hz > 0 ? set_hz : configured_hz_;
  limitLadder();
  const double now_hz = asked_hz_ / rateDivisor();
  if (period_ == fromSeconds(1 / now_hz)) return false;
  governor_.setRate(now_hz);
  period_ = governor_.period();
  return true;
}

bool Pace::observe(bool late, bool coarsest) {
  const int was = sizeDivisor();
  if (!ladder_.observe(late, coarsest, betterFits())) return false;
  ++changes_;
  // The drawing time grows at most as much as the number of pixels.
  if (sizeDivisor() < was) governor_.expect(was * was);
  return sizeDivisor() != was;
}

void Pace::observeOperator(bool coarser) {
  if (operator_ladder_.observe(coarser, true, true)) ++changes_;
}

// Returns the largest divisor, at most kMostRateDivisor, with which the rate is not below
// min_rate_hz; 1 if there is none.
int Pace::mostDivisor() const noexcept {
  constexpr double kRounding = 1e-6;  // tolerance, since periods are whole nanoseconds
  const double times = std::floor(asked_hz_ / governor_.minRateHz() + kRounding);
  return static_cast<int>(std::clamp(times, 1.0, double{kMostRateDivisor}));
}

int Pace::divisorAt(int step) const noexcept {
  return std::min(1 << std::max(step - kSmallerTiles, 0), mostDivisor());
}

// Limits the ladder to the step with smaller tiles and the further steps that lower the rate.
void Pace::limitLadder() noexcept {
  const int slower = std::min(mostDivisor() - 1, 2);
  if (ladder_.setMost(kSmallerTiles + slower)) ++changes_;
}

// Whether a frame of the coarsest detail would fit at the next higher step of the ladder: at full
// size it takes at most four times as long, and at a higher rate its period is shorter.
bool Pace::betterFits() const {
  const double needed_s = governor_.predict(governor_.least());
  const int step = ladder_.step();
  double times = 4;
  if (step > kSmallerTiles)
    times = static_cast<double>(divisorAt(step)) / static_cast<double>(divisorAt(step - 1));
  return times * needed_s < toSeconds(period_) * (1 - governor_.headRoom());
}

}  // namespace merlin::wall
