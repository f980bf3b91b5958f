// Reads the unit of the coordinates of an AMF or 3MF file, which assimp does not pass on.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace merlin::render::import {

// xml        the file's text; its beginning is enough
// element    name of the outermost element, which has the unit
// returns    the value of the element's attribute `unit`, fit for a message; empty if it has none
std::string unitOf(std::string_view xml, std::string_view element);

// Returns the beginning, at most `most` bytes, of the model's text in a 3MF archive; empty if the
// archive has no model.
std::string beginningOf3mf(const std::string& path, std::size_t most);

// Metres per unit of AMF and 3MF ("millimeter", "inch", ...); 0 for any other unit.
double metresPer(std::string_view unit);

}  // namespace merlin::render::import
