// The steps of `merlin mesh import` from a file of meshes, models or points to a mesh.
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

// A mesh, and what is known of the file it comes from.
struct ImportedModel {
  render::mesh::LoadedMesh loaded;
  std::string format = "mesh";
  std::optional<std::size_t> parts{};  // of a foreign format: surfaces that were joined
  // Number of common edges along which parts were welded, and of vertices that were merged with
  // others.
  std::size_t welded_edges = 0, welded_vertices = 0;
  std::optional<PointFacts> cloud{};
  std::vector<std::string> notes{};  // already printed
  Outwards outwards{};

  const render::mesh::Origin& origin() const { return cloud ? cloud->origin : loaded.origin; }
};

// The output file, beside which merlin-import's work folder is made, and the memory limit for
// reading, in merlin-import and in this program.
struct ModelLimits {
  std::string output;
  std::uint64_t memory_bytes = 0;
  render::points::SurfaceSettings surface{};  // of a point cloud
};

// Reads the file by our own readers, or by merlin-import, whose result is then read like any mesh.
// Adds normals; prints the notes. Errors: those of the readers, with the file's name;
// kInvalidArgument (the memory does not suffice).
Result<ImportedModel> loadModel(const std::string& path, const InputKind& kind,
                                const ModelLimits& limits);

}  // namespace merlin::cli
