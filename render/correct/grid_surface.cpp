#include "render/correct/grid_surface.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::correct {

// A point outside the grid is extrapolated as 2 a - b from the border point a and its inner
// neighbour b, so its weight is distributed to these two.
GridSurface::Weights GridSurface::weights(double place, int count) const noexcept {
  const int cell = static_cast<int>(std::clamp(std::floor(place), 0.0, count - 2.0));
  double t = place - cell;
  // Exactly at a grid point its neighbours must not contribute, as they may be NaN in a measured
  // warp.
  constexpr double kRounding = 1e-8;
  if (std::abs(t - std::round(t)) < kRounding) t = std::round(t);
  const double t2 = t * t, t3 = t2 * t;
  if (between_ == MeshInterpolation::kBilinear) return {cell - 1, {0, 1 - t, t, 0}};
  Weights w{cell - 1,
            {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t),
             0.5 * (t3 - t2)}};
  if (cell == 0) {
    w.weight[1] += 2 * w.weight[0];
    w.weight[2] -= w.weight[0];
    w.weight[0] = 0;
  }
  if (cell == count - 2) {
    w.weight[2] += 2 * w.weight[3];
    w.weight[1] -= w.weight[3];
    w.weight[3] = 0;
  }
  return w;
}

Point GridSurface::at(double column, double row) const noexcept {
  const Weights across = weights(column, columns_), down = weights(row, rows_);
  Point sum;
  for (int j = 0; j < 4; ++j) {
    if (down.weight[j] == 0) continue;  // the point may be outside the grid
    Point line;
    for (int i = 0; i < 4; ++i) {
      if (across.weight[i] == 0) continue;
      const Point& p =
          points_[static_cast<std::size_t>(down.first + j) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(across.first + i)];
      line.x += across.weight[i] * p.x;
      line.y += across.weight[i] * p.y;
    }
    sum.x += down.weight[j] * line.x;
    sum.y += down.weight[j] * line.y;
  }
  return sum;
}

}  // namespace merlin::render::correct
