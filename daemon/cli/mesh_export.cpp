// merlin mesh export: one resolution of a model as a mesh.
#include <memory>

#include <fmt/format.h>

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
  const auto model = openModel(options.model);
  if (!model) return fail(model.error());
  const std::size_t level = options.choice.levelOf(*model);
  const render::Mesh mesh = render::extract(*model, level);
  const auto written = render::writeMesh(options.output, mesh);
  if (!written) return fail(written.error());
  fmt::print("{}: {} triangles, {} vertices, error estimate {:.4g}\n", options.output,
             mesh.triangleCount(), mesh.vertexCount(), model->errorAt(level));
  return kExitDone;
}

}  // namespace

void addMeshExport(CLI::App& mesh, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command = mesh.add_subcommand("export",
                                          "One resolution of a model as a mesh.\nExample: merlin "
                                          "mesh export scan.mrm --percent 5 -o scan5.ply");
  command->add_option("model", options->model, "The model")->required()->type_name("MODEL.mrm");
  command->add_option("-o", options->output, "The mesh")->required()->type_name("OUT.ply");
  options->choice.addTo(*command);
  command->callback([options, &run] { run = [options] { return exportMesh(*options); }; });
}

}  // namespace merlin::cli
