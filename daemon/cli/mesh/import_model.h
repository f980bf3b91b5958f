// Reads a file with meshes, models or points as a mesh, for `merlin mesh import`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/mesh/import_points.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "daemon/cli/mesh/outwards.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::cli {

// A mesh, and facts about the file that it was read from.
struct ImportedModel {
  render::mesh::LoadedMesh loaded;
  std::string format = "mesh";
  std::optional<std::size_t> parts{};  // for a foreign format: number of surfaces that were joined
  // Number of common edges along which parts were welded, and of vertices that were merged with
  // others.
  std::size_t welded_edges = 0, welded_vertices = 0;
  std::optional<PointFacts> cloud{};
  std::vector<std::string> notes{};  // notes for the user, which are printed already
  Outwards outwards{};

  const render::mesh::Origin& origin() const { return cloud ? cloud->origin : loaded.origin; }
};

// Output file and limits of the import. The work folder of merlin-import is made beside the output
// file; the memory limit applies to reading in merlin-import and in this program.
struct ModelLimits {
  std::string output;
  std::uint64_t memory_bytes = 0;
  render::points::SurfaceSettings surface{};  // settings for the surface of a point cloud
};

// Reads the file with the readers of MERLIN, or runs merlin-import and reads its result. Adds
// normals if there are none; prints the notes. Errors: those of the readers, with the file's name;
// kInvalidArgument (the memory does not suffice).
Result<ImportedModel> loadModel(const std::string& path, const InputKind& kind,
                                const ModelLimits& limits);

}  // namespace merlin::cli
