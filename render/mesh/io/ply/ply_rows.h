// Finds overlong rows of ASCII PLY files. Private to render/mesh/io.
#pragma once

#include <string>
#include <string_view>

#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::mesh::ply {

// Returns a message about the first line of an ASCII body that has more numbers than the header
// declares for its row. Returns an empty text if there is no such line, or if lines and rows do not
// correspond. The parser reads the body as one sequence of numbers, so it misreads everything after
// such a line.
std::string longRow(std::string_view body, const Header& header);

}  // namespace merlin::render::mesh::ply
