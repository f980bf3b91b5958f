// merlin mesh reduce: creates a multiresolution model from a mesh.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/base/process_memory.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "daemon/cli/mesh/outwards.h"
#include "daemon/cli/mesh/reduction_step.h"
#include "daemon/cli/mesh/weight_options.h"
#include "daemon/cli/print.h"
#include "render/image/image_file.h"
#include "render/lod/io/mrm_file.h"
#include "render/mesh/borders.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {
namespace {

struct ReduceOptions {
  std::string input, output, texture;
  WeightOptions weights;
  render::reduce::ReduceSettings settings;
  std::uint64_t memory = 0;  // limit in bytes; 0: the free memory
  bool lock_borders = false;
  bool outwards = false;
  bool json = false;
};

// Duration and memory limit of the command, and the check for parts that face inwards, for the
// report.
struct Usage {
  double reducing = 0, all = 0;  // duration of the reduction alone, and of the whole command [s]
  std::size_t limit = 0;         // memory limit [bytes]
  Outwards outwards{};
};

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

void report(const ReduceOptions& options, const render::mesh::LoadedMesh& loaded,
            const render::reduce::ReduceReport& r, const Usage& usage) {
  const float diagonal = render::mesh::boundingBox(loaded.mesh.positions).diagonal();
  const double percent = diagonal > 0 ? 100.0 * static_cast<double>(r.error / diagonal) : 0;
  const double rate = usage.reducing > 0 ? static_cast<double>(r.collapses) / usage.reducing : 0;
  if (options.json) {
    nlohmann::ordered_json json = {{"output", options.output},
                                   {"cost", options.settings.cost},
                                   {"fast", options.settings.fast},
                                   {"triangles", loaded.mesh.triangleCount()},
                                   {"triangles_left", r.triangles},
                                   {"triangles_by_all_rules", r.by_all_rules},
                                   {"collapses", r.collapses},
                                   {"seconds", usage.reducing},
                                   {"seconds_all", usage.all},
                                   {"collapses_per_second", rate},
                                   {"peak_memory_mb", megabytes(peakMemory())},
                                   {"memory_limit_mb", megabytes(usage.limit)},
                                   {"blocks", r.blocks},
                                   {"error_estimate", r.error},
                                   {"error_estimate_percent", percent},
                                   {"flips_refused", r.flips_refused},
                                   {"topology_refused", r.topology_refused},
                                   {"stopped", r.stopped}};
    for (const Repair& repair : repairsOf(loaded)) json[repair.key] = repair.count;
    usage.outwards.addTo(json);
    printJsonLine(json);
    return;
  }
  printOut("{}: {} triangles down to {} in {} collapses ({})\n", options.output,
           loaded.mesh.triangleCount(), r.triangles, r.collapses, r.stopped);
  if (r.by_all_rules > r.triangles) {
    printOut("  all constraints were satisfied down to {} triangles, and not all of them below\n",
             r.by_all_rules);
  }
  printOut("  {:.2f} s, {:.0f} collapses per second; {:.2f} s with reading and writing\n",
           usage.reducing, rate, usage.all);
  printOut("  peak memory {:.0f} MB, limit {:.0f} MB{}\n", megabytes(peakMemory()),
           megabytes(usage.limit), r.blocks > 1 ? fmt::format(", {} blocks", r.blocks) : "");
  printOut(
      "  error estimate of the coarsest level {:.4g} ({:.3g} % of the diagonal); {} flips "
      "refused\n",
      r.error, percent, r.flips_refused);
  if (const std::string mended = mendedText(loaded); !mended.empty()) printOut("  {}\n", mended);
}

Result<render::reduce::Reduction> reduceLoaded(const ReduceOptions& options,
                                               const render::mesh::Mesh& mesh, Usage& usage) {
  render::reduce::ReduceSettings settings = options.settings;
  auto weights = options.weights.weightsFor(settings.cost, mesh);
  if (!weights) return weights.error();
  settings.weights = *std::move(weights);
  if (options.lock_borders) settings.locked = render::mesh::borderVertices(mesh);
  const auto room = roomForReduction(sizeOf(mesh), 0, settings, usage.limit);
  if (!room) return Error{room.error().code, options.input + ": " + room.error().what};
  settings.memory = *room;
  return reduceWithProgress(mesh, settings, usage.reducing);
}

// Adds the texture that --texture names, if any, to the mesh. Errors: kInvalidArgument (no texture
// coordinates, or too little memory), those of reading the image.
Result<Ok> addTexture(const ReduceOptions& options, render::mesh::Mesh& mesh, std::size_t limit) {
  if (options.texture.empty()) return Ok{};
  const render::mesh::Feature* texcoord = mesh.find("texcoord");
  if (!texcoord || texcoord->dimension != 2) {
    return Error{Errc::kInvalidArgument,
                 options.input +
                     ": has no texture coordinates (s and t or u and v in a PLY file, vt in an "
                     "OBJ file)"};
  }
  if (const auto fits = roomForPicture(options.texture, sizeOf(mesh), limit); !fits) return fits;
  auto picture = render::image::readImage(options.texture);
  if (!picture) return picture.error();
  mesh.texture = std::move(picture->file);
  return Ok{};
}

Result<Ok> checkOptions(const ReduceOptions& options) {
  const bool pattern = options.settings.cost == "pattern";
  if (const auto named = checkEnding(options.output, "model", ".mrm"); !named) return named;
  if (options.weights.hasPreset() && !pattern)
    return Error{Errc::kInvalidArgument,
                 "--preset " + options.weights.preset + ": needs --cost pattern"};
  if (options.settings.fast && pattern)
    return Error{Errc::kInvalidArgument, "--fast: needs --cost quadric"};
  if (options.lock_borders && pattern)
    return Error{
        Errc::kInvalidArgument,
        "--lock-borders: needs --cost quadric; with --cost pattern use --weight boundary=W"};
  return checkOutputs(options.input, {options.output});
}

int reduceMesh(const ReduceOptions& options) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  Usage usage;
  usage.limit = memoryLimit(options.memory);
  if (const auto fits = checkOptions(options); !fits) return fail(fits.error());
  if (const auto fits = checkRoom(options.input, options.settings, usage.limit); !fits)
    return fail(fits.error());
  auto loaded = loadMesh(options.input);
  if (!loaded) return fail(loaded.error());
  const std::size_t room = roomBeside(loaded->mesh, 0, usage.limit);
  const auto outwards = faceOutwards(options.input, options.outwards, room, loaded->mesh);
  if (!outwards) return fail(outwards.error());
  usage.outwards = *outwards;
  if (const auto done = addTexture(options, loaded->mesh, usage.limit); !done)
    return fail(done.error());
  if (const auto named = render::lod::checkNames(loaded->mesh); !named)
    return fail({named.error().code, options.input + ": " + named.error().what});
  auto reduction = reduceLoaded(options, loaded->mesh, usage);
  if (!reduction) return fail(reduction.error());
  reduction->log.about += aboutOrigin(loaded->origin);
  const auto written =
      render::lod::writeMrm(options.output, loaded->mesh, reduction->log, options.settings.threads);
  if (!written) return fail(written.error());
  usage.all = toSeconds(clock.now() - began);
  report(options, *loaded, reduction->report, usage);
  return kExitDone;
}

}  // namespace

void addMeshReduce(Command mesh, Run& run) {
  const auto options = std::make_shared<ReduceOptions>();
  Command command = mesh.subcommand(
      "reduce",
      "Reduce a mesh (" + render::mesh::readableEndings() +
          ") to a multiresolution model (.mrm), which contains every resolution from the "
          "full mesh down to a few triangles.\nExample: merlin mesh reduce scan.ply -o scan.mrm "
          "--weight colour=0.02");
  command.option("input", options->input, "The mesh").required().typeName("IN");
  command.option("-o", options->output, "The model").required().typeName("OUT.mrm");
  std::vector<std::string> names;
  std::string help = "Cost function of an edge collapse";
  for (const render::reduce::Cost& cost : render::reduce::costs()) {
    names.emplace_back(cost.name);
    help += fmt::format("; {}: {}", cost.name, cost.help);
  }
  command.option("--cost", options->settings.cost, help).oneOf(names).showDefault();
  options->weights.addTo(
      command,
      "Initial weights of the features: default (those of the selected --cost), or, with "
      "--cost pattern only, weights that Gourley's dissertation of 1998 used for its data",
      "Weight of a feature: geometry, colour or any other feature of the mesh; with --cost "
      "pattern also normal, curvature and boundary. 0 ignores the feature. Regions with "
      "different values of the feature label stay separate unless label has a weight");
  command
      .option("--texture", options->texture,
              "Texture image, which is stored in the model; the default is the image that the "
              "mesh's material names")
      .typeName("FILE.png|.jpg");
  addOutwards(command, options->outwards);
  command.flag("--preserve-topology", options->settings.preserve_topology,
               "Refuse edge collapses that connect or separate parts of the surface");
  command.flag(
      "--preserve-components", options->settings.preserve_components,
      "Keep at least one triangle of every connected component as long as other triangles can be "
      "removed");
  command.flag(
      "--lock-borders", options->lock_borders,
      "Keep vertices on the border of the mesh unchanged as long as others can be removed");
  command.flag("--fast", options->settings.fast,
               "Reduce the computing time by a tenth to a third; the error is about 6 % larger");
  command.option("--triangles", options->settings.min_triangles, "Stop at this number of triangles")
      .showDefault();
  command
      .option("--percent", options->settings.min_percent,
              "Stop at this percentage of the triangles")
      .range(0.0, 100.0)
      .showDefault();
  command
      .option("--error", options->settings.max_error_percent,
              "Stop at this error estimate, in percent of the diagonal of the bounding box")
      .nonNegative();
  command
      .option("--threads", options->settings.threads,
              "Maximum number of threads; 0: all cores. The model does not depend on this number")
      .showDefault();
  command
      .option(
          "--memory", options->memory,
          "Maximum memory of the whole command, such as 900M or 16G; the default is the free "
          "memory. If it does not suffice, the mesh is reduced in blocks, and the model differs "
          "slightly")
      .size()
      .typeName("SIZE");
  command.flag("--json", options->json, "Print the report as JSON, for programs");
  command.callback([options, &run] { run = [options] { return reduceMesh(*options); }; });
}

}  // namespace merlin::cli
