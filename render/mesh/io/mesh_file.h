// Mesh files: reading and writing, by the name's ending.
//
//   .ply   ascii and binary of both byte orders; every scalar vertex property becomes a feature
//   .obj   positions and faces (through OpenMesh)
//
// A mesh that is returned has passed validate() and tidy(). Nothing throws, nothing is printed.
// Reentrant.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct LoadedMesh {
  Mesh mesh;
  TidyReport tidied;
  std::size_t skipped_properties = 0;  // of the file, that MERLIN has no place for
};

// Errors, each with the file's name and where in it: kNotFound, kIo, kMalformed (cut short, broken,
// no triangles), kUnsupported (an ending or a variant that is not read).
Result<LoadedMesh> readMesh(const std::string& path);

// Writes binary little-endian PLY: x y z, normal as nx ny nz, colour as red green blue (bytes), any
// other feature as float properties. The file appears whole or not at all.
// Errors: kIo, kUnsupported (another ending than .ply).
Result<Ok> writeMesh(const std::string& path, const Mesh& mesh);

}  // namespace merlin::render
