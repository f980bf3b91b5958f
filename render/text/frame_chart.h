// FrameChart: the frame times of the last ten seconds, in columns of equal time. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/base/clock.h"

namespace merlin::render::text {

// One column of the chart. It shows the longest frame that was being drawn during the column's
// time.
struct ChartColumn {
  // When the frame was finished, in percent of its period: 100 at its deadline, at most 255; 0:
  // there was no frame, because nothing moved.
  std::uint8_t percent = 0;
  bool late = false;

  bool operator==(const ChartColumn&) const = default;
};

inline constexpr std::size_t kChartColumns = 200;
inline constexpr Duration kChartColumn = std::chrono::milliseconds(50);

// Thread-bound.
class FrameChart {
 public:
  using Columns = std::array<ChartColumn, kChartColumns>;

  struct Frame {
    Timestamp began, ended, deadline;
    Duration period;
    bool late = false;
  };
  // Adds a frame that was drawn while something moved. Frames come in the order of time.
  void add(const Frame& frame);

  // Returns the columns up to that of `now`, the oldest first.
  Columns at(Timestamp now) const;

 private:
  // Indexed by the column's number since the clock's origin, modulo kChartColumns.
  struct Slot {
    std::int64_t number = -1;
    ChartColumn column;
  };
  std::array<Slot, kChartColumns> slots_{};
};

}  // namespace merlin::render::text
