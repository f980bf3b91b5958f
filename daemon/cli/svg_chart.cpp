#include "daemon/cli/svg_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::cli {
namespace {

constexpr int kChartWidth = 640, kChartHeight = 360, kPlotLeft = 60, kPlotTop = 40,
              kPlotWidth = 560, kPlotHeight = 250;
constexpr int kLegendStep = 15;

// Returns the position of a value on the axis: 0 at the low end, 1 at the high end. Values outside
// are moved to the nearer end.
double place(const ChartAxis& axis, double value) {
  const double held = std::clamp(value, axis.low, axis.high);
  return axis.logarithmic ? std::log(held / axis.low) / std::log(axis.high / axis.low)
                          : (held - axis.low) / (axis.high - axis.low);
}

double across(const ChartAxis& x, double value) { return kPlotLeft + kPlotWidth * place(x, value); }
double down(const ChartAxis& y, double value) {
  return kPlotTop + kPlotHeight * (1 - place(y, value));
}

std::vector<double> marks(const ChartAxis& axis) {
  if (!axis.logarithmic) return {axis.low, axis.high};
  std::vector<double> all;
  const int from = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int to = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  for (int power = from; power <= to; ++power) all.push_back(std::pow(10.0, power));
  return all;
}

std::string gridLine(double x1, double y1, double x2, double y2) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n", x1, y1,
      x2, y2);
}

std::string text(double x, double y, const std::string& attributes, const std::string& what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, what);
}

std::string grid(const ChartAxis& x, const ChartAxis& y) {
  constexpr double kBottom = kPlotTop + kPlotHeight, kRight = kPlotLeft + kPlotWidth;
  std::string out;
  for (const double value : marks(y)) {
    const double at = down(y, value);
    out += gridLine(kPlotLeft, at, kRight, at) +
           text(kPlotLeft - 6, at + 4, "text-anchor=\"end\"", fmt::format("{:g}", value));
  }
  for (const double value : marks(x)) {
    const double at = across(x, value);
    out += gridLine(at, kPlotTop, at, kBottom) +
           text(at, kBottom + 15, "text-anchor=\"middle\"", fmt::format("{:g}", value));
  }
  return out;
}

}  // namespace

std::string svgText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out;
}

std::string svgChart(const std::string& title, const std::string& below, const ChartAxis& x,
                     const ChartAxis& y, const std::vector<ChartLine>& lines) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n",
      kChartWidth, kChartHeight);
  out += text(kPlotLeft, 22, "font-size=\"14\"", title) + grid(x, y);
  double legend = kPlotTop;
  for (const ChartLine& line : lines) {
    std::string points;
    for (const auto& [px, py] : line.points) {
      if (std::isfinite(px) && std::isfinite(py))
        points += fmt::format("{:.1f},{:.1f} ", across(x, px), down(y, py));
    }
    out +=
        fmt::format("<polyline fill=\"none\" stroke=\"{}\" points=\"{}\"/>\n", line.colour, points);
    legend += kLegendStep;
    out += text(kPlotLeft + kPlotWidth - 6, legend,
                fmt::format("fill=\"{}\" text-anchor=\"end\"", line.colour), line.name);
  }
  return out + text(kPlotLeft, kChartHeight - 15, "", below) + "</svg>\n";
}

}  // namespace merlin::cli
