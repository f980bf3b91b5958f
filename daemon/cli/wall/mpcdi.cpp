// merlin wall mpcdi: the corrections of a configuration's outputs as an MPCDI file, and the way
// back.
#include "daemon/cli/wall/mpcdi.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "config/drawn_wall.h"
#include "config/loader.h"
#include "daemon/base/files.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "render/correct/io/mpcdi.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// --- export
// ----------------------------------------------------------------------------------------

struct ExportOptions {
  std::string file, config, output;
};

// The first finding that makes it invalid, as an error.
Result<WallSettings> readWall(const std::string& path) {
  const LoadedSettings loaded = loadSettingsFile(path);
  for (const Finding& finding : loaded.findings) {
    if (!finding.adjusted) return Error{Errc::kInvalidArgument, toText(path, finding)};
  }
  return drawnWall(loaded.settings.wall);
}

Result<render::correct::MpcdiOutput> exported(const render::out::OutputSettings& output,
                                              const render::tiles::TilesSettings& tiles) {
  const render::correct::CorrectionSettings& correction = output.correction;
  const auto size = *render::out::pictureSize(output, tiles);
  std::optional<render::correct::MeasuredCorrection> measured;
  if (!correction.mpcdi.empty()) {
    auto read = render::correct::readMeasured(correction.mpcdi, correction.mpcdi_region);
    if (!read) return read.error();
    measured = *std::move(read);
  }
  if (!correction.colour.isOff()) {
    printNote(
        fmt::format("{}: its matrix, gain and gamma of colours stay in the configuration; "
                    "the file has warp, blend and black level",
                    output.shownName()));
  }
  return render::correct::mpcdiOutput(output.shownName(), correction, size.width, size.height,
                                      measured ? &*measured : nullptr, threadsOr(0));
}

int exportFile(const ExportOptions& options) {
  if (const auto named = checkEnding(options.file, "correction file", ".mpcdi"); !named)
    return fail(named.error());
  const auto wall = readWall(options.config);
  if (!wall) return fail(wall.error());
  std::vector<render::correct::MpcdiOutput> outputs;
  std::vector<std::string> names;
  for (const render::out::OutputSettings& output : wall->outputs) {
    names.push_back(output.shownName());
    const bool wanted =
        options.output.empty() ? !output.correction.isOff() : output.shownName() == options.output;
    if (!wanted) continue;
    auto made = exported(output, wall->tiles);
    if (!made) return fail(made.error());
    outputs.push_back(*std::move(made));
  }
  if (outputs.empty()) {
    return fail({Errc::kInvalidArgument,
                 options.output.empty()
                     ? fmt::format("{}: no output has a correction; --output NAME writes one "
                                   "without: {}",
                                   options.config, fmt::join(names, ", "))
                     : fmt::format("{}: no output is named \"{}\"; there are {}", options.config,
                                   options.output, fmt::join(names, ", "))});
  }
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto bytes =
      render::correct::mpcdiBytes(outputs, fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(now)));
  if (!bytes) return fail(bytes.error());
  if (const auto written = writeFile(options.file, *bytes); !written) return fail(written.error());
  for (const render::correct::MpcdiOutput& output : outputs)
    printOut("{}: region {}, {} x {} pixels\n", options.file, output.name, output.width,
             output.height);
  return kExitDone;
}

void addExport(Command mpcdi, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  Command command =
      mpcdi.subcommand("export",
                       "Write the warp, blend and black level of a configuration's outputs as an "
                       "MPCDI file (profile "
                       "2d), with a region for each output that has a correction. What was moved "
                       "by merlin wall align is not in it: write the corners that merlin wall "
                       "align --list prints into the configuration and add what it prints of moved "
                       "points to those of the mesh there, then merlin wall align --reset --output "
                       "NAME.\n"
                       "Example: merlin wall mpcdi export wall.mpcdi -c /etc/merlin/merlin.json");
  command.option("file", options->file, "The MPCDI file").required().typeName("FILE.mpcdi");
  command.option("-c,--config", options->config, "The configuration").required().typeName("CONFIG");
  command.option("--output", options->output, "Only this output, corrected or not")
      .typeName("NAME");
  command.callback([options, &run] { run = [options] { return exportFile(*options); }; });
}

// --- import
// ----------------------------------------------------------------------------------------

struct ImportOptions {
  std::string file, region, output;
};

// How far a region's warp moves its pixels, in pixels, and how many it leaves black.
struct WarpFigures {
  double farthest = 0;
  std::size_t black = 0;
  bool mirrored = false;
};
WarpFigures figuresOf(const render::correct::MpcdiRegion& region,
                      const render::correct::MeasuredWarp& warp) {
  WarpFigures figures;
  double area = 0;
  const auto columns = static_cast<std::size_t>(warp.columns);
  for (std::size_t i = 0; i < warp.places.size(); ++i) {
    const render::correct::Point p = warp.places[i];
    if (std::isnan(p.x)) {
      ++figures.black;
      continue;
    }
    const std::size_t column = i % columns, row = i / columns;
    const double x = (static_cast<double>(column) + 0.5) / warp.columns;
    const double y = (static_cast<double>(row) + 0.5) / warp.rows;
    figures.farthest =
        std::max(figures.farthest, std::hypot((p.x - x) * region.width, (p.y - y) * region.height));
    if (column + 1 == columns || i + columns >= warp.places.size()) continue;
    const render::correct::Point right = warp.places[i + 1], below = warp.places[i + columns];
    const double turn = (right.x - p.x) * (below.y - p.y) - (right.y - p.y) * (below.x - p.x);
    if (!std::isnan(turn)) area += turn;
  }
  figures.mirrored = area < 0;
  return figures;
}

Json correctionJson(const std::string& file, const render::correct::MpcdiRegion& region) {
  Json correction = {{"mpcdi", file}, {"mpcdi_region", region.id}};
  if (region.gamma > 0) correction["blend"] = {{"gamma", region.gamma}};
  return correction;
}

// What a person wants to know of a region before it is used, to stderr: the JSON goes to stdout.
void printRegion(const std::string& file, const render::correct::MpcdiRegion& region,
                 const render::correct::MeasuredCorrection& measured) {
  const WarpFigures figures = figuresOf(region, measured.warp);
  printError(
      "{}: region {}: {} x {} pixels, warp of {} x {} cells, moves pixels by up to {:.1f}, "
      "{} cells show nothing, {}, {}\n",
      printable(file), region.id, region.width, region.height, measured.warp.columns,
      measured.warp.rows, figures.farthest, figures.black,
      measured.alpha ? "alpha map" : "no alpha map", measured.beta ? "beta map" : "no beta map");
  if (figures.mirrored) {
    printNote(
        fmt::format("region {} shows the picture mirrored. For a mirrored projector that is "
                    "right; else its file has the rows of its warp from the top, and the "
                    "format has them from below",
                    region.id));
  }
}

int importFile(const ImportOptions& options) {
  const auto file = FileCopy::read(options.file);
  if (!file) return fail(file.error());
  const auto named = [&](const Error& error) {
    return fail({error.code, fmt::format("{}: {}", options.file, error.what)});
  };
  const auto mpcdi = render::correct::Mpcdi::open(file->bytes());
  if (!mpcdi) return named(mpcdi.error());
  const std::string path = std::filesystem::absolute(options.file).lexically_normal().string();
  Json corrections = Json::object();
  for (const render::correct::MpcdiRegion& region : mpcdi->regions()) {
    if (!options.region.empty() && region.id != options.region) continue;
    const auto measured = mpcdi->measured(region.id);
    if (!measured) return named(measured.error());
    printRegion(options.file, region, *measured);
    corrections[region.id] = {{"correction", correctionJson(path, region)}};
  }
  if (corrections.empty()) return named(mpcdi->measured(options.region).error());
  const std::string text = corrections.dump(2) + "\n";
  if (options.output.empty()) {
    fmt::print("{}", text);
    return kExitDone;
  }
  const auto written = writeFile(options.output, text);
  return written ? int{kExitDone} : fail(written.error());
}

void addImport(Command mpcdi, Run& run) {
  const auto options = std::make_shared<ImportOptions>();
  Command command = mpcdi.subcommand(
      "import",
      "Check an MPCDI file (profile 2d) and print, for each of its regions, the correction that "
      "uses it, to be put into an output of the configuration.\n"
      "Example: merlin wall mpcdi import wall.mpcdi");
  command.option("file", options->file, "The MPCDI file").required().typeName("FILE.mpcdi");
  command.option("--region", options->region, "Only this region").typeName("ID");
  command.option("-o", options->output, "Write the JSON there instead").typeName("FILE.json");
  command.callback([options, &run] { run = [options] { return importFile(*options); }; });
}

}  // namespace

void addMpcdi(Command wall, Run& run) {
  Command mpcdi = wall.subcommand(
      "mpcdi", "Corrections as MPCDI files, which calibration tools and media servers exchange");
  mpcdi.requireSubcommand();
  addExport(mpcdi, run);
  addImport(mpcdi, run);
}

}  // namespace merlin::cli
