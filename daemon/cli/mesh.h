// The subcommands of `merlin mesh`, and how they open a model of either kind.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"
#include "render/lod/dendrogram.h"
#include "render/mesh/io/mesh_file.h"
#include "render/reduce/pattern_space.h"

namespace merlin::cli {

void addMeshCompare(Command mesh, Run& run);
void addMeshCurve(Command mesh, Run& run);
void addMeshExport(Command mesh, Run& run);
void addMeshInfo(Command mesh, Run& run);
void addMeshPicture(Command mesh, Run& run);
void addMeshReduce(Command mesh, Run& run);
void addMeshSegment(Command mesh, Run& run);

// An .mrm file as it is, or a mesh as a dendrogram of one level. Errors: of the readers.
Result<render::Dendrogram> openModel(const std::string& path);

// A mesh with normals; what was noted while reading it goes to stderr. Errors: of readMesh().
Result<render::LoadedMesh> loadMesh(const std::string& path);

// What reading had to mend, with a key for programs and a name for people; counts may be 0.
struct Repair {
  const char* key;
  const char* name;
  std::size_t count;
};
std::vector<Repair> repairsOf(const render::LoadedMesh& loaded);

// Those that happened as one line, "mended: 3 triangles with a vertex twice, ..."; else empty.
std::string mendedText(const render::LoadedMesh& loaded);

// Of a mesh that was written, for people: the files beside it, and what its format has no place
// for.
void printWritten(const render::WrittenMesh& written);

// Before any work: whether these can be written and none is what is read; empty ones are none.
// Errors: kInvalidArgument, checkWritable()'s.
Result<Ok> checkOutputs(const std::string& input, std::initializer_list<std::string> outputs);

// Puts what `text`, "colour=0.5", says into `weights`. Errors: kInvalidArgument.
Result<Ok> setWeight(const std::string& text, render::Weights& weights);

// A mesh as a model of one level.
render::Dendrogram asModel(const render::Mesh& mesh);

// That another resolution than the finest is asked of what has no other.
Error hasOneResolution(const std::string& path);

// Of the finest resolution: what percentages of the diagonal are of.
render::Box boxOf(const render::Dendrogram& model);

// Which resolution: at most one is set.
struct LevelChoice {
  std::optional<double> percent, error_percent, error_units;
  std::optional<std::size_t> triangles;

  Command addTo(Command command);
  // 0 where none is set. `path`: the model's; where it does not go down so far stderr says so.
  // Errors: kInvalidArgument: it is one resolution, and finer than that.
  Result<std::size_t> levelOf(const render::Dendrogram& model, const std::string& path) const;

 private:
  std::size_t coarsestAllowed(const render::Dendrogram& model) const;
};

}  // namespace merlin::cli
