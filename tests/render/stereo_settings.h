// Shared by the tests of stereo: settings of eyes, tiles and outputs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "render/stereo/eye_tiles.h"

namespace merlin::render::stereo {

inline constexpr double kWallDistance_m = 2;

inline stereo::StereoSettings inMode(stereo::StereoMode mode,
                                     stereo::EyeSize size = stereo::EyeSize::kHalf) {
  stereo::StereoSettings s;
  s.mode = mode;
  s.size = size;
  s.eye_separation_m = 0.06;
  return s;
}

// Returns settings with one tile of 640 x 480 pixels beside the operator's tile.
inline tiles::TilesSettings oneTile() {
  tiles::TilesSettings tiles;
  tiles.frame_height = 480;
  tiles.tiles = {{"wall", tiles::TileKind::kWall, 0, 0, 0},
                 {"operator", tiles::TileKind::kOperator, 640, 0, 0}};
  return tiles;
}

inline out::OutputSettings picture(const std::string& name, std::vector<out::PlacedTile> tiles) {
  out::OutputSettings png{out::OutputKind::kPng, name, fmt::format("{}.png", name)};
  png.tiles = std::move(tiles);
  return png;
}

}  // namespace merlin::render::stereo
