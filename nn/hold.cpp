#include "nn/hold.h"

namespace merlin::nn {
namespace {

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

const Held& PostureHold::update(const Recognition& seen, std::int64_t now_ns) noexcept {
  const bool same = held_.any && seen.code == held_.code;
  const double least = same ? settings_.least_margin / 2 : settings_.least_margin;
  // A NaN margin counts as too small.
  const bool sure = !seen.name.empty() && static_cast<double>(seen.margin) >= least;
  const std::uint32_t shown = sure ? seen.code : kNone;
  if (!running_ || shown != run_code_) {
    running_ = true;
    run_code_ = shown;
    run_since_ns_ = now_ns;
  }
  const bool still = held_.any && shown == held_.code;
  if (still) {
    gone_ = false;
  } else if (held_.any && !gone_) {
    gone_ = true;
    gone_since_ns_ = now_ns;
  }
  const bool lasted = now_ns - run_since_ns_ >= nanoseconds(settings_.hold_s);
  if (shown != kNone && !still && lasted) {
    held_ = {shown, true, run_since_ns_, held_.entered + 1};
    gone_ = false;
  } else if (gone_ && now_ns - gone_since_ns_ >= nanoseconds(settings_.leave_s)) {
    held_ = {0, false, gone_since_ns_, held_.entered};
    gone_ = false;
  }
  return held_;
}

}  // namespace merlin::nn
