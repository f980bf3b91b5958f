// GridSurface: interpolates a grid of points as a surface, smooth (bicubic) or piecewise bilinear.
//
// The smooth surface is the tensor product of Catmull-Rom splines (E. Catmull and R. Rom, "A class
// of local interpolating splines", 1974): it passes through every point, and its tangent at a point
// is parallel to the line between the point's neighbours. At the border, the tangent points to the
// next point.
#pragma once

#include <cstddef>
#include <span>

#include "render/correct/homography.h"
#include "render/correct/settings.h"

namespace merlin::render::correct {

class GridSurface {
 public:
  // `points`: columns * rows points, row by row; borrowed. REQUIRES: columns, rows >= 2.
  GridSurface(int columns, int rows, std::span<const Point> points, MeshInterpolation between)
      : columns_(columns), rows_(rows), points_(points), between_(between) {}

  // Returns the surface's point at (column, row), in grid units; outside the grid, the outermost
  // cell is extrapolated. NaN if one of the points that contribute is NaN.
  Point at(double column, double row) const noexcept;

 private:
  // Interpolation along one axis: index of the first of four points, and their weights. Points
  // outside the grid have weight 0; in bilinear mode only the middle two have a weight.
  struct Weights {
    int first;
    double weight[4];
  };
  Weights weights(double place, int count) const noexcept;

  int columns_, rows_;
  std::span<const Point> points_;
  MeshInterpolation between_;
};

}  // namespace merlin::render::correct
