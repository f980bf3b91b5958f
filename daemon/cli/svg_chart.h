// Draws a line chart with linear or logarithmic axes as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin::cli {

struct ChartAxis {
  double low = 1, high = 10;  // low < high; both > 0 if the axis is logarithmic
  // True: logarithmic, with grid lines at powers of ten. False: linear, with grid lines at the
  // ends.
  bool logarithmic = true;
};

struct ChartLine {
  std::string name;
  std::string colour;                             // CSS colour
  std::vector<std::pair<double, double>> points;  // (x, y); points that are not finite are left out
};

// Escapes the characters of a text that have a meaning in SVG.
std::string svgText(const std::string& text);

// Returns the chart as SVG. `below`: text below the chart. Points outside the range of an axis are
// drawn at its nearer end. The texts are not escaped; the caller escapes them with svgText().
std::string svgChart(const std::string& title, const std::string& below, const ChartAxis& x,
                     const ChartAxis& y, const std::vector<ChartLine>& lines);

}  // namespace merlin::cli
