// Draws a chart of frame times, with a bar for each second as high as its frame time. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "daemon/cli/watch/cell_grid.h"

namespace merlin::cli {

// The frame times of the last minute [ms], one for each second, newest last. A second has no value
// if no frame was drawn or no daemon ran.
class FrameTimes {
 public:
  static constexpr std::size_t kSeconds = 60;

  void add(std::optional<double> milliseconds);
  const std::deque<std::optional<double>>& all() const noexcept { return all_; }

 private:
  std::deque<std::optional<double>> all_;
};

struct ChartPlace {
  int row = 0, column = 0;  // the upper left cell
  int rows = 0;             // height of the bars
  int columns = 0;          // width, including the scale to the left of the bars
};

// Draws the chart into `place`: the scale [ms] at the left, then the bars, the newest at the right.
// `period_ms`: the time for one frame at the asked rate; 0: unknown. Bars above it have the style
// kBad, and its row is marked with '-' where no bar covers it. The scale ends at the largest of the
// times and the period. `blocks`: whether to draw with Unicode block elements, exact to an eighth
// of a row, instead of '#'. Draws nothing if the place has fewer than 2 rows or 20 columns.
void drawChart(CellGrid& grid, const ChartPlace& place, const FrameTimes& times, double period_ms,
               bool blocks);

}  // namespace merlin::cli
