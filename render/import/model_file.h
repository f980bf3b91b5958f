// Reads model files, through assimp or Coin, as one mesh. Linked only into the program
// merlin-import, which runs it in its sandbox.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/import/model_builder.h"

namespace merlin::render::import {

struct ModelFile {
  std::string path;
  std::string format;  // usual ending of the format, such as "dae", whatever the file's own is
  std::string folder;  // for temporary files
  // Absolute paths of the files beside it that may be read, since the sandbox lists no folder.
  std::vector<std::string> beside{};
};

// Called with the share of the work that is done, 0..1, and the number of triangles so far.
using OnTriangles = std::function<void(double share, std::int64_t triangles)>;

// Loads the modules and data that the libraries need, and stops Coin's clock, so that the same file
// gives the same mesh. To be called once, before the sandbox closes. Errors: none at present.
Result<Ok> prepareModels(const char* program);

// Reads a whole scene in its rest pose: transforms applied, polygons triangulated, one part per
// surface. Files that it names are read if they are in its folder or below. Errors, with the file's
// name: kMalformed (damaged, truncated, cyclic), kUnsupported (no surface in it, or a feature of
// the format that the library lacks), kInvalidArgument (more memory is needed than is allowed).
Result<BuiltModel> readModel(const ModelFile& file, const OnTriangles& on_triangles);

// Returns the error kInvalidArgument: reading or converting the file takes more memory than this
// process may have. For a caller that catches std::bad_alloc.
Error needsMoreMemory(const std::string& path);

// The two readers, used by readModel(). Their errors are without the file's name.
Result<BuiltModel> readByAssimp(const ModelFile& file, const OnTriangles& on_triangles);
Result<BuiltModel> readByCoin(const ModelFile& file, const OnTriangles& on_triangles);

}  // namespace merlin::render::import
