#include "daemon/cli/learning_curve.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace merlin::cli {
namespace {

constexpr double kLeast = 1e-5, kMost = 1.0;  // of the errors that are drawn
constexpr std::size_t kLines = 10;
constexpr int kBar = 30;
constexpr int kWidth = 640, kHeight = 360, kLeft = 60, kTop = 40, kPlotWidth = 560,
              kPlotHeight = 270;

// 0 at kLeast, 1 at kMost.
double place(double error) {
  const double held = std::clamp(error, kLeast, kMost);
  return std::log10(held / kLeast) / std::log10(kMost / kLeast);
}

double x(std::size_t pass, std::size_t of) {
  return kLeft +
         kPlotWidth * static_cast<double>(pass) / static_cast<double>(std::max<std::size_t>(of, 1));
}

double y(double error) { return kTop + kPlotHeight * (1 - place(error)); }

template <typename Value>
std::string line(std::span<const nn::CurvePoint> curve, const char* colour, Value value) {
  std::string points;
  for (const nn::CurvePoint& p : curve) {
    if (std::isfinite(value(p)))
      points += fmt::format("{:.1f},{:.1f} ", x(p.pass, curve.size()), y(value(p)));
  }
  return fmt::format("<polyline fill=\"none\" stroke=\"{}\" points=\"{}\"/>\n", colour, points);
}

std::string grid() {
  std::string out;
  for (double error = kLeast; error <= kMost * 1.01; error *= 10)
    out += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{3}\" y=\"{2:.1f}\" text-anchor=\"end\">{4:g}</text>\n",
        kLeft, kLeft + kPlotWidth, y(error), kLeft - 6, error);
  return out;
}

}  // namespace

std::string curveText(std::span<const nn::CurvePoint> curve) {
  std::string out = "  pass  training  validation  noise\n";
  double validation = std::nan("");
  for (std::size_t n = 0; n < curve.size(); ++n) {
    if (std::isfinite(curve[n].validation)) validation = curve[n].validation;
    const std::size_t step = std::max<std::size_t>(curve.size() / kLines, 1);
    if ((n + 1) % step != 0 && n + 1 != curve.size()) continue;
    const int bar = static_cast<int>(std::lround(kBar * place(curve[n].training)));
    out +=
        fmt::format("{:6}  {:8.5f}  {:>10}  {:5.2f}  {:#<{}}\n", curve[n].pass, curve[n].training,
                    std::isfinite(validation) ? fmt::format("{:.5f}", validation) : "-",
                    curve[n].noise, "", bar);
  }
  return out;
}

std::string curveSvg(std::span<const nn::CurvePoint> curve, const std::string& title) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<text x=\"{}\" y=\"22\" font-size=\"14\">{}</text>\n",
      kWidth, kHeight, kLeft, title);
  out += grid();
  out += line(curve, "#1f77b4", [](const nn::CurvePoint& p) { return p.training; });
  out += line(curve, "#d62728", [](const nn::CurvePoint& p) { return p.validation; });
  out += fmt::format(
      "<text x=\"{}\" y=\"{}\">pass 1 to {}; mean squared error</text>\n"
      "<text x=\"{}\" y=\"{}\" fill=\"#1f77b4\">training, with noise</text>\n"
      "<text x=\"{}\" y=\"{}\" fill=\"#d62728\">validation</text>\n</svg>\n",
      kLeft, kTop + kPlotHeight + 30, curve.size(), kLeft + 300, kTop + kPlotHeight + 30,
      kLeft + 440, kTop + kPlotHeight + 30);
  return out;
}

}  // namespace merlin::cli
