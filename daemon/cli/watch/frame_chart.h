// A chart of frame times: a column for each second, a bar as high as that second's frame time.
// Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "daemon/cli/watch/cell_grid.h"

namespace merlin::cli {

// The frame times of the last minute, one a second, newest last. A second without a value: nothing
// moved, or no daemon ran.
class FrameTimes {
 public:
  static constexpr std::size_t kSeconds = 60;

  void add(std::optional<double> milliseconds);
  const std::deque<std::optional<double>>& all() const noexcept { return all_; }

 private:
  std::deque<std::optional<double>> all_;
};

struct ChartPlace {
  int row = 0, column = 0;  // its upper left cell
  int rows = 0;             // height of the bars
  int columns = 0;          // including the scale to the left of the bars
};

// Draws the chart: to the left the scale in milliseconds, then the bars, the newest at the right. A
// bar above `period_ms`, the time that a frame has at the asked rate, has the style kBad; the
// period's row is marked where no bar covers it; 0: no period is known. The scale reaches to the
// largest of the times and the period. `blocks`: draws with Unicode's block elements, exact to an
// eighth of a row; otherwise with '#'. Draws nothing if the place has fewer than 2 rows or 20
// columns.
void drawChart(CellGrid& grid, const ChartPlace& place, const FrameTimes& times, double period_ms,
               bool blocks);

}  // namespace merlin::cli
