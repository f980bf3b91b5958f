#include "render/governor/governor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace merlin::render {
namespace {

// Measured on llvmpipe, four views of 640 x 480 (README.md); a wrong exponent costs speed of
// settling, not safety.
constexpr double kExponent = 0.65;
constexpr double kLeastRoom = 0.10, kMostRoom = 0.30, kRoomGain = 0.02;
constexpr double kSlower = 0.15, kFaster = 0.10;  // how fast c follows dearer, cheaper frames
constexpr double kFixedGain = 0.1;
constexpr double kDeadBand = 0.05, kGrowth = 1.08;

}  // namespace

Governor::Governor(const GovernorSettings& settings) noexcept
    : settings_(settings),
      period_(fromSeconds(1.0 / settings.rate_hz)),
      triangles_(static_cast<double>(settings.first_triangles)) {
  assert(settings.rate_hz > 0);
  assert(settings.min_triangles > 0 && settings.min_triangles <= settings.first_triangles);
  assert(settings.first_triangles <= settings.max_triangles);
  assert(settings.late_share > 0 && settings.late_share < 1);
}

void Governor::observe(const FrameCost& cost) noexcept {
  assert(cost.work > Duration::zero() && cost.fixed >= Duration::zero());
  const bool over = cost.late || cost.work > period_;
  late_in_a_row_ = over ? late_in_a_row_ + 1 : 0;
  learnHeadRoom(cost.late);
  learnCost(cost);
  choose();
}

void Governor::learnHeadRoom(bool late) noexcept {
  const double q = settings_.late_share;
  head_room_ += late ? kRoomGain * (1 - q) : -kRoomGain * q;
  head_room_ = std::clamp(head_room_, kLeastRoom, kMostRoom);
}

void Governor::learnCost(const FrameCost& cost) noexcept {
  const double fixed = toSeconds(cost.fixed);
  fixed_ = seen_ == 0 ? fixed : fixed_ + kFixedGain * (fixed - fixed_);
  const double grown = std::max(toSeconds(cost.work) - fixed, 1e-9);
  const double now =
      grown / std::pow(std::max<double>(static_cast<double>(cost.triangles), 1), kExponent);
  work_[seen_++ % work_.size()] = now;
  if (per_ == 0) {
    per_ = now;
  } else if (late_in_a_row_ >= 2) {
    per_ = std::max(per_, now);
  } else if (late_in_a_row_ == 0) {
    const double typical = medianWork();
    per_ += (typical > per_ ? kSlower : kFaster) * (typical - per_);
  }
}

double Governor::medianWork() const noexcept {
  std::array<double, 3> sorted = work_;
  const std::size_t n = std::min(seen_, sorted.size());
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
  return sorted[n / 2];
}

// The model's inverse, with head room.
double Governor::trianglesIn(double seconds) const noexcept {
  const double room = seconds * (1 - head_room_) - fixed_;
  return std::pow(std::max(room, 0.0) / per_, 1 / kExponent);
}

std::size_t Governor::budgetFor(Duration available) const noexcept {
  if (per_ == 0 || available >= period_ * 99 / 100) return budget();
  const double fits = trianglesIn(toSeconds(available));
  if (fits < static_cast<double>(settings_.min_triangles)) return 0;
  return static_cast<std::size_t>(std::min(fits, triangles_));
}

void Governor::choose() noexcept {
  const double wanted = trianglesIn(toSeconds(period_));
  const double ratio = wanted / triangles_;
  if (late_in_a_row_ >= 2) {
    triangles_ = std::min(triangles_, wanted);
  } else if (ratio < 1 - kDeadBand) {
    triangles_ = wanted;
  } else if (ratio > 1 + kDeadBand) {
    triangles_ *= std::min(ratio, kGrowth);
  }
  triangles_ = std::clamp(triangles_, static_cast<double>(settings_.min_triangles),
                          static_cast<double>(settings_.max_triangles));
}

double Governor::predict(std::size_t triangles) const noexcept {
  return fixed_ + per_ * std::pow(static_cast<double>(triangles), kExponent);
}

}  // namespace merlin::render
