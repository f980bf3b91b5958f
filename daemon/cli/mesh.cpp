// merlin mesh: its subcommands, one file each.
#include "daemon/cli/mesh.h"

#include "daemon/cli/command.h"

namespace merlin::cli {

void addMesh(CLI::App& app, Run& run) {
  CLI::App* mesh =
      app.add_subcommand("mesh", "Models: reduce, look into, export, compare, picture, segment.");
  mesh->require_subcommand(1);
  addMeshReduce(*mesh, run);
  addMeshInfo(*mesh, run);
  addMeshCurve(*mesh, run);
  addMeshExport(*mesh, run);
  addMeshCompare(*mesh, run);
  addMeshPicture(*mesh, run);
  addMeshSegment(*mesh, run);
}

}  // namespace merlin::cli
