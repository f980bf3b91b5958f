// Replaces the texture images of a mesh by a single image, an atlas into which all of them are
// packed. Every model reader calls joinTextures() after it has read the triangles. Pure.
//
// Each image becomes a rectangle of the atlas; the rectangle covers the used part of the image and
// of its repeats. A margin of kGutter texels around the rectangle continues the image, and the
// rectangle begins at a multiple of kGutter texels; so neither bilinear filtering nor mipmaps down
// to 1 / kGutter of the size mix different images. Triangles without an image get a rectangle of
// one colour.
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
  const image::ImageFile* picture = nullptr;  // must not be null or empty; must outlive this
  image::Wrap wrap_u = image::Wrap::kRepeat, wrap_v = image::Wrap::kRepeat;
  bool operator==(const SurfaceTexture&) const = default;
};

inline constexpr std::uint32_t kNoTexture = std::numeric_limits<std::uint32_t>::max();

// The textures of a mesh, and for each triangle the index of its texture (kNoTexture: no texture).
struct SurfaceTextures {
  std::vector<SurfaceTexture> textures;
  std::vector<std::uint32_t> of_triangle;
};

struct AtlasLimits {
  // Maximum width and height of an atlas [texels]. 8192 x 8192 is a quarter of the pixels that
  // image::decodeImage() accepts, and graphics cards accept this size; gl::Texture would halve a
  // larger one.
  int most_side = 8192;
  // Maximum width and height of one image with its repeats [texels]; an image that exceeds the
  // limit even without repeats keeps its size.
  int most_chart_side = 4096;
  // Maximum number of times that a triangle may repeat its image along an axis. A triangle that
  // repeats it more often gets the image's mean colour, which is what so many repeats look like
  // from a distance.
  int most_repeats = 16;
};

inline constexpr int kGutter = 8;  // [texels], a power of two

struct JoinedTextures {
  // Numbers of charts and colours in the atlas; both 0: no atlas was made.
  std::size_t pictures = 0, colours = 0;
  int width = 0, height = 0;  // size of the atlas [texels]
  // Factor by which all images were scaled to fit; 1: original resolution.
  double scale = 1;
  std::size_t reduced = 0;  // number of images scaled further, as they are repeated often
  // Triangles with a mean colour, as they repeat their image too often.
  std::size_t mean_coloured = 0;
  std::size_t rounded_colours = 0;  // triangles without image whose colour was rounded
  std::size_t unused = 0;           // images that no triangle uses; they are left out
  std::size_t split = 0;            // number of vertices added at new seams
  bool baked = false;               // true: an atlas is impossible, and the images are not kept

  // Returns notes for the user about the fields above, one sentence each.
  std::vector<std::string> notes() const;
};

// Sets mesh.texture and the feature "texcoord" (2), and returns a report. If all triangles use the
// same repeating image and its file is known, that file is kept; otherwise an atlas is made, as
// PNG. A vertex whose triangles get different coordinates is split; the new vertices are appended
// in the order of the triangles. Triangles without an image get the mean "colour" (3) of their
// corners, or white. A triangle with a texture coordinate that is not finite or beyond +-1e6 counts
// as a triangle without an image. The same input gives the same bytes. O(triangles + texels).
// Memory: twice that of the atlas's pixels. REQUIRES: validate(mesh), except for "texcoord", which
// must exist if a triangle has a texture; textures.of_triangle has one entry per triangle.
JoinedTextures joinTextures(Mesh& mesh, const SurfaceTextures& textures,
                            const AtlasLimits& limits = {});

}  // namespace merlin::render::mesh
