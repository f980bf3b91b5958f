// TilePlan: which part of the frame buffer shows what, through which frustum. Pure.
//
// Wall tiles look from one point. By default each is turned about the vertical axis by a whole
// field of view from its neighbour, so that the frusta touch and do not overlap: three make one
// wide picture ([GOURLEY98] 2.4). Others have a direction and a frustum of their own, which may be
// off-axis and may overlap those of others, or a screen whose corners are measured from the eye.
// The operator's tile sees the whole model from further back.
//
// Axes: x right, y up, the eye looks along -z. Angles to the left are positive.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/result.h"
#include "render/tiles/settings.h"

namespace merlin::render {

struct Tile {
  std::string name;
  TileKind kind = TileKind::kWall;
  int x = 0, y = 0, width = 0, height = 0;  // in the frame buffer, from its upper left corner [px]
  int wall_x = -1;                          // in the wall's picture [px]; -1 for no wall tile
  Eigen::Matrix4f projection;               // view to clip coordinates, OpenGL's, y up
  Eigen::Matrix4f view;                     // eye to view coordinates: the tile's direction
};

struct TilePlan {
  int frame_width = 0, frame_height = 0;
  int wall_width = 0, wall_height = 0;  // of the picture on the wall, tiles left to right
  std::vector<Tile> tiles;
};

// Errors: kInvalidArgument: the first that validate() finds.
Result<TilePlan> planTiles(const TilesSettings& settings);

// Frustum of a field of view (horizontal, radians) and an aspect (width / height).
Eigen::Matrix4f perspective(float field_of_view_rad, float aspect, float near_m, float far_m);

// Frustum between the tangents of four angles from its direction, left and lower ones negative.
Eigen::Matrix4f offAxis(float left, float right, float lower, float upper, float near_m,
                        float far_m);

// The operator's view of a sphere (centre and radius in eye coordinates, metres): from the front,
// far enough away that all of it is seen in a tile with this projection.
Eigen::Matrix4f operatorView(const Eigen::Matrix4f& projection, const Eigen::Vector3f& centre,
                             float radius);

// Whether any part of a box may be in a tile of the wall: false where all of it is beyond one plane
// of each of their frusta, or nowhere (NaN). `T_eye_box` takes the cube -1..1 to eye coordinates.
bool seesBox(const TilePlan& plan, const Eigen::Matrix4f& T_eye_box) noexcept;

// Turns the view to the left by `yaw_rad`.
Eigen::Matrix4f yawView(float yaw_rad);

}  // namespace merlin::render
