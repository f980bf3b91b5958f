// The unit that an AMF file gives its coordinates, which assimp does not hand on.
#pragma once

#include <string>
#include <string_view>

namespace merlin::render::import {

// xml        the file's text, of which the beginning is enough
// element    name of its outermost element, which has the unit
// returns    the value of its attribute `unit`, fit for a message; empty if it has none.
std::string unitOf(std::string_view xml, std::string_view element);

}  // namespace merlin::render::import
