// Writes a model with all its resolutions as an Open Inventor file, which contains an SoMRFaceSet.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render::inventor {

// Writes an Open Inventor 2.1 ASCII file in which frame rate control is enabled. For programs
// without the SoMRFaceSet module, the file also holds a plain surface of at most
// `kAlternateTriangles` triangles (alternateRep), which is small compared with the model. The
// texture image of a model with texture coordinates becomes a companion file, as in
// mesh::writeMesh(). Either all files are written completely, or none. Returns the written files,
// and the data that the file cannot hold. Errors: kIo, kNotFound, kUnsupported (no triangles; more
// nodes or triangle corners than 2^31 - 1), kInvalidArgument (the companion file exists with
// different content).
Result<mesh::WrittenMesh> writeMultiresolution(const std::string& path,
                                               const lod::Dendrogram& model);

inline constexpr std::size_t kAlternateTriangles = 10'000;
inline constexpr double kWrittenFrameRate_hz = 30;

}  // namespace merlin::render::inventor
