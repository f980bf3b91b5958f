// Reads model files, through assimp or Coin, into a single mesh. Linked only into the program
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
  std::string format;  // usual ending of the format, such as "dae"; the file's own may differ
  std::string folder;  // folder for temporary files
  // Absolute paths of the files in the model's folder and below that may be read. They are given
  // here because the sandbox cannot list folders.
  std::vector<std::string> beside{};
};

// Progress callback: receives the share of the work that is done, 0..1, and the number of triangles
// so far.
using OnTriangles = std::function<void(double share, std::int64_t triangles)>;

// Loads the modules and data that the libraries need, and stops Coin's clock, so that the same file
// gives the same mesh. Call once, before the sandbox closes. Always succeeds at present.
Result<Ok> prepareModels(const char* program);

// Reads a whole scene in its rest pose: transforms are applied, polygons are triangulated, and each
// surface becomes a part. Files to which the model refers are read if they are in its folder or
// below. Errors, with the file's name: kMalformed (damaged, truncated, cyclic), kUnsupported (no
// surface in it, or a feature of the format that the library lacks), kInvalidArgument (more memory
// is needed than is allowed).
Result<BuiltModel> readModel(const ModelFile& file, const OnTriangles& on_triangles);

// Returns an error kInvalidArgument which says that reading the file takes more memory than this
// process may use. For callers that catch std::bad_alloc.
Error needsMoreMemory(const std::string& path);

// The two readers that readModel() uses. Their errors do not contain the file's name.
Result<BuiltModel> readByAssimp(const ModelFile& file, const OnTriangles& on_triangles);
Result<BuiltModel> readByCoin(const ModelFile& file, const OnTriangles& on_triangles);

}  // namespace merlin::render::import
