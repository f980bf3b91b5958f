// Reads the colours of the triangles of a binary STL file, since OpenMesh's reader skips the two
// bytes that hold them. Private to render/mesh/io.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace merlin::render::mesh {

// Sizes of the header including the number of triangles, and of one triangle including its two
// colour bytes [bytes].
inline constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

struct StlColours {
  std::vector<float> of_triangles;  // triangles x 3, each 0..1; empty: the file has no colours
  // Number of triangles whose two bytes are neither 0 nor a colour.
  std::size_t unread = 0;
};

// Returns the colours of the triangles of a binary STL file.
//
// STL has no standard for colours; two conventions are in use, each with five bits per channel.
// Materialise Magics writes "COLOR=" and the object's red, green, blue and opacity, one byte each,
// into the header; a triangle has its own colour, red in the lowest bits, if its highest bit is 0.
// If the two bytes of all triangles are 0, all triangles get the object's colour, since programs
// that write only the header leave these bytes 0. VisCAM and SolidView write nothing into the
// header; a triangle has a colour, blue in the lowest bits, if its highest bit is 1; triangles
// without a colour in a file with colours become white. Sources: M. Joppe (VisCAM) on the rapid
// prototyping mailing list, 5 March 2001, and https://en.wikipedia.org/wiki/STL_(file_format).
//   content  a whole binary STL file
StlColours stlColours(std::string_view content);

}  // namespace merlin::render::mesh
