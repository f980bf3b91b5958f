// merlin mesh export: writes one resolution of a model as a mesh, or all resolutions as an Open
// Inventor file.
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "render/compare/coarsest_within.h"
#include "render/inventor/multiresolution_writer.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {
namespace {

struct MeshExportOptions {
  std::string model, output;
  LevelChoice choice;
  std::optional<double> within;  // maximum distance from the finest resolution [% of the diagonal]
  bool multiresolution = false;
  bool local = false;  // whether to write coordinates without the origin
};

Result<std::size_t> levelOf(const MeshExportOptions& options,
                            const render::lod::Dendrogram& model) {
  if (!options.within) return options.choice.levelOf(model, options.model);
  if (model.levels() == 1) return hasOneResolution(options.model);
  const render::mesh::Mesh coarsest = render::lod::extract(model, model.levels() - 1);
  if (const auto free = render::mesh::checkCompanions(options.output, coarsest); !free)
    return free.error();
  const SystemClock clock;
  ProgressBar bar("comparing", "resolutions", clock);
  std::size_t compared = 0;
  const auto found =
      render::compare::coarsestWithin(model, *options.within, [&](double share, std::size_t n) {
        bar.update(share, n);
        compared = n;
      });
  if (!found) return Error{found.error().code, options.model + ": " + found.error().what};
  bar.finish(compared);
  printOut("distance from the finest resolution at most {:.4g}, {:.4g} % of the diagonal\n",
           found->at_most, found->percent);
  return found->level;
}

// Prints the origin of a map that is not added to the coordinates, because its unit (degrees, feet)
// may not be that of the mesh; prints nothing if the model states none.
void printMapOrigin(std::string_view about) {
  const std::string at = valueIn(about, "map.origin");
  if (!at.empty())
    printOut(
        "  origin    {} (of the map) is not added, because it is not known whether its unit is "
        "that of the mesh; the (0, 0) of the mesh lies there\n",
        at);
}

int exportAll(const MeshExportOptions& options) {
  if (!options.output.ends_with(".iv")) {
    return fail(
        {Errc::kInvalidArgument,
         options.output + ": --multiresolution can only be written as .iv (Open Inventor)"});
  }
  if (const auto writable = checkOutputs(options.model, {options.output}); !writable)
    return fail(writable.error());
  render::mesh::Origin origin{};
  const auto model = openModel(options.model, &origin);
  if (!model) return fail(model.error());
  auto written = render::inventor::writeMultiresolution(options.output, *model);
  if (!written) return fail(written.error());
  printOut("{}: {} to {} triangles, {} levels\n", options.output,
           model->trianglesAt(model->levels() - 1), model->triangleCount(), model->levels());
  written->relative_to = origin;
  printOrigin(origin, options.local, *written);
  printWritten(*written);
  return kExitDone;
}

int exportMesh(const MeshExportOptions& options) {
  if (const auto known = render::mesh::checkMeshEnding(options.output); !known)
    return fail(known.error());
  if (const auto writable = checkOutputs(options.model, {options.output}); !writable)
    return fail(writable.error());
  render::mesh::Origin origin{};
  const auto model = openModel(options.model, &origin);
  if (!model) return fail(model.error());
  const auto level = levelOf(options, *model);
  if (!level) return fail(level.error());
  const render::mesh::Mesh mesh = render::lod::extract(*model, *level);
  const auto written = render::mesh::writeMesh(options.output, mesh,
                                               options.local ? render::mesh::Origin{} : origin);
  if (!written) return fail(written.error());
  printOut("{}: {} triangles, {} vertices, error estimate {:.4g}\n", options.output,
           mesh.triangleCount(), mesh.vertexCount(), model->errorAt(*level));
  if (origin == render::mesh::Origin{}) printMapOrigin(model->arrays().about);
  printOrigin(origin, options.local, *written);
  printWritten(*written);
  return kExitDone;
}

}  // namespace

void addMeshExport(Command mesh, Run& run) {
  const auto options = std::make_shared<MeshExportOptions>();
  Command command = mesh.subcommand(
      "export",
      "Write one resolution of a model as a mesh: .ply (all features), .glb or .gltf (features of "
      "up to 4 dimensions), .obj and .iv (Open Inventor; normals, colours, texture coordinates), "
      ".stl (triangles only). A texture is stored inside .glb and .gltf, and in a file of its own "
      "beside .ply, .obj and .iv. A mesh of a map or a survey gets the coordinates of the original "
      "file again: doubles in .ply, decimals in .obj, a translation in .glb and .gltf. Those of "
      ".stl and .iv are floats, and stay relative to the model's origin, which is "
      "printed.\nExample: merlin mesh export scan.mrm --percent 5 -o scan5.ply\nExample with all "
      "resolutions, for an Open Inventor viewer that can load SoMRFaceSet.so: merlin mesh export "
      "scan.mrm --multiresolution -o scan.iv");
  command.option("model", options->model, "The model, or a mesh").required().typeName("MODEL.mrm");
  command.option("-o", options->output, "The mesh: .ply, .obj, .glb, .gltf, .stl or .iv")
      .required()
      .typeName("OUT");
  const Argument all = command.flag(
      "--multiresolution", options->multiresolution,
      "Write all resolutions as a node SoMRFaceSet (.iv only); viewers that cannot load the module "
      "of this node show 10,000 triangles");
  addLocal(command, options->local);
  Command resolution = options->choice.addTo(command);
  resolution
      .option(
          "--within", options->within,
          "Maximum certified distance from the finest resolution, in percent of the diagonal of "
          "the "
          "bounding box; selects the coarsest resolution found within this distance, after about "
          "ten comparisons")
      .range(1e-6, 100.0);
  resolution.exclude(all);
  command.callback([options, &run] {
    run = [options] {
      return options->multiresolution ? exportAll(*options) : exportMesh(*options);
    };
  });
}

}  // namespace merlin::cli
