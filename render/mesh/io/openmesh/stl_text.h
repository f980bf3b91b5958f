// Checks ASCII STL files, since OpenMesh's reader silently skips malformed text. Private to
// render/mesh/io.
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

// Returns whether `content`, the beginning of a file, is ASCII STL. Ignores the case of letters.
bool isStlText(std::string_view content);

// Checks a whole file and returns its number of facets. Each facet must be one loop of three
// vertices, each vertex three finite numbers, and the file must end with endsolid. Lines that begin
// with other words are skipped.
// Errors: kMalformed, with the line but without the file's name.
Result<std::size_t> checkStlText(std::string_view content);

}  // namespace merlin::render::mesh
