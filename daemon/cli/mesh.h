// The subcommands of `merlin mesh`, and how they open a model of either kind.
#pragma once

#include <optional>
#include <string>

#include "daemon/cli/command.h"
#include "render/lod/dendrogram.h"

namespace merlin::cli {

void addMeshCompare(CLI::App& mesh, Run& run);
void addMeshExport(CLI::App& mesh, Run& run);
void addMeshInfo(CLI::App& mesh, Run& run);
void addMeshPicture(CLI::App& mesh, Run& run);
void addMeshReduce(CLI::App& mesh, Run& run);

// An .mrm file as it is, or a mesh as a dendrogram of one level. Errors: of the readers.
Result<render::Dendrogram> openModel(const std::string& path);

// A mesh as a model of one level.
render::Dendrogram asModel(const render::Mesh& mesh);

// Which resolution: at most one is set.
struct LevelChoice {
  std::optional<double> percent, error_percent, error_units;
  std::optional<std::size_t> triangles;

  void addTo(CLI::App& command);
  std::size_t levelOf(const render::Dendrogram& model) const;  // 0 where none is set
};

}  // namespace merlin::cli
