// Which part of which picture a mesh's triangles use: the rectangles of an atlas before they are
// packed. Private to render/mesh/atlas.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/mesh/atlas/join_textures.h"

namespace merlin::render::mesh {

// A part of a picture and of its repeats, in the picture's texels: x to the right from its left
// edge, y downwards from its upper one. Pixels beyond the picture are those of its wrapping.
struct Chart {
  SurfaceTexture texture;
  std::int64_t x = 0, y = 0;
  int width = 0, height = 0;
};

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// What a triangle has in the atlas.
struct TrianglePlace {
  std::uint32_t chart = kNoTexture;  // index of a chart; kNoTexture: a colour
  std::uint32_t colour = 0;          // index of a colour
  // Subtracted from the texture coordinates: whole periods of the picture.
  std::array<std::int32_t, 2> shift{};
  bool operator==(const TrianglePlace&) const = default;
};

struct Charts {
  std::vector<Chart> charts;
  std::vector<Colour> colours;
  std::vector<TrianglePlace> places;  // of each triangle
  std::size_t mean_coloured = 0, rounded_colours = 0;
};

// The mean of all pixels.
Colour meanOf(const image::ImageFile& picture) noexcept;

// Texture coordinates as texels of the picture.
std::array<double, 2> texelsOf(const image::ImageFile& picture, double u, double v) noexcept;

// Triangles that are connected by vertices are moved by whole periods to [0, 1) together, so that
// no seam arises between them; where they span more than kTogether periods, each is moved for
// itself. REQUIRES: as joinTextures().
Charts findCharts(const Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits);

}  // namespace merlin::render::mesh
