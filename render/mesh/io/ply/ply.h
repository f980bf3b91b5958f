// PLY parser, written by hand: it keeps any scalar vertex property, never splits or drops data
// silently, and reports where a file is damaged. README.md explains why no library is used. Format:
// G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render::mesh::ply {

// Texture images of a file's faces, in the form that MeshLab writes.
struct FaceTextures {
  std::vector<std::string> pictures;  // file names in the comments "TextureFile"
  // Texture coordinates (property "texcoord") of each triangle's corners; empty if the faces have
  // none. The corners of a face whose list has the wrong length are NaN.
  std::vector<std::array<float, 2>> corners;
  // Image number (property "texnumber") of each triangle: an index into `pictures`; any other
  // number means no image. Empty if the faces have none.
  std::vector<std::int64_t> numbers;
};

// Parses a PLY file; `bytes` is the whole file. Faces with more than three corners become triangles
// (polygon.h). The mesh is neither validated nor tidied; coordinates that are doubles are relative
// to its origin. `textures` receives the faces' texture images; null: these are ignored. Errors:
// kMalformed, without the file's name.
Result<LoadedMesh> parse(std::string_view bytes, FaceTextures* textures = nullptr);

}  // namespace merlin::render::mesh::ply
