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
void addMeshFuse(Command mesh, Run& run);
void addMeshImport(Command mesh, Run& run);
void addMeshInfo(Command mesh, Run& run);
void addMeshPicture(Command mesh, Run& run);
void addMeshReduce(Command mesh, Run& run);
void addMeshScan(Command mesh, Run& run);
void addMeshSegment(Command mesh, Run& run);

// Opens a multiresolution model (.mrm), or reads a mesh and makes a dendrogram of one level from
// it. `origin`, if not null, is set to the origin of the coordinates. Errors: those of the readers.
Result<render::lod::Dendrogram> openModel(const std::string& path,
                                          render::mesh::Origin* origin = nullptr);

// Reads a mesh and adds normals if it has none; prints the reader's notes to stderr. Errors: those
// of readMesh().
Result<render::mesh::LoadedMesh> loadMesh(const std::string& path);

// One kind of repair made while reading a mesh: its key in JSON output, its description for people,
// and how often it was made (may be 0).
struct Repair {
  const char* key;
  const char* name;
  std::size_t count;
};
// Returns all kinds of repairs, with how often each was made.
std::vector<Repair> repairsOf(const render::mesh::LoadedMesh& loaded);

// Returns the repairs with a count above 0 as one line, "repaired: 3 duplicate triangles dropped,
// ..."; empty if there were none.
std::string mendedText(const render::mesh::LoadedMesh& loaded);

// Prints, for a person, the companion files of a mesh that was written (materials, texture), and
// the features that were left out because the file format cannot store them.
void printWritten(const render::mesh::WrittenMesh& written);

// Returns whether the origin was added to the coordinates in the written file. `local`: whether the
// option --local was given, which leaves the origin out.
bool hasOrigin(const render::mesh::Origin& origin, bool local,
               const render::mesh::WrittenMesh& written);

// Prints, for a person, whether the origin was added to the coordinates in the file; prints nothing
// if it is 0 0 0.
void printOrigin(const render::mesh::Origin& origin, bool local,
                 const render::mesh::WrittenMesh& written);

// Adds the option --local of commands that write a mesh.
void addLocal(Command command, bool& local);

// Returns the error for --local with an output that is not a mesh.
Error localIsForMeshes(const std::string& output);

// Checks that the output files can be written and that none of them is the input file; empty names
// are ignored. To be called before any long work. Errors: kInvalidArgument, those of
// checkWritable().
Result<Ok> checkOutputs(const std::string& input, std::initializer_list<std::string> outputs);

// Checks that the input file exists. Errors: kNotFound.
Result<Ok> checkIsThere(const std::string& path);

// Parses `text`, such as "colour=0.5", and sets the weight of that feature. Errors:
// kInvalidArgument.
Result<Ok> setWeight(const std::string& text, render::reduce::Weights& weights);

// Returns the error for a model with only one level if another resolution was requested.
Error hasOneResolution(const std::string& path);

// The resolution that the command line selects; at most one member is set.
struct LevelChoice {
  std::optional<double> percent, error_percent, error_units;
  std::optional<std::size_t> triangles;

  // Adds the options that select a resolution; returns their group.
  Command addTo(Command command);
  // Returns the selected level of the model; without a selection 0, the finest. `path`: the model's
  // file, for messages. Prints a note if even the coarsest level has more triangles than requested.
  // Errors: kInvalidArgument if the model has only one level and a coarser one is requested.
  Result<std::size_t> levelOf(const render::lod::Dendrogram& model, const std::string& path) const;

 private:
  std::size_t coarsestAllowed(const render::lod::Dendrogram& model) const;
};

}  // namespace merlin::cli
