// Finds overlong rows of ASCII PLY files. Private to render/mesh/io.
#pragma once

#include <string>
#include <string_view>

#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::mesh::ply {

// Returns a message about the first line of an ASCII body that has more numbers than the header
// declares for its row; empty if there is no such line, or if lines and rows do not correspond.
// From such a line on the file is read wrongly, since the body is read as one sequence of numbers.
std::string longRow(std::string_view body, const Header& header);

}  // namespace merlin::render::mesh::ply
