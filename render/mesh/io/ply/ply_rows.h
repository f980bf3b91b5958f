// Rows of ASCII PLY files. Private to render/mesh/io.
#pragma once

#include <string>
#include <string_view>

#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::mesh::ply {

// The first line of a body in ASCII with more numbers than the header promises for its row, as a
// message; empty if there is none, or the lines are not rows. Such a file is read wrongly from
// there on, since what is read is a sequence of numbers.
std::string longRow(std::string_view body, const Header& header);

}  // namespace merlin::render::mesh::ply
