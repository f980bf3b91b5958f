// merlin mesh curve: prints a table of the estimated and the measured error over the number of
// triangles.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/compare_options.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "daemon/cli/svg_chart.h"
#include "render/compare/error_curve.h"

namespace merlin::cli {
namespace {

struct CurveOptions {
  std::string model, csv, svg;
  std::size_t steps_an_octave = 1;
  render::compare::CompareSettings settings{.samples = 100'000};
};

using render::compare::ErrorCurve;
using render::compare::ErrorPoint;

Result<ErrorCurve> measure(const render::lod::Dendrogram& model, const CurveOptions& options) {
  const SystemClock clock;
  ProgressBar bar("comparing", "resolutions", clock);
  auto curve = render::compare::errorCurve(
      model, options.steps_an_octave, options.settings,
      [&](double share, std::size_t compared) { bar.update(share, compared); });
  if (curve) bar.finish(curve->points.size());
  return curve;
}

std::string csvOf(const ErrorCurve& curve) {
  std::string out =
      "triangles,level,estimate,rms,mean,max_low,max_high,estimate_percent,rms_percent,"
      "mean_percent,max_low_percent,max_high_percent\n";
  for (const ErrorPoint& r : curve.points) {
    const double lengths[] = {r.estimate, r.error.rms, r.error.mean, r.error.max.low,
                              r.error.max.high};
    out += fmt::format("{},{}", r.triangles, r.level);
    for (const double length : lengths) out += fmt::format(",{:.9g}", length);
    for (const double length : lengths)
      out += fmt::format(",{:.6g}", 100 * length / curve.diagonal);
    out += '\n';
  }
  return out;
}

// Returns the curve as an SVG chart: number of triangles (x) and errors in percent of the diagonal
// (y), both on logarithmic axes.
std::string svgOf(const ErrorCurve& curve, const std::string& title) {
  ChartLine estimate{"estimate", "#7f7f7f", {}}, rms{"RMS", "#1f77b4", {}},
      most{"maximum, at most", "#d62728", {}};
  double low = 1e30, high = 0;
  for (const ErrorPoint& r : curve.points) {
    const auto triangles = static_cast<double>(r.triangles);
    const auto add = [&](ChartLine& line, double length) {
      const double percent = 100 * length / curve.diagonal;
      line.points.emplace_back(triangles, percent);
      if (percent > 0) low = std::min(low, percent);
      high = std::max(high, percent);
    };
    add(estimate, r.estimate);
    add(rms, r.error.rms);
    add(most, r.error.max.high);
  }
  const auto first = static_cast<double>(curve.points.back().triangles);
  const auto last = static_cast<double>(curve.points.front().triangles);
  return svgChart(svgText(title), "error in % of the diagonal over number of triangles",
                  {first, std::max(last, first + 1)}, {std::min(low, high / 10), high},
                  {estimate, rms, most});
}

void printTable(const ErrorCurve& curve) {
  printOut("{:>10}{:>12}{:>12}{:>16}{:>16}   % of the diagonal, {:.6g}\n", "triangles", "estimate",
           "RMS", "max, at least", "max, at most", curve.diagonal);
  const double percent = 100 / curve.diagonal;
  for (const ErrorPoint& r : curve.points) {
    printOut("{:>10}{:>12.4g}{:>12.4g}{:>16.4g}{:>16.4g}\n", r.triangles, percent * r.estimate,
             percent * r.error.rms, percent * r.error.max.low, percent * r.error.max.high);
  }
}

int curveOfModel(const CurveOptions& options) {
  if (const auto writable = checkOutputs(options.model, {options.csv, options.svg}); !writable)
    return fail(writable.error());
  const auto model = openModel(options.model);
  if (!model) return fail(model.error());
  if (model->levels() < 2) return fail(hasOneResolution(options.model));
  const auto curve = measure(*model, options);
  if (!curve) return fail({curve.error().code, options.model + ": " + curve.error().what});
  printTable(*curve);
  if (!options.csv.empty()) {
    if (const auto done = writeFile(options.csv, csvOf(*curve)); !done) return fail(done.error());
  }
  if (!options.svg.empty()) {
    const std::string name = options.model.substr(options.model.rfind('/') + 1);
    if (const auto done = writeFile(options.svg, svgOf(*curve, name)); !done)
      return fail(done.error());
  }
  return kExitDone;
}

}  // namespace

void addMeshCurve(Command mesh, Run& run) {
  const auto options = std::make_shared<CurveOptions>();
  Command command = mesh.subcommand(
      "curve",
      "Tabulate error against number of triangles: the estimate stored in the model, and the RMS "
      "and maximum distance from its finest resolution (the maximum as a certified "
      "interval).\nExample: merlin mesh curve scan.mrm --csv scan.csv --svg scan.svg");
  command.option("model", options->model, "The model").required().typeName("MODEL.mrm");
  command
      .option("--csv", options->csv,
              "Write a table of errors in model units and in % of the diagonal")
      .typeName("FILE");
  command.option("--svg", options->svg, "Write a chart with logarithmic axes").typeName("FILE");
  command
      .option("--steps", options->steps_an_octave,
              "Number of resolutions per halving of the triangles")
      .range(1, 16)
      .showDefault();
  addCompareOptions(command, options->settings);
  command.callback([options, &run] { run = [options] { return curveOfModel(*options); }; });
}

}  // namespace merlin::cli
