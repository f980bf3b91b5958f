#include "daemon/cli/posture/learning_curve.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/cli/svg_chart.h"

namespace merlin::cli {
namespace {

constexpr double kLeast = 1e-5, kMost = 1.0;  // range of the error axis
constexpr std::size_t kLines = 10;
constexpr int kCurveBar = 30;

// Returns the position of an error on the logarithmic axis: 0 at kLeast, 1 at kMost.
double place(double error) {
  const double held = std::clamp(error, kLeast, kMost);
  return std::log10(held / kLeast) / std::log10(kMost / kLeast);
}

template <typename Value>
ChartLine line(std::span<const nn::CurvePoint> curve, const char* name, const char* colour,
               Value value) {
  ChartLine line{name, colour, {}};
  for (const nn::CurvePoint& p : curve)
    line.points.emplace_back(static_cast<double>(p.pass), value(p));
  return line;
}

}  // namespace

std::string curveText(std::span<const nn::CurvePoint> curve) {
  std::string out = "  pass  training  validation  noise\n";
  double validation = std::nan("");
  for (std::size_t n = 0; n < curve.size(); ++n) {
    if (std::isfinite(curve[n].validation)) validation = curve[n].validation;
    const std::size_t step = std::max<std::size_t>(curve.size() / kLines, 1);
    if ((n + 1) % step != 0 && n + 1 != curve.size()) continue;
    const int bar = static_cast<int>(std::lround(kCurveBar * place(curve[n].training)));
    out +=
        fmt::format("{:6}  {:8.5f}  {:>10}  {:5.2f}  {:#<{}}\n", curve[n].pass, curve[n].training,
                    std::isfinite(validation) ? fmt::format("{:.5f}", validation) : "-",
                    curve[n].noise, "", bar);
  }
  return out;
}

std::string curveSvg(std::span<const nn::CurvePoint> curve, const std::string& title) {
  const auto passes = static_cast<double>(std::max<std::size_t>(curve.size(), 2));
  return svgChart(
      svgText(title), "mean squared error over number of the pass", {1, passes, false},
      {kLeast, kMost},
      {line(curve, "training, with noise", "#1f77b4", [](const auto& p) { return p.training; }),
       line(curve, "validation", "#d62728", [](const auto& p) { return p.validation; })});
}

}  // namespace merlin::cli
