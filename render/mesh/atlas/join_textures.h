// Gives a mesh one texture where its triangles use several: an atlas, into which all pictures are
// packed. Every reader of models calls it, after it has read the triangles. Pure.
//
// Each picture becomes a rectangle of the atlas, as large as the part of it that is used, with the
// repeats that are used. Around it are kGutter texels of what lies beside it in the picture, and it
// begins at a multiple of kGutter texels, so that neither bilinear filtering nor the mipmaps down
// to 1 / kGutter show another picture. Triangles without a picture get a rectangle of one colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "render/image/image_file.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// A picture as a material uses it.
struct SurfaceTexture {
  const image::ImageFile* picture = nullptr;  // not empty; lives as long as it is used here
  image::Wrap wrap_u = image::Wrap::kRepeat, wrap_v = image::Wrap::kRepeat;
  bool operator==(const SurfaceTexture&) const = default;
};

inline constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max();

// The textures of a mesh, and which of them each triangle has (kNoTexture: none).
struct SurfaceTextures {
  std::vector<SurfaceTexture> textures;
  std::vector<std::uint32_t> of_triangle;
};

struct AtlasLimits {
  // Longest side of an atlas [texels]. 8192: a quarter of the pixels that `image::decodeImage()`
  // takes, and no more than graphics cards take; wider ones would be halved by gl::Texture.
  int most_side = 8192;
  // Of one picture with its repeats [texels]; without repeats a picture is as large as it is.
  int most_chart_side = 4096;
  // How often a triangle may repeat its picture along an axis. One that repeats it more often gets
  // the picture's mean colour, which is what is seen of so many repeats from afar.
  int most_repeats = 16;
};

inline constexpr int kGutter = 8;  // [texels], a power of two

struct JoinedTextures {
  std::size_t pictures = 0, colours = 0;  // in the atlas; both 0: no atlas was needed
  int width = 0, height = 0;              // of the atlas [texels]
  double scale = 1;                 // of all pictures, that they fit: 1 is their own resolution
  std::size_t reduced = 0;          // pictures with a smaller scale, since they are repeated often
  std::size_t mean_coloured = 0;    // triangles that repeat their picture too often
  std::size_t rounded_colours = 0;  // triangles without picture whose colour was rounded
  std::size_t split = 0;            // vertices that were added, at new seams
  bool baked = false;               // no atlas is possible: the pictures are not kept

  // What a person should know of it, a sentence each.
  std::vector<std::string> notes() const;
};

// Sets mesh.texture and "texcoord" (2). One picture that repeats and is on all triangles is kept as
// its file; else an atlas is made, as PNG. Vertices are split where the triangles at them get
// different coordinates; the new ones follow the others, in the order of the triangles. Triangles
// without a picture have the mean "colour" (3) of their corners, or white.
// A triangle counts as one without a picture where a coordinate is not finite, or beyond 1e6.
// The same input gives the same bytes. O(triangles + texels). REQUIRES: validate(mesh) but for
// "texcoord", which must be there if a triangle has a texture; textures.of_triangle has an entry
// for each triangle. Memory: that of the atlas's pixels twice.
JoinedTextures joinTextures(Mesh& mesh, const SurfaceTextures& textures,
                            const AtlasLimits& limits = {});

}  // namespace merlin::render::mesh
