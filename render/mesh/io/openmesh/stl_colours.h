// Colours of the triangles of a binary STL file: OpenMesh's reader passes over the two bytes that
// hold them. Private to render/mesh/io.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace merlin::render::mesh {

// The header with the number of triangles, and a triangle with its two bytes [bytes].
inline constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

struct StlColours {
  std::vector<float> of_triangles;  // triangles x 3, each 0..1; empty: the file has none
  std::size_t unread = 0;           // triangles whose two bytes are neither 0 nor a colour
};

// STL has no standard for colours; two ways are in use, each with five bits a channel. Materialise
// Magics writes "COLOR=" and the object's red, green, blue and opacity, a byte each, into the
// header; a triangle has a colour of its own, red in the lowest bits, if its highest bit is 0.
// Where all bytes of all triangles are 0, all have the object's colour: programs that write the
// header alone leave them so. VisCAM and SolidView write nothing into the header; a triangle has a
// colour, blue in the lowest bits, if its highest bit is 1, and is white here if it has none beside
// others that have. Sources: M. Joppe (VisCAM) on the rapid prototyping mailing list, 5 March 2001,
// and https://en.wikipedia.org/wiki/STL_(file_format).
//   content  a whole binary STL file
StlColours stlColours(std::string_view content);

}  // namespace merlin::render::mesh
