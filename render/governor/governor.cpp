#include "render/governor/governor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace merlin::render::governor {
namespace {

// Exponent p until calibration, and its limits; measured on llvmpipe with four views of 640 x 480
// (README.md). With a wrong exponent the budget settles more slowly, but no more frames are late.
constexpr double kExponent = 0.65, kLeastExponent = 0.4, kMostExponent = 1.1;
constexpr double kLeastRoom = 0.10, kMostRoom = 0.30, kRoomGain = 0.017;
constexpr double kFixedGain = 0.15;
// Initial head room, as a multiple of the noise of the calibration frames: a dozen frames do not
// show how late the worst of a hundred is.
constexpr double kRoomForNoise = 3;
// Gains of the alpha-beta filter for the trend of ln c and its slope; limits of the correction by
// one frame and of the slope.
constexpr double kTrendGain = 0.25, kSlopeGain = 0.05, kMostPull = 0.10, kMostSlope = 0.05;
// While the trend lies within kDearer above and kCheaper below ln c, c follows it slowly: with
// kSlowUp upwards, kSlow downwards.
constexpr double kSlow = 0.05, kSlowUp = 0.15, kDearer = 0.05, kCheaper = 0.10;
// The estimated median deviation from the trend changes by the factor kNoiseStep a frame. Above
// kQuiet, it widens the range of slow following and speeds up the head room, up to kMostUnrest
// times.
constexpr double kNoiseStep = 1.02, kQuiet = 0.03, kMostUnrest = 3;
// A rising load is extrapolated by the slope of this many frames.
constexpr double kAhead = 3;
// If a single late frame sets c: factor on its measured c, to allow for its noise, and the largest
// factor by which c may grow.
constexpr double kOneFrame = 1.06, kMostJump = 6;
// If c of the next frame is below this multiple of c before the late frame, that one was an
// outlier.
constexpr double kHiccup = 1.5;
constexpr double kDeadBand = 0.05, kGrowth = 1.08;
// A frame with fewer triangles than this share of the usual number is used to learn p, but not c.
constexpr double kOtherSize = 0.7;
constexpr double kExponentGain = 0.1, kMostExponentPull = 0.3;

double log0(double x) { return std::log(std::max(x, 1e-300)); }

double sizeOf(const FrameCost& cost) { return std::max(static_cast<double>(cost.triangles), 1.0); }

double drawingOf(const FrameCost& cost) {
  return std::max(toSeconds(cost.work) - toSeconds(cost.fixed), 1e-9);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Theil-Sen estimator: the median of the slopes of all pairs, which is robust against outliers.
std::optional<double> slopeOf(std::span<const FrameCost> frames) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double x = log0(sizeOf(frames[i])) - log0(sizeOf(frames[j]));
      const double y = log0(drawingOf(frames[i])) - log0(drawingOf(frames[j]));
      if (std::abs(x) >= std::log(2)) slopes.push_back(y / x);
    }
  }
  return slopes.empty() ? std::nullopt : std::optional(median(std::move(slopes)));
}

// Asserts that the settings are valid, before anything is computed from them.
const GovernorSettings& checked(const GovernorSettings& settings) noexcept {
  assert(settings.rate_hz > 0);
  assert(settings.min_triangles > 0 && settings.min_triangles <= settings.first_triangles);
  assert(settings.first_triangles <= settings.max_triangles);
  assert(settings.late_share > 0 && settings.late_share < 1);
  return settings;
}

}  // namespace

Governor::Governor(const GovernorSettings& settings) noexcept
    : settings_(checked(settings)),
      period_(fromSeconds(1.0 / settings.rate_hz)),
      triangles_(static_cast<double>(settings.first_triangles)),
      head_room_(kLeastRoom),
      exponent_(kExponent),
      noise_(kQuiet) {}

std::size_t Governor::budget() const noexcept {
  return static_cast<std::size_t>(held_ ? clamped(static_cast<double>(*held_)) : triangles_);
}

void Governor::observe(const FrameCost& cost) noexcept {
  assert(cost.work > Duration::zero() && cost.fixed >= Duration::zero());
  const bool over = cost.late || cost.work > period_;
  late_in_a_row_ = over ? late_in_a_row_ + 1 : 0;
  learnHeadRoom(cost.late);
  learnCost(cost);
  choose();
}

// The head room covers noise only: from the second late frame in a row on, the load has become more
// expensive, which the cost model learns.
void Governor::learnHeadRoom(bool late) noexcept {
  if (late_in_a_row_ >= 2) return;
  const double q = settings_.late_share;
  const double gain = kRoomGain * unrest();
  head_room_ += late ? gain * (1 - q) : -gain * q;
  head_room_ = std::clamp(head_room_, kLeastRoom, kMostRoom);
}

// Uses the median of the last three frames, so that a single outlier in read-back has no effect.
void Governor::learnFixed(double fixed) noexcept {
  fixed_seen_[seen_ % fixed_seen_.size()] = fixed;
  std::array<double, 3> sorted = fixed_seen_;
  const std::size_t n = std::min(seen_ + 1, sorted.size());
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
  fixed_ = seen_++ == 0 ? fixed : fixed_ + kFixedGain * (sorted[n / 2] - fixed_);
}

void Governor::learnCost(const FrameCost& cost) noexcept {
  const double fixed = toSeconds(cost.fixed), size = sizeOf(cost);
  const double now = drawingOf(cost) / std::pow(size, exponent_);
  const bool grave = late_in_a_row_ == 1 && cost.work > 2 * period_;
  if (per_ == 0) {
    learnFixed(fixed);
    jumpTo(now);
  } else if (late_in_a_row_ >= 2) {
    actOnTheWorst(fixed, now);
  } else if (grave) {
    before_ = Model{fixed_, per_, triangles_};
    actOnTheWorst(fixed, std::min(kOneFrame * now, kMostJump * per_));
  } else if (late_in_a_row_ == 0) {
    if (before_ && now < kHiccup * before_->per) takeBack();
    before_.reset();
    learnFixed(fixed);
    learnFrom(size, now);
  }
}

void Governor::takeBack() noexcept {
  fixed_ = before_->fixed;
  triangles_ = before_->triangles;
  jumpTo(before_->per);
}

// A frame with fewer triangles than those before it, because less than a period was left, shows how
// the cost depends on the number of triangles under the same load.
void Governor::learnFrom(double size, double now) noexcept {
  const bool smaller = size < kOtherSize * usual_ && !was_smaller_;
  was_smaller_ = smaller;
  if (smaller) {
    learnExponent(log0(size / usual_), log0(now) - log0(per_));
  } else {
    usual_ = size;
    follow(log0(now));
  }
}

void Governor::actOnTheWorst(double fixed, double per) noexcept {
  fixed_ = std::max(fixed_, fixed);
  jumpTo(std::max(per_, per));
}

void Governor::jumpTo(double per) noexcept {
  per_ = per;
  trend_ = log0(per);
  slope_ = 0;
}

// Returns 1 on an otherwise idle machine, and more if the load of other processes varies the cost
// of the same frame.
double Governor::unrest() const noexcept { return std::min(noise_ / kQuiet, kMostUnrest); }

// The trend follows a load that rises for seconds without lag, but is noisy. So c follows slowly as
// long as the trend is within its noise.
void Governor::follow(double now) noexcept {
  const double expected = trend_ + slope_;
  const double pull = std::clamp(now - expected, -kMostPull, kMostPull);
  noise_ *= std::abs(pull) > noise_ ? kNoiseStep : 1 / kNoiseStep;
  noise_ = std::clamp(noise_, kQuiet, kMostPull);
  trend_ = expected + kTrendGain * pull;
  slope_ = std::clamp(slope_ + kSlopeGain * pull, -kMostSlope, kMostSlope);
  // While the cost falls, c is not set below that of this frame, since the trend undershoots.
  const double ahead = std::max(trend_, slope_ > 0 ? trend_ + kAhead * slope_ : now);
  const double off = trend_ + slope_ - log0(per_);
  if (off > kDearer * unrest() || off < -kCheaper * unrest())
    per_ = std::exp(ahead);
  else
    per_ *= std::exp((off > 0 ? kSlowUp : kSlow) * off);
}

// `size`: ln of the frame's triangles over the usual number; `off`: ln of its c over the model's.
// The cost predicted for the usual number of triangles does not change.
void Governor::learnExponent(double size, double off) noexcept {
  const double pull = std::clamp(off / size, -kMostExponentPull, kMostExponentPull);
  const double next = std::clamp(exponent_ + kExponentGain * pull, kLeastExponent, kMostExponent);
  const double same = (exponent_ - next) * log0(usual_);
  exponent_ = next;
  per_ *= std::exp(same);
  trend_ += same;
}

void Governor::calibrate(std::span<const FrameCost> frames) {
  if (frames.empty()) return;
  if (const auto slope = slopeOf(frames))
    exponent_ = std::clamp(*slope, kLeastExponent, kMostExponent);
  std::vector<double> fixed, sizes, per;
  for (const FrameCost& f : frames) {
    fixed.push_back(toSeconds(f.fixed));
    sizes.push_back(sizeOf(f));
  }
  fixed_ = median(std::move(fixed));
  // c is fitted to the larger frames, since their sizes are closer to those that will be drawn.
  usual_ = median(sizes);
  for (const FrameCost& f : frames) {
    if (sizeOf(f) >= usual_) per.push_back(drawingOf(f) / std::pow(sizeOf(f), exponent_));
  }
  jumpTo(median(per));
  for (double& p : per) p = std::abs(std::log(p / per_));
  head_room_ = std::clamp(kRoomForNoise * median(std::move(per)), head_room_, kMostRoom);
  fixed_seen_.fill(fixed_);
  seen_ = fixed_seen_.size();
  startOver();
}

void Governor::expect(double ratio) noexcept {
  assert(ratio > 0 && std::isfinite(ratio));
  if (per_ == 0) return;
  jumpTo(per_ * ratio);
  startOver();
}

void Governor::setLimits(const GovernorSettings& settings) noexcept {
  settings_ = checked(settings);
  triangles_ = clamped(triangles_);
}

void Governor::setLeastUseful(std::optional<std::size_t> least_useful) noexcept {
  assert(least_useful.value_or(1) > 0);
  least_useful_ = least_useful;
  triangles_ = clamped(triangles_);
}

void Governor::setRate(double rate_hz) noexcept {
  assert(rate_hz > 0);
  period_ = fromSeconds(1 / rate_hz);
  if (per_ > 0) startOver();
}

// Sets the budget to what the model allows without gradual growth, since no late frame contradicts
// the model.
void Governor::startOver() noexcept {
  late_in_a_row_ = 0;
  before_.reset();
  triangles_ = clamped(trianglesIn(toSeconds(period_)));
}

double Governor::clamped(double triangles) const noexcept {
  return std::clamp(triangles, static_cast<double>(least()),
                    static_cast<double>(settings_.max_triangles));
}

// Returns the number of triangles whose predicted time is `seconds`: the inverse of the cost model.
double Governor::fitting(double seconds) const noexcept {
  return std::pow(std::max(seconds - fixed_, 0.0) / per_, 1 / exponent_);
}

double Governor::trianglesIn(double seconds) const noexcept {
  return fitting(seconds * (1 - head_room_));
}

std::size_t Governor::costWithin(Duration work) const noexcept {
  return per_ == 0 ? budget() : static_cast<std::size_t>(clamped(fitting(toSeconds(work))));
}

std::size_t Governor::budgetFor(Duration available) const noexcept {
  if (per_ == 0 || held_ || available >= period_ * 99 / 100) return budget();
  const double fits = trianglesIn(toSeconds(available));
  if (fits < static_cast<double>(least())) return 0;
  return static_cast<std::size_t>(std::min(fits, triangles_));
}

void Governor::choose() noexcept {
  const double wanted = trianglesIn(toSeconds(period_));
  const double ratio = wanted / triangles_;
  if (late_in_a_row_ >= 2 || before_) {
    triangles_ = std::min(triangles_, wanted);
  } else if (ratio < 1 - kDeadBand) {
    triangles_ = wanted;
  } else if (ratio > 1 + kDeadBand) {
    triangles_ *= std::min(ratio, kGrowth);
  }
  triangles_ = clamped(triangles_);
}

double Governor::predict(std::size_t triangles) const noexcept {
  return fixed_ + per_ * std::pow(static_cast<double>(triangles), exponent_);
}

}  // namespace merlin::render::governor
