// merlin mesh: adds its subcommands.
#include "daemon/cli/mesh/mesh.h"

#include "daemon/cli/command.h"

namespace merlin::cli {

void addMesh(Command app, Run& run) {
  Command mesh = app.subcommand("mesh",
                                "Meshes and multiresolution models: import, reduce, inspect, "
                                "export, compare, draw, segment, scan, fuse.");
  mesh.requireSubcommand();
  addMeshImport(mesh, run);
  addMeshReduce(mesh, run);
  addMeshInfo(mesh, run);
  addMeshCurve(mesh, run);
  addMeshExport(mesh, run);
  addMeshCompare(mesh, run);
  addMeshPicture(mesh, run);
  addMeshSegment(mesh, run);
  addMeshScan(mesh, run);
  addMeshFuse(mesh, run);
}

}  // namespace merlin::cli
