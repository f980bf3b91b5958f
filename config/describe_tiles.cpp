#include "config/describe_tiles.h"

#include "config/describe_stereo.h"

namespace merlin {
namespace {

constexpr const char* kTileKinds[] = {"wall", "operator"};

// Describes frame size and field of view, which are computed instead if a room is given.
void describeFrame(render::tiles::TilesSettings& t, SettingsVisitor& v) {
  constexpr Range kFrame{16, render::tiles::kLargestFrame_px};
  v.integer("frame_width", t.frame_width, kFrame,
            "Width of the frame, which contains all tiles, in pixels. Not with /wall/room.");
  v.integer("frame_height", t.frame_height, kFrame,
            "Height of the frame, which contains all tiles, in pixels. Not with /wall/room.");
  v.number("field_of_view_deg", t.field_of_view_deg, {1, 179},
           "Horizontal field of view of one tile, in degrees. Not with /wall/room.");
}

}  // namespace

void describeTiles(render::tiles::TilesSettings& t, bool from_room, SettingsVisitor& v) {
  v.integer("tile_width", t.tile_width, {16, 8192},
            "Width in pixels of each tile that does not set its own.");
  v.integer("tile_height", t.tile_height, {16, 8192},
            "Height in pixels of each tile that does not set its own.");
  if (!from_room) describeFrame(t, v);
  v.number("near_m", t.near_m, {0.001, 1000},
           "Distance of the near clipping plane in metres: nothing nearer is drawn.");
  v.number("far_m", t.far_m, {0.01, 1e6},
           "Distance of the far clipping plane in metres: nothing farther is drawn.");
  if (from_room) {
    for (const char* const key : {"frame_width", "frame_height", "field_of_view_deg", "tiles"}) {
      v.excluded(key,
                 "is given together with /wall/room, from which it is computed: leave out one of "
                 "the two");
    }
    return;
  }
  v.listOf<render::tiles::TileSettings>(
      "tiles", t.tiles,
      "Position of each tile in the frame, and what it shows. Not with /wall/room.",
      [&](render::tiles::TileSettings& tile) {
        v.text("name", tile.name, "Name of the tile.");
        v.oneOf("kind", tile.kind, kTileKinds,
                "What the tile shows. wall: its part of the wall's view; operator: the operator's "
                "view of the whole model.");
        v.integer("x", tile.x, {0, 16384},
                  "Column of the tile's upper left corner in the frame, in pixels.");
        v.integer(
            "y", tile.y, {0, 16384},
            "Row of the tile's upper left corner in the frame, in pixels, counted from the top.");
        v.number("turns", tile.turns, {-8, 8},
                 "Rotation of the tile's view about the vertical axis, in units of one tile's "
                 "field of view; +1 is one tile to the left.");
        v.integer("width", tile.width, {0, 8192},
                  "Width of this tile in pixels; 0: the width /wall/tiles/tile_width.");
        v.integer("height", tile.height, {0, 8192},
                  "Height of this tile in pixels; 0: the height /wall/tiles/tile_height.");
        v.numbers("direction_deg", tile.direction_deg, {-180, 180},
                  "Direction of the tile's view in addition to turns, in degrees: yaw to the left, "
                  "then pitch upwards, then roll counter-clockwise as the viewer sees it.");
        v.numbers("frustum_deg", tile.frustum_deg, {-89.5, 89.5},
                  "Angles of the left, right, lower and upper edge of the tile from its direction, "
                  "in degrees; left and lower ones are negative. All 0: a symmetric frustum with "
                  "the field of view /wall/tiles/field_of_view_deg. Views of different tiles may "
                  "overlap.");
        v.numbers("screen_m", tile.screen_m, {-1000, 1000},
                  "Lower left, lower right and upper left corner of the tile's screen relative to "
                  "the eye (x right, y up, z towards the person), in metres. The tile's direction "
                  "and frustum are computed from these corners. All 0: no screen is given.");
        describeView(tile.view, tile.camera, v);
      });
}

}  // namespace merlin
