// Guesses the parameters of a surface reconstruction from the spacing of the points. Pure.
#pragma once

#include <vector>

namespace merlin::render::points {

struct SurfaceSettings {
  int depth = 0;       // depth of the octree of the Poisson reconstruction; 0: guessed
  int neighbours = 0;  // number of points from which a normal is estimated; 0: guessed
  // Parts of the surface that are farther than this from the nearest point are removed [the file's
  // unit]; a negative value is replaced by a guess; 0: nothing is removed.
  double trim = -1;
};

inline constexpr int kLeastDepth = 4, kMostDepth = 12, kMostGuessedDepth = 10;
inline constexpr int kLeastNeighbours = 3, kMostNeighbours = 200;

// Returns the median of the distances from points to neighbours. Distances of 0 (duplicate points)
// are ignored; returns 0 if there are no other distances.
double medianSpacing(std::vector<double> distances);

// Returns the side of a cell of the octree at `depth`, in the unit of `extent`, which is the
// longest side of the points' bounding box.
double cellOf(int depth, double extent);

// Returns `said` with guesses for the values that are marked as guessed: the depth at which a cell
// of the octree is as wide as the spacing, at most kMostGuessedDepth; 16 neighbours; a trim of four
// spacings or three cells, whichever is longer. `extent`: as in cellOf(). REQUIRES: spacing > 0,
// extent > 0.
SurfaceSettings guessed(SurfaceSettings said, double extent, double spacing);

}  // namespace merlin::render::points
