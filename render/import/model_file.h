// Reads files of models, by assimp or Coin, as one mesh. Only the program merlin-import links this,
// behind its sandbox.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/result.h"
#include "render/import/model_builder.h"

namespace merlin::render::import {

struct ModelFile {
  std::string path;
  std::string format;  // ending of the format's usual name, such as "dae", whatever the file's is
  std::string folder;  // in which files may be written meanwhile
};

// Called with the part of the work that is done, 0..1, and the triangles so far.
using OnTriangles = std::function<void(double share, std::int64_t triangles)>;

// Loads what the libraries need, and fixes Coin's clock, so that the same file gives the same mesh.
// To be called once, before the sandbox closes. Errors: none today.
Result<Ok> prepareModels(const char* program);

// Reads a whole scene in its rest pose: transforms applied, polygons triangulated, a part for each
// surface. Files that it names are read if they lie beside it. Errors, with the file's name:
// kMalformed (damaged, cut, cyclic), kUnsupported (no surface in it, or a feature of the format
// that the library lacks), kInvalidArgument (more memory is needed than is allowed).
Result<BuiltModel> readModel(const ModelFile& file, const OnTriangles& on_triangles);

// kInvalidArgument: reading a file, or what is made of it, takes more memory than this process may
// have. For a caller that catches std::bad_alloc.
Error needsMoreMemory(const std::string& path);

// The two readers; errors without the file's name.
Result<BuiltModel> readByAssimp(const ModelFile& file, const OnTriangles& on_triangles);
Result<BuiltModel> readByCoin(const ModelFile& file, const OnTriangles& on_triangles);

}  // namespace merlin::render::import
