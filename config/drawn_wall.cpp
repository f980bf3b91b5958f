#include "config/drawn_wall.h"

#include <utility>

#include "render/stereo/eye_tiles.h"

namespace merlin {

WallSettings drawnWall(const WallSettings& wall) {
  auto eyes =
      render::stereo::eyeTiles(wall.stereo, wall.tiles, wall.outputs, wall.scene.wall_distance_m);
  WallSettings drawn = wall;
  drawn.tiles = std::move(eyes.tiles);
  drawn.outputs = std::move(eyes.outputs);
  return drawn;
}

}  // namespace merlin
