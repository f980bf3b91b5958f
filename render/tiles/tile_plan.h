// TilePlan: for each tile, its rectangle in the frame and the camera (projection and view matrix)
// that it is drawn with. Pure.
//
// The cameras of all wall tiles are at one point, the eye. By default each is turned about the
// vertical axis by one field of view from its neighbour, so that the frusta touch without
// overlapping: three tiles make one wide picture ([GOURLEY98] 2.4). A tile may also have its own
// direction and frustum, which may be off-axis and may overlap others, or a screen whose corners
// are measured from the eye. The operator's tile shows the whole model from further back.
//
// Axes: x right, y up, the eye looks along -z. Angles to the left are positive.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/result.h"
#include "render/tiles/settings.h"

namespace merlin::render::tiles {

struct Tile {
  std::string name;
  TileKind kind = TileKind::kWall;
  int x = 0, y = 0, width = 0, height = 0;  // in the frame, from its upper left corner [px]
  int wall_x = -1, wall_y = -1;  // upper left corner in the wall's picture [px]; -1: none
  Eigen::Matrix4f projection;    // view to OpenGL's clip coordinates, y up
  Eigen::Matrix4f view;          // eye to view coordinates: the tile's direction
  TileCamera camera = TileCamera::kWall;
  Eye eye = Eye::kMiddle;
  std::array<double, 9> screen_m{};  // as in TileSettings; all 0: none

  bool followsWall() const { return kind == TileKind::kWall && camera == TileCamera::kWall; }
  // Returns whether the tile's view is fitted to the content: see matricesOf().
  bool isFitted() const {
    return kind == TileKind::kOperator ||
           (camera != TileCamera::kWall && camera != TileCamera::kFree);
  }
};

struct TilePlan {
  int frame_width = 0, frame_height = 0;
  int wall_width = 0, wall_height = 0;  // the wall's picture: see layOutWall() [px]
  std::vector<Tile> tiles;
  double near_m = 0, far_m = 0;
};

// Position of the viewer's eyes relative to the eye that the plan was made for (x right, y up, z
// towards the person) [m].
struct Viewer {
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // the middle between the eyes
  Eigen::Vector3d eyes_m = Eigen::Vector3d::Zero();   // vector from the left to the right eye

  Eigen::Vector3d placeOf(Eye eye) const {
    return eye == Eye::kMiddle
               ? place_m
               : Eigen::Vector3d(place_m + (eye == Eye::kLeft ? -0.5 : 0.5) * eyes_m);
  }
};

// Computes the plan. Errors: kInvalidArgument: the first fault that validate() finds.
Result<TilePlan> planTiles(const TilesSettings& settings);

// Moves the viewer: each tile that follows the wall and has a screen gets the off-axis frustum of
// that screen from its eye, along the screen's normal. Returns false, and leaves the plan
// unchanged, if an eye does not see the front of one of the screens, or sees it 179 degrees wide or
// high.
bool placeViewer(TilePlan& plan, const Viewer& viewer);

// Returns a symmetric projection with a horizontal field of view and an aspect ratio (width /
// height).
Eigen::Matrix4f perspective(float field_of_view_rad, float aspect, float near_m, float far_m);

// Returns an off-axis projection. `left`, `right`, `lower`, `upper`: tangents of the angles between
// the view direction and the edges; those to the left and below are negative.
Eigen::Matrix4f offAxis(float left, float right, float lower, float upper, float near_m,
                        float far_m);

// Returns the view matrix of the operator's view of a sphere (centre and radius in eye coordinates,
// metres): from the front, at the distance at which all of it is visible with this projection.
Eigen::Matrix4f operatorView(const Eigen::Matrix4f& projection, const Eigen::Vector3f& centre,
                             float radius);

// The matrices with which a tile is drawn.
struct TileMatrices {
  Eigen::Matrix4f projection, view;
};

// Returns a parallel projection of a sphere (centre and radius in eye coordinates, metres), along
// an axis of the wall: the sphere fits into the tile, wherever it is. In the view from above, the
// viewer's side is at the lower edge; in the view from the right, at the left edge. REQUIRES:
// `camera` is kTop, kSide or kFront.
TileMatrices parallelMatrices(TileCamera camera, float aspect, const Eigen::Vector3f& centre,
                              float radius);

// Returns the matrices for a content with this bounding sphere (eye coordinates, metres): fitted to
// the sphere if tile.isFitted(), otherwise those of the plan.
TileMatrices matricesOf(const Tile& tile, const Eigen::Vector3f& centre, float radius);

// Returns the matrices for a panorama, whose centre is always at the eye: the plan's frustum and
// direction. A tile that is fitted to other contents (isFitted()) looks straight ahead.
TileMatrices panoramaMatrices(const Tile& tile);

// Returns whether any part of a box may be visible in a tile that follows the wall or has a free
// camera: false if, for each of them, the whole box is outside one plane of the frustum, or if its
// matrix contains NaN. `T_eye_box` takes the cube -1..1 to eye coordinates.
bool seesBox(const TilePlan& plan, const Eigen::Matrix4f& T_eye_box) noexcept;

// Returns the view matrix of a camera that is turned to the left by `yaw_rad`.
Eigen::Matrix4f yawView(float yaw_rad);

}  // namespace merlin::render::tiles
