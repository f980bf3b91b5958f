// merlin mesh reduce: a mesh to a multiresolution model.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh.h"
#include "daemon/cli/mesh_memory.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "render/image/image_file.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/borders.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {
namespace {

struct ReduceOptions {
  std::string input, output, texture, preset = "default";
  std::vector<std::string> weights;
  render::ReduceSettings settings;
  std::uint64_t memory = 0;  // bytes; 0: what is free
  bool lock_borders = false;
  bool json = false;
};

// What the command took, for the report.
struct Took {
  double reducing = 0, all = 0;  // seconds
  std::size_t limit = 0;         // bytes
};

Result<render::Weights> weightsOf(const ReduceOptions& options, const render::Mesh& mesh) {
  render::Weights weights = render::findCost(options.settings.cost)->weights(mesh);
  for (const render::Preset& preset : render::presets()) {
    if (preset.name == options.preset) weights = render::presetWeights(preset, mesh);
  }
  for (const std::string& text : options.weights) {
    if (const auto set = setWeight(text, weights); !set) return set.error();
  }
  return weights;
}

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

void report(const ReduceOptions& options, const render::LoadedMesh& loaded,
            const render::ReduceReport& r, const Took& took) {
  const float diagonal = render::boundingBox(loaded.mesh.positions).diagonal();
  const double percent = diagonal > 0 ? 100.0 * static_cast<double>(r.error / diagonal) : 0;
  const double rate = took.reducing > 0 ? static_cast<double>(r.collapses) / took.reducing : 0;
  if (options.json) {
    nlohmann::ordered_json json = {{"output", options.output},
                                   {"cost", options.settings.cost},
                                   {"fast", options.settings.fast},
                                   {"triangles", loaded.mesh.triangleCount()},
                                   {"triangles_left", r.triangles},
                                   {"triangles_by_all_rules", r.by_all_rules},
                                   {"collapses", r.collapses},
                                   {"seconds", took.reducing},
                                   {"seconds_all", took.all},
                                   {"collapses_per_second", rate},
                                   {"peak_memory_mb", megabytes(peakMemory())},
                                   {"memory_limit_mb", megabytes(took.limit)},
                                   {"blocks", r.blocks},
                                   {"error_estimate", r.error},
                                   {"error_estimate_percent", percent},
                                   {"flips_refused", r.flips_refused},
                                   {"topology_refused", r.topology_refused},
                                   {"stopped", r.stopped}};
    for (const Repair& repair : repairsOf(loaded)) json[repair.key] = repair.count;
    printJsonLine(json);
    return;
  }
  say("{}: {} triangles down to {} in {} collapses ({})\n", options.output,
      loaded.mesh.triangleCount(), r.triangles, r.collapses, r.stopped);
  if (r.by_all_rules > r.triangles) {
    say("  all rules held down to {} triangles\n", r.by_all_rules);
  }
  say("  {:.2f} s, {:.0f} collapses a second; with reading and writing {:.2f} s\n", took.reducing,
      rate, took.all);
  say("  peak memory {:.0f} MB, limit {:.0f} MB{}\n", megabytes(peakMemory()),
      megabytes(took.limit), r.blocks > 1 ? fmt::format(", {} blocks", r.blocks) : "");
  say("  error estimate of the coarsest level {:.4g} ({:.3g} % of the diagonal); {} flips "
      "refused\n",
      r.error, percent, r.flips_refused);
  if (const std::string mended = mendedText(loaded); !mended.empty()) say("  {}\n", mended);
}

Result<render::Reduction> reduceLoaded(const ReduceOptions& options, const render::Mesh& mesh,
                                       Took& took) {
  render::ReduceSettings settings = options.settings;
  auto weights = weightsOf(options, mesh);
  if (!weights) return weights.error();
  settings.weights = *std::move(weights);
  if (options.lock_borders) settings.locked = render::borderVertices(mesh);
  const auto room = roomForReduction(sizeOf(mesh), 0, settings, took.limit);
  if (!room) return Error{room.error().code, options.input + ": " + room.error().what};
  settings.memory = *room;

  const SystemClock clock;
  ProgressBar bar("reducing", "collapses", clock);
  const Timestamp began = clock.now();
  const auto all = static_cast<double>(mesh.triangleCount());
  auto reduction = render::reduce(mesh, settings, [&](const render::ReduceProgress& p) {
    bar.update(1 - static_cast<double>(p.triangles) / all, p.collapses);
    return true;
  });
  if (!reduction) return reduction;
  took.reducing = toSeconds(clock.now() - began);
  bar.finish(reduction->report.collapses);
  return reduction;
}

// A picture that the mesh's file does not name.
Result<Ok> addTexture(const ReduceOptions& options, render::Mesh& mesh, std::size_t limit) {
  if (options.texture.empty()) return Ok{};
  const render::Feature* texcoord = mesh.find("texcoord");
  if (!texcoord || texcoord->dimension != 2) {
    return Error{
        Errc::kInvalidArgument,
        options.input + ": has no texture coordinates (a PLY's s and t or u and v, an OBJ's vt)"};
  }
  if (const auto fits = roomForPicture(options.texture, sizeOf(mesh), limit); !fits) return fits;
  auto picture = render::readImage(options.texture);
  if (!picture) return picture.error();
  mesh.texture = std::move(picture->file);
  return Ok{};
}

Result<Ok> checkOptions(const ReduceOptions& options) {
  const bool pattern = options.settings.cost == "pattern";
  if (const auto named = checkEnding(options.output, "model", ".mrm"); !named) return named;
  if (options.preset != "default" && !pattern)
    return Error{Errc::kInvalidArgument, "--preset " + options.preset + ": add --cost pattern"};
  if (options.settings.fast && pattern)
    return Error{Errc::kInvalidArgument, "--fast: of the cost quadric"};
  if (options.lock_borders && pattern)
    return Error{Errc::kInvalidArgument,
                 "--lock-borders: of the cost quadric; for pattern: --weight boundary=W"};
  return checkOutputs(options.input, {options.output});
}

int reduceMesh(const ReduceOptions& options) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  Took took;
  took.limit = options.memory > 0 ? options.memory : freeMemory();
  if (const auto fits = checkOptions(options); !fits) return fail(fits.error());
  if (const auto fits = checkRoom(options.input, options.settings, took.limit); !fits)
    return fail(fits.error());
  auto loaded = loadMesh(options.input);
  if (!loaded) return fail(loaded.error());
  if (const auto done = addTexture(options, loaded->mesh, took.limit); !done)
    return fail(done.error());
  if (const auto named = render::checkNames(loaded->mesh); !named)
    return fail({named.error().code, options.input + ": " + named.error().what});
  const auto reduction = reduceLoaded(options, loaded->mesh, took);
  if (!reduction) return fail(reduction.error());
  const auto written =
      render::writeMrm(options.output, loaded->mesh, reduction->log, options.settings.threads);
  if (!written) return fail(written.error());
  took.all = toSeconds(clock.now() - began);
  report(options, *loaded, reduction->report, took);
  return kExitDone;
}

}  // namespace

void addMeshReduce(Command mesh, Run& run) {
  const auto options = std::make_shared<ReduceOptions>();
  Command command = mesh.subcommand(
      "reduce",
      "A mesh (.ply, .obj) to a multiresolution model (.mrm): every resolution from all of it down "
      "to next to nothing.\nExample: merlin mesh reduce scan.ply -o scan.mrm --weight colour=0.02");
  command.option("input", options->input, "The mesh").required().typeName("IN");
  command.option("-o", options->output, "The model").required().typeName("OUT.mrm");
  std::vector<std::string> names;
  std::string help = "What an edge costs";
  for (const render::Cost& cost : render::costs()) {
    names.emplace_back(cost.name);
    help += fmt::format("; {}: {}", cost.name, cost.help);
  }
  command.option("--cost", options->settings.cost, help).oneOf(names).showDefault();
  std::vector<std::string> presets = {"default"};
  for (const render::Preset& preset : render::presets()) presets.emplace_back(preset.name);
  command
      .option("--preset", options->preset,
              "Weights to begin with: the cost's, or pattern's of 1998")
      .oneOf(presets)
      .showDefault();
  command
      .option("--weight", options->weights,
              "Of a feature: geometry, colour or any of the mesh's own, and for pattern normal, "
              "curvature, boundary; 0 leaves it out. Labels without one are kept apart")
      .typeName("FEATURE=W");
  command
      .option("--texture", options->texture,
              "The picture that the texture coordinates are of; else the one that the mesh's "
              "material names. It goes into the model")
      .typeName("FILE.png|.jpg");
  command.flag("--preserve-topology", options->settings.preserve_topology,
               "Refuse collapses that join or pinch off parts");
  command.flag("--preserve-components", options->settings.preserve_components,
               "Keep a triangle of every part until nothing else can go");
  command.flag("--lock-borders", options->lock_borders,
               "Keep the vertices of borders where they are until nothing else can go");
  command.flag("--fast", options->settings.fast,
               "A tenth to a third less time, for about 6 % more error");
  command.option("--triangles", options->settings.min_triangles, "Stop at so many triangles")
      .showDefault();
  command
      .option("--percent", options->settings.min_percent,
              "Stop at so many percent of the triangles")
      .range(0.0, 100.0)
      .showDefault();
  command
      .option("--error", options->settings.max_error_percent,
              "Stop at this error estimate, percent of the box' diagonal")
      .nonNegative();
  command
      .option("--threads", options->settings.threads,
              "So many at most; 0: all. The model is the same")
      .showDefault();
  command
      .option("--memory", options->memory,
              "The most that the whole command may take: 900M, 16G; else what is free. Where "
              "it is short the mesh is cut into blocks, and the model is a little different")
      .size()
      .typeName("SIZE");
  command.flag("--json", options->json, "The report for programs");
  command.callback([options, &run] { run = [options] { return reduceMesh(*options); }; });
}

}  // namespace merlin::cli
