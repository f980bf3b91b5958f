// merlin mesh export: writes one resolution of a model as a mesh, or all of them for Open Inventor.
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "render/compare/compare.h"
#include "render/inventor/multiresolution_writer.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {
namespace {

struct ExportOptions {
  std::string model, output;
  LevelChoice choice;
  std::optional<double> within;  // maximum distance, percent of the diagonal
  bool multiresolution = false;
};

// A level and the upper bound of its distance from the finest level.
struct Within {
  std::size_t level = 0;
  double at_most = 0, percent = 0;  // in model units; in percent of the diagonal
};

// A level whose distance from the finest is certainly at most `percent` of the diagonal, and nearly
// the coarsest such: bisects the logarithm of the number of triangles down to 2 %.
Result<Within> coarsestWithin(const render::Dendrogram& model, double percent) {
  constexpr double kNearEnough = 1.02;
  const SystemClock clock;
  ProgressBar bar("comparing", "resolutions", clock);
  std::size_t compared_so_far = 0;
  const render::Mesh finest = render::extract(model, 0);
  const render::CompareSettings settings{.samples = 1, .width_percent = percent / 20};
  Within best;
  auto too_few = static_cast<double>(model.trianglesAt(model.levels() - 1)) / kNearEnough;
  auto enough = static_cast<double>(model.triangleCount());
  const double span = std::log(enough / too_few);
  while (enough > kNearEnough * too_few) {
    const double triangles = std::sqrt(too_few * enough);
    const std::size_t level = model.levelFor(static_cast<std::size_t>(triangles));
    const auto compared =
        render::compare(finest, render::extract(model, level), settings, [&](const auto&) {
          bar.update(1 - std::log(enough / too_few) / span, compared_so_far);
          return true;
        });
    if (!compared) return compared.error();
    ++compared_so_far;
    const double at_most = compared->symmetric().max.high;
    if (const double reached = 100 * at_most / compared->diagonal; reached <= percent) {
      best = {level, at_most, reached};
      enough = triangles;
    } else {
      too_few = triangles;
    }
  }
  bar.finish(compared_so_far);
  return best;
}

Result<std::size_t> levelOf(const ExportOptions& options, const render::Dendrogram& model) {
  if (!options.within) return options.choice.levelOf(model, options.model);
  if (model.levels() == 1) return hasOneResolution(options.model);
  const render::Mesh coarsest = render::extract(model, model.levels() - 1);
  if (const auto free = render::checkBeside(options.output, coarsest); !free) return free.error();
  const auto found = coarsestWithin(model, *options.within);
  if (!found) return Error{found.error().code, options.model + ": " + found.error().what};
  say("distance from the finest resolution at most {:.4g}, {:.4g} % of the diagonal\n",
      found->at_most, found->percent);
  return found->level;
}

int exportAll(const ExportOptions& options) {
  if (!options.output.ends_with(".iv")) {
    return fail({Errc::kInvalidArgument,
                 options.output + ": --multiresolution is written as .iv (Open Inventor)"});
  }
  if (const auto writable = checkOutputs(options.model, {options.output}); !writable)
    return fail(writable.error());
  const auto model = openModel(options.model);
  if (!model) return fail(model.error());
  const auto left_out = render::writeMultiresolution(options.output, *model);
  if (!left_out) return fail(left_out.error());
  say("{}: {} to {} triangles, {} levels\n", options.output,
      model->trianglesAt(model->levels() - 1), model->triangleCount(), model->levels());
  printWritten({"iv", *left_out, {}});
  return kExitDone;
}

int exportMesh(const ExportOptions& options) {
  if (const auto known = render::checkMeshEnding(options.output); !known)
    return fail(known.error());
  if (const auto writable = checkOutputs(options.model, {options.output}); !writable)
    return fail(writable.error());
  const auto model = openModel(options.model);
  if (!model) return fail(model.error());
  const auto level = levelOf(options, *model);
  if (!level) return fail(level.error());
  const render::Mesh mesh = render::extract(*model, *level);
  const auto written = render::writeMesh(options.output, mesh);
  if (!written) return fail(written.error());
  say("{}: {} triangles, {} vertices, error estimate {:.4g}\n", options.output,
      mesh.triangleCount(), mesh.vertexCount(), model->errorAt(*level));
  printWritten(*written);
  return kExitDone;
}

}  // namespace

void addMeshExport(Command mesh, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  Command command = mesh.subcommand(
      "export",
      "Write one resolution of a model as a mesh: .ply (all features), .glb or .gltf (features of "
      "up to 4 dimensions), .obj and .iv (Open Inventor; normals, colours, texture coordinates), "
      ".stl (triangles only). A texture is stored inside .glb and .gltf, and in a file of its own "
      "beside .ply, .obj and .iv.\nExample: merlin mesh export scan.mrm --percent 5 -o "
      "scan5.ply\nTo write all resolutions for an Open Inventor viewer that finds SoMRFaceSet.so: "
      "--multiresolution -o scan.iv");
  command.option("model", options->model, "The model, or a mesh").required().typeName("MODEL.mrm");
  command.option("-o", options->output, "The mesh: .ply, .obj, .glb, .gltf, .stl or .iv")
      .required()
      .typeName("OUT");
  const Argument all = command.flag(
      "--multiresolution", options->multiresolution,
      "Write all resolutions as an SoMRFaceSet (.iv only); viewers without its module show 10,000 "
      "triangles");
  Command resolution = options->choice.addTo(command);
  resolution
      .option(
          "--within", options->within,
          "Maximum distance from the finest resolution, certified, in percent of the diagonal of "
          "the bounding box; the coarsest resolution found within it is taken, after about ten "
          "comparisons")
      .range(1e-6, 100.0);
  resolution.exclude(all);
  command.callback([options, &run] {
    run = [options] {
      return options->multiresolution ? exportAll(*options) : exportMesh(*options);
    };
  });
}

}  // namespace merlin::cli
