#include "render/text/frame_chart.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::text {
namespace {

constexpr auto kColumns = static_cast<std::int64_t>(kChartColumns);

std::int64_t columnOf(Timestamp at) { return toNanoseconds(at) / kChartColumn.count(); }

}  // namespace

// A frame that takes several periods is entered into each column of its time, and so are the
// deadlines that it missed.
void FrameChart::add(const Frame& frame) {
  if (frame.period <= Duration::zero() || toNanoseconds(frame.began) < 0) return;
  const double share = 1 + toSeconds(frame.ended - frame.deadline) / toSeconds(frame.period);
  const auto percent = static_cast<std::uint8_t>(std::clamp(std::round(100 * share), 1.0, 255.0));
  const Timestamp until = std::max(frame.ended, frame.began + frame.period);
  const std::int64_t last = columnOf(until - Duration(1));
  for (std::int64_t n = std::max(columnOf(frame.began), last - kColumns + 1); n <= last; ++n) {
    Slot& slot = slots_[static_cast<std::size_t>(n % kColumns)];
    if (slot.number != n) slot = {n, {}};
    slot.column.percent = std::max(slot.column.percent, percent);
    slot.column.late |= frame.late;
  }
}

FrameChart::Columns FrameChart::at(Timestamp now) const {
  Columns columns{};
  const std::int64_t first = columnOf(now) - kColumns + 1;
  for (const Slot& slot : slots_) {
    if (slot.number >= std::max<std::int64_t>(first, 0) && slot.number < first + kColumns)
      columns[static_cast<std::size_t>(slot.number - first)] = slot.column;
  }
  return columns;
}

}  // namespace merlin::render::text
