#include "daemon/wall/still_frame.h"

#include <algorithm>
#include <utility>

namespace merlin::wall {
namespace {

// Maximum planned drawing time of the first finer frame, so that it is shown within two periods.
constexpr Duration kFirstWork = std::chrono::milliseconds(40);
constexpr std::size_t kNextDetail = 8;  // ratio of the costs of successive finer frames

}  // namespace

void StillFrame::begin(Timestamp now, std::span<const std::uint8_t> shown) {
  since_ = now;
  first_ = true;
  fade_.keep(shown);
}

void StillFrame::stop() noexcept {
  fade_.stop();
  refining_.reset();
}

void StillFrame::restart() noexcept {
  first_ = true;
  refining_.reset();
}

std::optional<std::size_t> StillFrame::refine(const ContentTurns& turns,
                                              const Eigen::Isometry3f& T_eye_content,
                                              std::size_t step, int size_divisor, Timestamp until) {
  if (!refining_) {
    refining_ = finerStep(turns.detail(), step, size_divisor);
    turns.painter().beginRefining(T_eye_content, *refining_);
  }
  if (!turns.painter().refine(until)) return std::nullopt;
  fade_.begin(fade_frames_);
  return std::exchange(refining_, std::nullopt);
}

// Returns the step of the next finer frame. The governor's cost model applies to frames that are
// drawn at 1/size_divisor of the width and height; refined frames have full size, so the planned
// time is divided by the ratio of the areas.
std::size_t StillFrame::finerStep(const render::content::DetailAxis& detail, std::size_t step,
                                  int size_divisor) const {
  const std::size_t now = detail.costOf(step);
  const Duration first =
      std::min<Duration>(governor_.period() * 5 / 4, kFirstWork) / (size_divisor * size_divisor);
  const std::size_t finer = first_ ? governor_.costWithin(first) : kNextDetail * now;
  const bool worth = finer > now && finer < detail.fullCost() / 2;
  return worth ? detail.stepWithin(finer) : 0;
}

StillFrame::Times StillFrame::shown(Timestamp now, bool full_detail) noexcept {
  const auto since = static_cast<float>(toSeconds(now - since_));
  Times times;
  if (std::exchange(first_, false)) times.to_first_s = since;
  if (full_detail) times.to_full_s = since;
  return times;
}

}  // namespace merlin::wall
