// The subcommands of `merlin mesh`, and helpers to open meshes and models.
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

// Opens an .mrm file, or a mesh as a dendrogram of one level. Errors: those of the readers.
Result<render::Dendrogram> openModel(const std::string& path);

// Reads a mesh and adds normals if it has none; prints the reader's notes to stderr. Errors: those
// of readMesh().
Result<render::LoadedMesh> loadMesh(const std::string& path);

// One kind of repair made while reading a mesh: key for programs, name for people; the count may
// be 0.
struct Repair {
  const char* key;
  const char* name;
  std::size_t count;
};
std::vector<Repair> repairsOf(const render::LoadedMesh& loaded);

// The repairs with a count above 0 as one line, "repaired: 3 duplicate triangles dropped, ...";
// empty if there were none.
std::string mendedText(const render::LoadedMesh& loaded);

// Prints, for a person, the companion files of a mesh that was written, and the features that its
// format cannot hold.
void printWritten(const render::WrittenMesh& written);

// To be called before any work: checks that the outputs can be written and that none of them is the
// input; empty names are ignored. Errors: kInvalidArgument, those of checkWritable().
Result<Ok> checkOutputs(const std::string& input, std::initializer_list<std::string> outputs);

// Parses `text`, such as "colour=0.5", and sets that weight. Errors: kInvalidArgument.
Result<Ok> setWeight(const std::string& text, render::Weights& weights);

// Makes a model of one level from a mesh.
render::Dendrogram asModel(const render::Mesh& mesh);

// The error for a model of one level of which another resolution was requested.
Error hasOneResolution(const std::string& path);

// Bounding box of the finest resolution; errors in percent refer to its diagonal.
render::Box boxOf(const render::Dendrogram& model);

// The resolution that the command line selects; at most one member is set.
struct LevelChoice {
  std::optional<double> percent, error_percent, error_units;
  std::optional<std::size_t> triangles;

  Command addTo(Command command);
  // The selected level; 0, the finest, if none is set. `path`: the model's file, for messages.
  // Prints a note if the coarsest level has more triangles than requested. Errors: kInvalidArgument
  // if the model has one level only and a coarser one is requested.
  Result<std::size_t> levelOf(const render::Dendrogram& model, const std::string& path) const;

 private:
  std::size_t coarsestAllowed(const render::Dendrogram& model) const;
};

}  // namespace merlin::cli
