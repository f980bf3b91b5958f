// Finds the parts of the texture images that a mesh's triangles use; these charts are the
// rectangles of an atlas before packing. Private to render/mesh/atlas.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/mesh/atlas/join_textures.h"

namespace merlin::render::mesh {

// A rectangle of a texture image, which may include repeats of the image. Unit: texels of the
// image, x to the right from the image's left edge, y downwards from its upper edge. Texels outside
// the image follow from the image's wrap mode.
struct Chart {
  SurfaceTexture texture;
  std::int64_t x = 0, y = 0;
  int width = 0, height = 0;
};

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The place of a triangle in the atlas: a chart or a plain colour.
struct TrianglePlace {
  std::uint32_t chart = kNoTexture;  // index into Charts::charts; kNoTexture: plain colour
  std::uint32_t colour = 0;          // index into Charts::colours, if there is no chart
  // u and v offsets, in whole periods of the image, to subtract from the texture coordinates.
  std::array<std::int32_t, 2> shift{};
  bool operator==(const TrianglePlace&) const = default;
};

struct Charts {
  std::vector<Chart> charts;
  std::vector<Colour> colours;
  std::vector<TrianglePlace> places;  // one per triangle
  std::size_t mean_coloured = 0, rounded_colours = 0;
};

// Returns the mean colour of all pixels. REQUIRES: the picture is not empty.
Colour meanOf(const image::ImageFile& picture) noexcept;

// Converts texture coordinates (v upwards) to texels of the image (y downwards from its upper
// edge).
std::array<double, 2> texelsOf(const image::ImageFile& picture, double u, double v) noexcept;

// Finds the charts and colours of all triangles. The texture coordinates of triangles that share
// vertices are shifted together, by whole periods, so that their minimum is in the first period;
// this avoids seams between them. If together they extend over more than kTogether (charts.cpp)
// periods, each triangle is shifted individually. REQUIRES: as joinTextures().
Charts findCharts(const Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits);

}  // namespace merlin::render::mesh
