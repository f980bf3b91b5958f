// A model at all its resolutions as an Open Inventor file: an SoMRFaceSet.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

// Open Inventor 2.1 ascii, with the rate on. For programs without the module, the file holds a
// plain surface of at most `kAlternateTriangles` beside (alternateRep), so that it hardly grows by
// it. The file appears whole or not at all. Returns the features, by name, that it has no place
// for. Errors: kIo, kNotFound, kUnsupported (no triangles; more nodes or corners than 2^31 - 1).
Result<std::vector<std::string>> writeMultiresolution(const std::string& path,
                                                      const Dendrogram& model);

inline constexpr std::size_t kAlternateTriangles = 10'000;
inline constexpr double kWrittenFrameRate_hz = 30;

}  // namespace merlin::render
