// The report of `merlin mesh import`, for people and as JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "daemon/cli/mesh/import_model.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/mesh.h"

namespace merlin::cli {

// Files and flags of the import that the report needs. `local`: whether a mesh is written without
// its origin.
struct ImportNames {
  std::string input, output;
  bool json = false, local = false;
};

// Duration of each step of the command [s].
struct ImportTimes {
  double reading = 0, filtering = 0, meshing = 0, reducing = 0, writing = 0;

  double all() const noexcept { return reading + filtering + meshing + reducing + writing; }
};

// Facts about the file that was written.
struct ImportedFile {
  std::size_t triangles = 0, vertices = 0;
  std::optional<std::size_t> coarsest{};  // number of triangles of a model's coarsest level
  render::mesh::WrittenMesh mesh{};       // for a mesh file; the format is empty for a model

  bool isMesh() const { return !mesh.format.empty() && triangles > 0; }
};

// Prints the report about the import of a range image, as JSON if names.json is true.
void reportRange(const ImportNames& names, const ImportedRange& range, const ImportedFile& written,
                 const ImportTimes& times);
// Prints the report about the import of a mesh, a model or points, as JSON if names.json is true.
void reportModel(const ImportNames& names, const ImportedModel& model, const ImportedFile& written,
                 const ImportTimes& times);

}  // namespace merlin::cli
