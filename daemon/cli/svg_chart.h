// A line chart with linear or logarithmic axes, as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin::cli {

struct ChartAxis {
  double low = 1, high = 10;  // low < high; both > 0 if the axis is logarithmic
  bool logarithmic = true;    // grid lines at powers of ten; otherwise at the two ends only
};

struct ChartLine {
  std::string name;
  std::string colour;                             // CSS colour
  std::vector<std::pair<double, double>> points;  // x, y; points that are not finite are left out
};

// Escapes a text for SVG.
std::string svgText(const std::string& text);

// The chart as SVG. `below`: text below the chart. Points outside the range of an axis are drawn at
// its end. The title and names are not escaped: use svgText().
std::string svgChart(const std::string& title, const std::string& below, const ChartAxis& x,
                     const ChartAxis& y, const std::vector<ChartLine>& lines);

}  // namespace merlin::cli
