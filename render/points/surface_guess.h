// The parameters of a surface through points, guessed from the points' spacing. Pure.
#pragma once

#include <vector>

namespace merlin::render::points {

struct SurfaceSettings {
  int depth = 0;       // of Poisson's octree; 0: guessed
  int neighbours = 0;  // points that make a normal; 0: guessed
  // Farthest distance of the surface from the nearest point [the file's unit]; below 0: guessed,
  // 0: nothing is trimmed.
  double trim = -1;
};

inline constexpr int kLeastDepth = 4, kMostDepth = 12, kMostGuessedDepth = 10;
inline constexpr int kLeastNeighbours = 3, kMostNeighbours = 200;

// Median of the distances from points to neighbours; distances of 0 (points that are there twice)
// do not count. 0 if there is none.
double medianSpacing(std::vector<double> distances);

// The side of a cell of the octree at that depth, in the unit of `extent`, the longest side of the
// points' box.
double cellOf(int depth, double extent);

// Fills what is to be guessed: a depth at which a cell of the octree is as wide as the spacing, or
// kMostGuessedDepth at most; 16 neighbours; a trim of four spacings, or of three cells where these
// are wider. `extent`: as of cellOf(). REQUIRES: spacing > 0, extent > 0.
SurfaceSettings guessed(SurfaceSettings said, double extent, double spacing);

}  // namespace merlin::render::points
