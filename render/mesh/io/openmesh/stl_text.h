// Checks ASCII STL, of which OpenMesh's reader passes over what it does not understand. Private to
// render/mesh/io.
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

// Whether a file that begins like this is ASCII STL. The case of letters does not matter.
bool isStlText(std::string_view content);

// The number of facets of a whole file. Each must be one loop of three vertices, each of these
// three finite numbers, and the file must end with endsolid. Lines of other words are passed over.
// Errors: kMalformed, with the line but without the file's name.
Result<std::size_t> checkStlText(std::string_view content);

}  // namespace merlin::render::mesh
