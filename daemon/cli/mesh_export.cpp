// merlin mesh export: one resolution of a model as a mesh.
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {
namespace {

struct ExportOptions {
  std::string model, output;
  LevelChoice choice;
};

int exportMesh(const ExportOptions& options) {
  if (const auto known = render::checkMeshEnding(options.output); !known)
    return fail(known.error());
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  const auto model = openModel(options.model);
  if (!model) return fail(model.error());
  const std::size_t level = options.choice.levelOf(*model);
  const render::Mesh mesh = render::extract(*model, level);
  const auto written = render::writeMesh(options.output, mesh);
  if (!written) return fail(written.error());
  fmt::print("{}: {} triangles, {} vertices, error estimate {:.4g}\n", options.output,
             mesh.triangleCount(), mesh.vertexCount(), model->errorAt(level));
  if (!written->left_out.empty()) {
    fmt::print("  .{} has no place for {}; it is left out\n", written->format,
               fmt::join(written->left_out, ", "));
  }
  return kExitDone;
}

}  // namespace

void addMeshExport(CLI::App& mesh, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command = mesh.add_subcommand(
      "export",
      "One resolution of a model as a mesh: .ply (every feature), .glb or .gltf (features of up to "
      "4 dimensions), .obj and .iv (Open Inventor; normals, colours, texture coordinates), .stl "
      "(triangles alone).\nExample: merlin mesh export scan.mrm --percent 5 -o scan5.ply");
  command->add_option("model", options->model, "The model, or a mesh")
      ->required()
      ->type_name("MODEL.mrm");
  command->add_option("-o", options->output, "The mesh: .ply, .obj, .glb, .gltf, .stl or .iv")
      ->required()
      ->type_name("OUT");
  options->choice.addTo(*command);
  command->callback([options, &run] { run = [options] { return exportMesh(*options); }; });
}

}  // namespace merlin::cli
