// OBJ: positions, colours behind them, faces, and the texture coordinates and materials of corners.
// Read by hand; README.md says why. Format: Wavefront, "Advanced Visualizer", appendix B1.
// Private to render/mesh/io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

inline constexpr std::uint32_t kNoTexcoord = 0xFFFFFFFF;

struct ObjSurface {
  Mesh mesh;                     // as the file has it; "colour" where every vertex has one
  std::vector<float> texcoords;  // of the file's vt lines, x 2
  // Empty where no corner has a texture coordinate and no face a material.
  std::vector<std::uint32_t> corner_texcoord;    // triangles x 3, or kNoTexcoord
  std::vector<std::uint32_t> triangle_material;  // of `materials`
  std::vector<std::string> materials;            // by name; the first is "", none
  std::vector<std::string> libraries;            // material files, as they are named
};

// `content` is a whole file. Faces of more than three corners become fans. The mesh is neither
// validated nor tidied. Errors: kMalformed, with the line, without the file's name.
Result<ObjSurface> parseObj(std::string_view content);

}  // namespace merlin::render
