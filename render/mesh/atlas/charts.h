// Finds the parts of the texture images that a mesh's triangles use: the rectangles of an atlas
// before they are packed. Private to render/mesh/atlas.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/mesh/atlas/join_textures.h"

namespace merlin::render::mesh {

// A rectangle of a texture image and its repeats, in texels of the image: x to the right from its
// left edge, y downwards from its upper edge. Texels outside the image follow from its wrap mode.
struct Chart {
  SurfaceTexture texture;
  std::int64_t x = 0, y = 0;
  int width = 0, height = 0;
};

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// The chart or the plain colour that a triangle has in the atlas.
struct TrianglePlace {
  std::uint32_t chart = kNoTexture;  // index of a chart; kNoTexture: plain colour
  std::uint32_t colour = 0;          // index of a colour, if there is no chart
  // Whole periods of the image, to be subtracted from the texture coordinates.
  std::array<std::int32_t, 2> shift{};
  bool operator==(const TrianglePlace&) const = default;
};

struct Charts {
  std::vector<Chart> charts;
  std::vector<Colour> colours;
  std::vector<TrianglePlace> places;  // one per triangle
  std::size_t mean_coloured = 0, rounded_colours = 0;
};

// The mean of all pixels.
Colour meanOf(const image::ImageFile& picture) noexcept;

// Converts texture coordinates to texels of the image.
std::array<double, 2> texelsOf(const image::ImageFile& picture, double u, double v) noexcept;

// Finds the charts and colours of all triangles. The texture coordinates of triangles that share
// vertices are shifted together, by whole periods, such that their minimum is in the first period;
// so no seam arises between them. If together they extend more than kTogether (charts.cpp) periods,
// each triangle is shifted on its own. REQUIRES: as joinTextures().
Charts findCharts(const Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits);

}  // namespace merlin::render::mesh
