// Lines over a logarithmic axis, as an SVG picture.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin::cli {

struct ChartAxis {
  double low = 1, high = 10;  // low < high; above 0 where it is logarithmic
  bool logarithmic = true;    // a line and its figure at each power of ten; else only at the ends
};

struct ChartLine {
  std::string name;
  std::string colour;                             // as CSS has it
  std::vector<std::pair<double, double>> points;  // x, y; what is not finite is left out
};

// Any text as SVG has to have it: without markup of its own.
std::string svgText(const std::string& text);

// What lies outside the axes is held at their ends. Titles and names are taken as they are.
std::string svgChart(const std::string& title, const std::string& below, const ChartAxis& x,
                     const ChartAxis& y, const std::vector<ChartLine>& lines);

}  // namespace merlin::cli
