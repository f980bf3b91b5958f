#include "daemon/cli/watch/frame_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::cli {
namespace {

constexpr int kScale = 9;  // width of the scale in columns, for "  33.3 ms"
constexpr int kLeastRows = 2, kLeastColumns = 20;
// Number of parts into which a cell is divided vertically.
constexpr int kParts = 8;

// Returns the glyph of a cell of which `parts` eighths are filled from below.
char32_t glyphOf(int parts, bool blocks) {
  if (parts <= 0) return U' ';
  if (!blocks) return U'#';
  return static_cast<char32_t>(0x2580 + std::min(parts, kParts));  // U+2581 to U+2588
}

}  // namespace

void FrameTimes::add(std::optional<double> milliseconds) {
  all_.push_back(milliseconds);
  if (all_.size() > kSeconds) all_.pop_front();
}

void drawChart(CellGrid& grid, const ChartPlace& place, const FrameTimes& times, double period_ms,
               bool blocks) {
  if (place.rows < kLeastRows || place.columns < kLeastColumns) return;
  double most = period_ms;
  for (const auto& time : times.all()) most = std::max(most, time.value_or(0));
  if (!(most > 0) || !std::isfinite(most)) most = 1;
  const auto parts = [&](double ms) {  // number of filled eighths in a column, at least 1
    return std::max(1, static_cast<int>(std::lround(ms / most * place.rows * kParts)));
  };
  const int first = place.column + kScale;
  const int shown = std::min(static_cast<int>(FrameTimes::kSeconds), place.columns - kScale);
  // The row in which a bar of one period ends, counted from below.
  const int period_row = period_ms > 0 ? (parts(period_ms) - 1) / kParts : -1;
  for (int row = 0; row < place.rows; ++row) {
    const int above = place.rows - 1 - row;  // rows of the chart below this one
    if (row == 0) grid.put(place.row, place.column, fmt::format("{:6.1f} ms", most));
    if (row > 0 && above == period_row)
      grid.put(place.row + row, place.column, fmt::format("{:6.1f} ms", period_ms));
    for (int i = 0; i < shown; ++i) {
      const auto seconds_ago = static_cast<std::size_t>(shown - 1 - i);
      const auto& all = times.all();
      const auto time = seconds_ago < all.size() ? all[all.size() - 1 - seconds_ago] : std::nullopt;
      const int filled = time && *time > 0 ? parts(*time) - above * kParts : 0;
      const bool late = time && period_ms > 0 && *time > period_ms;
      Cell cell{glyphOf(filled, blocks), late ? CellStyle::kBad : CellStyle::kGood};
      if (filled <= 0) cell = {above == period_row ? U'-' : U' ', CellStyle::kDim};
      grid.put(place.row + row, first + i, cell);
    }
  }
}

}  // namespace merlin::cli
