// merlin mesh export: one resolution of a model as a mesh, or all of them for Open Inventor.
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh.h"
#include "render/inventor/multiresolution_writer.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {
namespace {

struct ExportOptions {
  std::string model, output;
  LevelChoice choice;
  bool multiresolution = false;
};

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
  fmt::print("{}: {} to {} triangles, {} levels\n", options.output,
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
  const auto level = options.choice.levelOf(*model, options.model);
  if (!level) return fail(level.error());
  const render::Mesh mesh = render::extract(*model, *level);
  const auto written = render::writeMesh(options.output, mesh);
  if (!written) return fail(written.error());
  fmt::print("{}: {} triangles, {} vertices, error estimate {:.4g}\n", options.output,
             mesh.triangleCount(), mesh.vertexCount(), model->errorAt(*level));
  printWritten(*written);
  return kExitDone;
}

}  // namespace

void addMeshExport(Command mesh, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  Command command = mesh.subcommand(
      "export",
      "One resolution of a model as a mesh: .ply (every feature), .glb or .gltf (features of up to "
      "4 dimensions), .obj and .iv (Open Inventor; normals, colours, texture coordinates), .stl "
      "(triangles alone). A texture's picture goes into .glb and .gltf, and beside .ply, .obj and "
      ".iv.\nExample: merlin mesh export scan.mrm --percent 5 -o scan5.ply\nAll of "
      "them for an Open Inventor viewer that finds SoMRFaceSet.so: --multiresolution -o scan.iv");
  command.option("model", options->model, "The model, or a mesh").required().typeName("MODEL.mrm");
  command.option("-o", options->output, "The mesh: .ply, .obj, .glb, .gltf, .stl or .iv")
      .required()
      .typeName("OUT");
  const Argument all = command.flag(
      "--multiresolution", options->multiresolution,
      "All resolutions as an SoMRFaceSet, .iv alone; at 10,000 triangles without its module");
  options->choice.addTo(command).exclude(all);
  command.callback([options, &run] {
    run = [options] {
      return options->multiresolution ? exportAll(*options) : exportMesh(*options);
    };
  });
}

}  // namespace merlin::cli
