#include "render/points/surface_guess.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::points {

double medianSpacing(std::vector<double> distances) {
  std::erase_if(distances, [](double d) { return !(d > 0); });
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

double cellOf(int depth, double extent) {
  constexpr double kMargin = 1.1;  // side of the reconstruction's cube / side of the points' box
  return kMargin * extent / std::exp2(depth);
}

SurfaceSettings guessed(SurfaceSettings said, double extent, double spacing) {
  constexpr int kNeighbours = 16;
  const double cells = cellOf(0, extent) / spacing;
  if (said.depth == 0)
    said.depth = static_cast<int>(
        std::clamp(std::round(std::log2(cells)), double{kLeastDepth}, double{kMostGuessedDepth}));
  if (said.neighbours == 0) said.neighbours = kNeighbours;
  if (said.trim < 0) said.trim = std::max(4 * spacing, 3 * cellOf(said.depth, extent));
  return said;
}

}  // namespace merlin::render::points
