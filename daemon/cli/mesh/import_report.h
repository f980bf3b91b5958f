// The report of `merlin mesh import`, for people and as JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "daemon/cli/mesh/import_model.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/mesh.h"

namespace merlin::cli {

struct ImportNames {
  std::string input, output;
  bool json = false, local = false;
};

// Seconds of the command's steps.
struct ImportTimes {
  double reading = 0, filtering = 0, meshing = 0, reducing = 0, writing = 0;

  double all() const noexcept { return reading + filtering + meshing + reducing + writing; }
};

// What was written.
struct ImportedFile {
  std::size_t triangles = 0, vertices = 0;
  std::optional<std::size_t> coarsest{};  // triangles of a model's coarsest level
  render::mesh::WrittenMesh mesh{};       // of a mesh file; its format is empty for a model

  bool isMesh() const { return !mesh.format.empty() && triangles > 0; }
};

void reportRange(const ImportNames& names, const ImportedRange& range, const ImportedFile& written,
                 const ImportTimes& times);
void reportModel(const ImportNames& names, const ImportedModel& model, const ImportedFile& written,
                 const ImportTimes& times);

}  // namespace merlin::cli
