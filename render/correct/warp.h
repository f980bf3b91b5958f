// Warp: the position on an output of each point of the uncorrected picture, and the point of that
// picture that each output pixel shows.
//
// Forward, with (u, v) from the upper left corner of the uncorrected picture, each 0..1:
//   pixel = pin(mesh(u, v))
// The mesh moves points within the unit square (GridSurface); the pin maps the unit square to the
// four corners (Homography). A measured warp (MPCDI) is already inverse: it gives (u, v) for each
// point of the output; the pin then moves the resulting picture.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/correct/grid_surface.h"
#include "render/correct/homography.h"
#include "render/correct/settings.h"

namespace merlin::render::correct {

// A raster of any size over the whole output: for the centre of each cell, the point of the
// uncorrected picture that it shows; NaN if it shows nothing.
struct MeasuredWarp {
  int columns = 0, rows = 0;    // each >= 2
  std::vector<Point> places{};  // (u, v), row by row from the top
  MeshInterpolation between = MeshInterpolation::kBilinear;
};

// The point of the uncorrected picture that a pixel's centre shows; NaN: none. It may lie outside
// 0..1 by some pixels.
struct Place {
  float u, v;
};

// Returns the positions [px] of the picture's corners on an output of width x height pixels, moved
// by settings.corners, in the order of Homography.
std::array<Point, 4> pinnedCorners(const CorrectionSettings& settings, int width, int height);

class Warp {
 public:
  // REQUIRES: the corners are convex and the mesh has all its points; validate() checks both.
  // Borrows `settings` and `measured`.
  Warp(const CorrectionSettings& settings, int width, int height,
       const MeasuredWarp* measured = nullptr);

  // Returns the position of (u, v) on the output [px]; nothing if it is beyond the line that maps
  // to infinity. Not for a measured warp, which has no forward direction.
  std::optional<Point> land(Point meant) const noexcept;

  struct Cell {
    int column, row;
  };
  // Returns the first cell of the mesh, row by row, in which the picture is mirrored or has no
  // area; nothing if there is none.
  std::optional<Cell> fold() const;

  // Returns the point that each output pixel shows, row by row. REQUIRES: fold() finds nothing.
  // Takes about 400 ns per pixel if there is a mesh.
  std::vector<Place> places(Threads threads) const;

 private:
  struct Patch;

  std::vector<Point> meshPoints() const;
  std::vector<Patch> patches() const;
  std::optional<Point> solve(const Patch& patch, Point pixel) const noexcept;
  void inverseRow(const std::vector<Patch>& patches, int y, Place* row) const;
  void placeRow(int y, Place* row) const;

  const CorrectionSettings& settings_;
  const MeasuredWarp* measured_;
  int width_, height_;
  Homography pin_;
  std::vector<Point> points_;  // points of the mesh
};

}  // namespace merlin::render::correct
