#include "render/room/room_tiles.h"

#include <utility>

#include "render/room/canvas.h"
#include "render/room/geometry.h"
#include "render/room/presets.h"

namespace merlin::render::room {
namespace {

std::array<double, 9> cornersFrom(const Eigen::Vector3d& eye_m, const Screen& screen) {
  const Eigen::Vector3d lower_left = screen.corner - eye_m;
  std::array<double, 9> corners{};
  Eigen::Map<Eigen::Matrix3d> columns(corners.data());
  columns.col(0) = lower_left;
  columns.col(1) = lower_left + screen.across;
  columns.col(2) = lower_left + screen.up;
  return corners;
}

}  // namespace

Result<tiles::TilesSettings> roomTiles(const RoomSettings& settings,
                                       const tiles::TilesSettings& tiles) {
  if (const SettingFaults faults = validate(settings, tiles); !faults.empty())
    return Error{Errc::kInvalidArgument, faults.front().what};
  const RoomSettings room = withPanels(settings);
  const std::vector<Screen> panels = panelScreens(room);
  tiles::TilesSettings wall = tiles;
  wall.tiles.clear();
  for (const DisplaySettings& d : room.displays) {
    tiles::TileSettings tile{d.name};
    tile.width = d.width > 0 ? d.width : tiles.tile_width;
    tile.height = d.height > 0 ? d.height : tiles.tile_height;
    tile.view = d.view;
    tile.camera = d.camera;
    if (tile.followsWall())
      tile.screen_m =
          cornersFrom(pointOf(room.eye_m), pictureScreen(d, panels[panelOf(d, room.panels)]));
    wall.tiles.push_back(std::move(tile));
  }
  if (room.hasOperator()) {
    tiles::TileSettings tile{kOperatorTile, tiles::TileKind::kOperator};
    tile.width = room.operator_width;
    tile.height = room.operator_height;
    wall.tiles.push_back(std::move(tile));
  }
  const CanvasSize size = placeOnCanvas(wall.tiles);
  wall.frame_width = size.width;
  wall.frame_height = size.height;
  return wall;
}

}  // namespace merlin::render::room
