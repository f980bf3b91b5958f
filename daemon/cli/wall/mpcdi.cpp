// merlin wall mpcdi: exports the corrections of a configuration's outputs to an MPCDI file, and
// imports such a file.
#include "daemon/cli/wall/mpcdi.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

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
#include "daemon/cli/wall/aligned_wall.h"
#include "daemon/state/state.h"
#include "daemon/state/state_folder.h"
#include "render/correct/io/mpcdi.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// --- export ---

struct MpcdiExportOptions {
  std::string file, config, output;
};

// Returns the settings of the configuration, with the wall as it is drawn (drawnWall()). Errors:
// kInvalidArgument (the configuration is invalid; the text is the first finding).
Result<Settings> readSettings(const std::string& path) {
  const LoadedSettings loaded = loadSettingsFile(path);
  for (const Finding& finding : loaded.findings) {
    if (!finding.adjusted) return Error{Errc::kInvalidArgument, toText(path, finding)};
  }
  Settings settings = loaded.settings;
  settings.wall = drawnWall(settings.wall);
  return settings;
}

// The moves that were made with merlin wall align, from the running wall or from its state file.
struct Moves {
  AlignAnswer answer;                // answer of the running wall
  std::optional<state::State> kept;  // state file of a wall that does not run
};

// Returns the moves on the wall of this configuration. If the wall cannot be asked, returns those
// in its state file and prints a note. If that file cannot be read either, because its place
// depends on the user who runs merlind, returns none and prints a note.
Moves movesOf(const Settings& settings) {
  auto answer = AlignedWall(settings.instance).ask(state::ListRequest{});
  if (answer) return {*std::move(answer), {}};
  const std::string file = state::findStateFile(settings.state_file, settings.instance);
  const auto text = file.empty() ? Result<std::string>(Error{Errc::kNotFound, "there is none"})
                                 : state::StateFolder(file).read();
  auto kept = text ? state::parseState(*text, file) : Result<state::State>(text.error());
  if (kept) {
    printNote(
        fmt::format("what merlin wall align has moved is read from the state file {}, since the "
                    "wall cannot be asked: {}",
                    file, answer.error().what));
    return {{}, *std::move(kept)};
  }
  printNote(
      fmt::format("if merlin wall align has moved anything, it is not in the file, since the "
                  "wall cannot be asked: {}",
                  answer.error().what));
  return {};
}

// Converts the moves of an output in the state file to the form of a running wall's answer. If the
// file does not state for which configured corners the moves were made, those of `correction` are
// assumed.
AlignedPicture keptPicture(const state::OutputAlignment& kept,
                           const render::correct::CorrectionSettings& correction) {
  const state::OutputForm& form = kept.form;
  AlignedPicture picture{form.output, form.width, form.height, false, {}};
  picture.mesh_columns = form.mesh_columns;
  picture.mesh_rows = form.mesh_rows;
  const std::array<double, 8> corners = form.corners.value_or(correction.corners);
  for (std::size_t i = 0; i < picture.corners.size(); ++i)
    picture.corners[i].configured = {corners[2 * i], corners[2 * i + 1]};
  for (const auto& [place, by] : kept.moved) {
    if (place.of == state::Place::Of::kPin)
      picture.corners[place.corner()].moved = by;
    else
      picture.points.push_back({place.column, place.row, by});
  }
  return picture;
}

// Returns the moves of the output, which has the size `size`; nothing if there are none.
std::optional<AlignedPicture> movesOfOutput(const Moves& moves,
                                            const render::out::OutputSettings& output,
                                            const render::out::PictureSize& size) {
  const std::string name = output.shownName();
  if (const AlignedPicture* const moved = moves.answer.find(name)) return *moved;
  if (!moves.kept) return std::nullopt;
  const render::correct::MeshSettings& mesh = output.correction.mesh;
  const state::OutputAlignment* kept = state::alignmentFor(
      *moves.kept,
      {name, size.width, size.height, mesh.columns, mesh.rows, output.correction.corners});
  if (!kept) kept = moves.kept->alignment.find(name);
  return kept ? std::optional(keptPicture(*kept, output.correction)) : std::nullopt;
}

// Returns the correction including the moves; nothing if the moves were made for another size, mesh
// or corners, or the result is not valid.
std::optional<render::correct::CorrectionSettings> movedCorrection(
    render::correct::CorrectionSettings correction, const render::out::PictureSize& size,
    const AlignedPicture& moved) {
  const bool is_same = moved.width == size.width && moved.height == size.height &&
                       moved.mesh_columns == correction.mesh.columns &&
                       moved.mesh_rows == correction.mesh.rows;
  if (!is_same) return std::nullopt;
  for (std::size_t i = 0; i < moved.corners.size(); ++i) {
    const auto& [configured, by] = moved.corners[i];
    const state::Offset here{correction.corners[2 * i], correction.corners[2 * i + 1]};
    if (here != configured) return std::nullopt;
    moveCorner(correction, i, by.x, by.y);
  }
  for (const AlignedPoint& point : moved.points) {
    moveMeshPoint(correction.mesh, point.column, point.row,
                  {point.moved.x / size.width, point.moved.y / size.height});
  }
  if (!validate(correction, size.width, size.height).empty()) return std::nullopt;
  return correction;
}

// Adds the moves of the output, if any, to its correction, and prints a note about that.
void addMoves(render::out::OutputSettings& output, const render::out::PictureSize& size,
              const Moves& moves) {
  const std::string name = output.shownName();
  const auto moved = movesOfOutput(moves, output, size);
  if (!moved || !moved->isMoved()) return;
  const auto correction = movedCorrection(output.correction, size, *moved);
  if (!correction) {
    printNote(
        moves.kept
            ? fmt::format("{}: what merlin wall align has moved is not in the file: it was made "
                          "for another size, mesh or corners of this output than the "
                          "configuration has",
                          name)
            : fmt::format("{}: what merlin wall align has moved is not in the file: the wall runs "
                          "with another size, mesh or corners of this output than the "
                          "configuration has; run merlin reload, then export again",
                          name));
    return;
  }
  output.correction = *correction;
  printNote(
      fmt::format("{0}: what merlin wall align has moved is in the file; once the "
                  "configuration uses the file, run merlin wall align --reset --output {0}, or "
                  "it is moved twice",
                  name));
}

Result<render::correct::MpcdiOutput> exported(const render::out::OutputSettings& output,
                                              const render::out::PictureSize& size) {
  const render::correct::CorrectionSettings& correction = output.correction;
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

// Returns the requested output or, without a request, all outputs with a correction; at least one.
// Errors: kInvalidArgument (there is none; the text names the existing outputs), those of
// exported().
Result<std::vector<render::correct::MpcdiOutput>> exportedOutputs(const MpcdiExportOptions& options,
                                                                  const Settings& settings) {
  const Moves moves = movesOf(settings);
  std::vector<render::correct::MpcdiOutput> outputs;
  std::vector<std::string> names;
  for (render::out::OutputSettings output : settings.wall.outputs) {
    names.push_back(output.shownName());
    if (!options.output.empty() && names.back() != options.output) continue;
    const auto size = *render::out::pictureSize(output, settings.wall.tiles);
    addMoves(output, size, moves);
    if (options.output.empty() && output.correction.isOff()) continue;
    auto made = exported(output, size);
    if (!made) return made.error();
    outputs.push_back(*std::move(made));
  }
  if (!outputs.empty()) return outputs;
  return Error{Errc::kInvalidArgument,
               options.output.empty()
                   ? fmt::format("{}: no output has a correction; --output NAME also exports an "
                                 "output without one: {}",
                                 options.config, fmt::join(names, ", "))
                   : fmt::format("{}: no output is named \"{}\"; there are {}", options.config,
                                 options.output, fmt::join(names, ", "))};
}

int exportFile(const MpcdiExportOptions& options) {
  if (const auto named = checkEnding(options.file, "correction file", ".mpcdi"); !named)
    return fail(named.error());
  const auto settings = readSettings(options.config);
  if (!settings) return fail(settings.error());
  const auto outputs = exportedOutputs(options, *settings);
  if (!outputs) return fail(outputs.error());
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto bytes =
      render::correct::mpcdiBytes(*outputs, fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(now)));
  if (!bytes) return fail(bytes.error());
  if (const auto written = writeFile(options.file, *bytes); !written) return fail(written.error());
  for (const render::correct::MpcdiOutput& output : *outputs)
    printOut("{}: region {}, {} x {} pixels\n", options.file, output.name, output.width,
             output.height);
  return kExitDone;
}

void addExport(Command mpcdi, Run& run) {
  const auto options = std::make_shared<MpcdiExportOptions>();
  Command command = mpcdi.subcommand(
      "export",
      "Write the warp, blend and black level of a configuration's outputs as an MPCDI file "
      "(profile 2d), with a region for each output that has a correction. The "
      "file includes what was moved with merlin wall align, of a wall that does not run as its "
      "state file has it, and a note says so: once the "
      "configuration uses the file, run merlin wall align --reset --output NAME, or it is moved "
      "twice.\nExample: merlin wall mpcdi export wall.mpcdi -c /etc/merlin/merlin.json");
  command.option("file", options->file, "The MPCDI file").required().typeName("FILE.mpcdi");
  command.option("-c,--config", options->config, "The configuration").required().typeName("CONFIG");
  command.option("--output", options->output, "Only this output, corrected or not")
      .typeName("NAME");
  command.callback([options, &run] { run = [options] { return exportFile(*options); }; });
}

// --- import ---

struct MpcdiImportOptions {
  std::string file, region, output;
};

// Figures about the warp of a region: the farthest move of a pixel [px], the number of mesh points
// that stay black, and whether the picture is mirrored.
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

// Prints facts about a region for a person who is going to use it, to stderr, because the JSON goes
// to stdout.
void printRegion(const std::string& file, const render::correct::MpcdiRegion& region,
                 const render::correct::MeasuredCorrection& measured) {
  const WarpFigures figures = figuresOf(region, measured.warp);
  printError(
      "{}: region {}: {} x {} pixels, warp of {} x {} cells, moves pixels by up to {:.1f}, "
      "{} cells show nothing, {}, {}\n",
      printable(file), region.id, region.width, region.height, measured.warp.columns,
      measured.warp.rows, figures.farthest, figures.black,
      measured.alpha ? "alpha map" : "no alpha map", measured.beta ? "beta map" : "no beta map");
  if (!region.part.empty()) {
    printNote(
        fmt::format("region {} shows only a part of the picture of buffer {}: {}. MERLIN "
                    "takes the picture of the output for that part: let its tiles show this "
                    "part and no more (/wall/outputs/N/tiles)",
                    region.id, region.buffer, region.part));
  }
  if (figures.mirrored) {
    printNote(
        fmt::format("region {} shows the picture mirrored. For a mirrored projector this is right; "
                    "otherwise the file lists the rows of its warp from the top, while the format "
                    "requires them from the bottom",
                    region.id));
  }
}

int importFile(const MpcdiImportOptions& options) {
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
  const auto options = std::make_shared<MpcdiImportOptions>();
  Command command = mpcdi.subcommand(
      "import",
      "Check an MPCDI file (profile 2d) and print, for each of its regions, the correction that "
      "uses it, to be put into an output of the configuration.\n"
      "Example: merlin wall mpcdi import wall.mpcdi");
  command.option("file", options->file, "The MPCDI file").required().typeName("FILE.mpcdi");
  command.option("--region", options->region, "Only this region").typeName("ID");
  command.option("-o", options->output, "Write the JSON into this file instead of printing it")
      .typeName("FILE.json");
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
