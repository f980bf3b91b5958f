// OBJ parser: positions with optional colours, faces, and the texture coordinates and materials of
// face corners. It is written by hand; README.md explains why. Format: Wavefront, "Advanced
// Visualizer", appendix B1. Private to render/mesh/io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/mesh/origin.h"

namespace merlin::render::mesh {

inline constexpr std::uint32_t kNoTexcoord = 0xFFFFFFFF;

struct ObjSurface {
  Mesh mesh;        // vertices and triangles of the file; "colour" if every vertex has one
  Origin origin{};  // offset that was subtracted from the file's coordinates
  std::vector<float> texcoords;  // u and v of each vt line
  // The next two are empty if no corner has a texture coordinate and no face has a material.
  std::vector<std::uint32_t> corner_texcoord;  // triangles x 3: index of a vt line, or kNoTexcoord
  std::vector<std::uint32_t> triangle_material;  // triangles: index into `materials`
  // Names of the materials; the first, "", means no material.
  std::vector<std::string> materials;
  std::vector<std::string> libraries;  // names of material files (mtllib)
  // For each triangle, the number of its part, i.e. of its object and group (o, g). Parts are
  // numbered from 0 in the order of their first triangles. Empty if there is only one part.
  std::vector<std::uint32_t> triangle_part;
  std::size_t parts = 0;
  std::vector<std::string> notes;  // notes for the user: data in the file that were left out
};

// Parses a whole OBJ file. Faces with more than three corners become triangles (polygon.h). The
// mesh is neither validated nor tidied. Errors: kMalformed, with the line but without the file's
// name.
Result<ObjSurface> parseObj(std::string_view content);

}  // namespace merlin::render::mesh
