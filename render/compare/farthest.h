// Finds the largest distance of a point of one surface from another surface (the one-sided
// Hausdorff distance), as an interval that is certain to contain it.
//
// The method is branch and bound. Lower bound: the largest distance of any point tested. Upper
// bound: the distance to a convex set is a convex function, so over a part T of a triangle, the
// distance to any one triangle t is largest at a corner of T; the distance to the whole surface is
// at most that. A part whose upper bound is close enough to the lower bound is dropped; the part
// with the largest upper bound is halved. The method follows [GUTHE05], but parts are halved at the
// longest edge, and bounds are computed from triangles known to be near.
#pragma once

#include <optional>

#include "render/compare/sampled.h"

namespace merlin::render::compare {

struct Interval {
  // [model units]; certain except for rounding (1e-12 of the distance)
  double low = 0, high = 0;
  std::size_t evaluations = 0;  // number of points tested
};

struct Search {
  double width = 0;                 // wanted width of the interval [model units]
  std::size_t max_evaluations = 0;  // limit of tested points; the interval may then stay wider
  unsigned threads = 1;
};

// Returns the interval of the largest distance of a point of `from` from `to`; nothing if
// cancelled. Tests each vertex of `from` first, even beyond max_evaluations; then halves parts in
// rounds that do not depend on the number of threads. Memory: 120 bytes per part that is kept.
//
// keepGoing     as for sampledError(); the share is estimated from the interval's width.
std::optional<Interval> farthest(const Surface& from, const Surface& to, const Search& search,
                                 const KeepGoing& keepGoing);

}  // namespace merlin::render::compare
