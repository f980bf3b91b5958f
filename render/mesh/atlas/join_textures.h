// Replaces the several texture images of a mesh by one: an atlas, into which all are packed. Every
// model reader calls it after it has read the triangles. Pure.
//
// Each image becomes a rectangle of the atlas that covers the part of the image, and the repeats,
// that are used. A margin of kGutter texels continues the image around the rectangle, which begins
// at a multiple of kGutter texels; so neither bilinear filtering nor mipmaps down to 1 / kGutter
// of the size mix different images. Triangles without an image get a rectangle of one colour.
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

// A texture image with the wrap modes that a material gives it.
struct SurfaceTexture {
  const image::ImageFile* picture = nullptr;  // not empty; must outlive this
  image::Wrap wrap_u = image::Wrap::kRepeat, wrap_v = image::Wrap::kRepeat;
  bool operator==(const SurfaceTexture&) const = default;
};

inline constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max();

// The textures of a mesh, and for each triangle the index of its texture (kNoTexture: none).
struct SurfaceTextures {
  std::vector<SurfaceTexture> textures;
  std::vector<std::uint32_t> of_triangle;
};

struct AtlasLimits {
  // Maximum width and height of an atlas [texels]. 8192 squared is a quarter of the pixels that
  // image::decodeImage() accepts, and graphics cards accept this size; gl::Texture would halve a
  // wider one.
  int most_side = 8192;
  // Maximum width and height of one image with its repeats [texels]; an image that is larger
  // without repeats keeps its size.
  int most_chart_side = 4096;
  // How often a triangle may repeat its image along an axis. A triangle that repeats it more often
  // gets the image's mean colour, which is what so many repeats look like from a distance.
  int most_repeats = 16;
};

inline constexpr int kGutter = 8;  // [texels], a power of two

struct JoinedTextures {
  std::size_t pictures = 0, colours = 0;  // in the atlas; both 0: no atlas was needed
  int width = 0, height = 0;              // of the atlas [texels]
  double scale = 1;                 // of all images, so that they fit; 1: their own resolution
  std::size_t reduced = 0;          // images with a smaller scale, because they are repeated often
  std::size_t mean_coloured = 0;    // triangles that repeat their image too often
  std::size_t rounded_colours = 0;  // triangles without image whose colour was rounded
  std::size_t unused = 0;           // images that are on no triangle and are left out
  std::size_t split = 0;            // vertices that were added, at new seams
  bool baked = false;               // no atlas is possible: the images are not kept

  // Notes for the user about the above, one sentence each.
  std::vector<std::string> notes() const;
};

// Sets mesh.texture and "texcoord" (2). A single image that repeats and is used by all
// triangles is kept as its file; otherwise an atlas is made, as PNG. A vertex whose triangles get
// different coordinates is split; the new vertices are appended in the order of the triangles.
// Triangles without an image get the mean "colour" (3) of their corners, or white. A triangle with
// a texture coordinate that is not finite, or beyond +-1e6, counts as one without an image. The
// same input gives the same bytes. O(triangles + texels). REQUIRES: validate(mesh) but for
// "texcoord", which must be there if a triangle has a texture; textures.of_triangle has an entry
// for each triangle. Memory: twice that of the atlas's pixels.
JoinedTextures joinTextures(Mesh& mesh, const SurfaceTextures& textures,
                            const AtlasLimits& limits = {});

}  // namespace merlin::render::mesh
