// PLY parser, written by hand: it keeps any scalar vertex property, never splits or drops data
// silently, and reports where a file is damaged. README.md says why no library is used. Format: G.
// Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"

namespace merlin::render::mesh::ply {

// What a file's faces say about its texture images, in the form that MeshLab writes.
struct FaceTextures {
  std::vector<std::string> pictures;  // file names in the comments "TextureFile"
  // Texture coordinates ("texcoord") of each triangle's corners; empty if the faces have none. NaN
  // for the corners of a face whose list has the wrong length.
  std::vector<std::array<float, 2>> corners;
  // Image number ("texnumber") of each triangle: an index into `pictures`; any other number means
  // no image. Empty if the faces have none.
  std::vector<std::int64_t> numbers;
};

// `bytes` is a whole file. Faces with more than three corners become triangles (polygon.h). The
// mesh is neither validated nor tidied; coordinates that are doubles are relative to its origin.
// Errors: kMalformed, kUnsupported, without the file's name.
// textures  receives what the file says about texture images; null: this is ignored
Result<LoadedMesh> parse(std::string_view bytes, FaceTextures* textures = nullptr);

}  // namespace merlin::render::mesh::ply
