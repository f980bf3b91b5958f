// The unit that an AMF or 3MF file gives its coordinates, which assimp does not hand on.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace merlin::render::import {

// xml        the file's text, of which the beginning is enough
// element    name of its outermost element, which has the unit
// returns    the value of its attribute `unit`, fit for a message; empty if it has none.
std::string unitOf(std::string_view xml, std::string_view element);

// The beginning, of at most `most` bytes, of the text of a 3MF archive's model; empty if there is
// none.
std::string beginningOf3mf(const std::string& path, std::size_t most);

// Metres per unit of AMF and 3MF ("millimeter", "inch", ...); 0 for any other.
double metresPer(std::string_view unit);

}  // namespace merlin::render::import
