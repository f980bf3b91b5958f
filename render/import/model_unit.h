// Reads the unit of the coordinates of an AMF or 3MF file, since assimp does not provide it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace merlin::render::import {

// Returns the unit that a file's outermost XML element declares.
//
// xml        the file's text; its beginning is enough
// element    name of the outermost element, which has the unit
// returns    the value of the element's attribute `unit`, fit for a message; empty if it has none
std::string unitOf(std::string_view xml, std::string_view element);

// Returns at most the first `most` bytes of the model's XML text in a 3MF archive; empty if the
// archive has no model.
std::string beginningOf3mf(const std::string& path, std::size_t most);

// Returns the length of a unit of AMF and 3MF ("millimeter", "inch", ...) in metres; 0 for an
// unknown unit.
double metresPer(std::string_view unit);

}  // namespace merlin::render::import
