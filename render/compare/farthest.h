// The point of one surface that is farthest from another: an interval that certainly holds its
// distance (the one-sided Hausdorff distance).
//
// Branch and bound. Below: the largest distance of any point tested. Above: the distance to a
// convex set is convex, so over a part T of a triangle the distance to any one triangle t is
// largest at a corner of T; the distance to the whole surface is no more than that. Parts whose
// bound does not matter are dropped, the one with the largest is halved. After [GUTHE05], with
// halves at the longest edge and bounds from triangles known to be near.
#pragma once

#include <optional>

#include "render/compare/sampled.h"

namespace merlin::render {

struct Interval {
  double low = 0, high = 0;     // model units; certain but for rounding (1e-12 of the distance)
  std::size_t evaluations = 0;  // points tested
};

struct Search {
  double width = 0;                 // wanted of the interval, model units
  std::size_t max_evaluations = 0;  // then the interval is returned as wide as it is
  unsigned threads = 1;
};

// Tests each vertex of `from` first, whatever the budget; then in rounds that do not depend on the
// number of threads. 120 bytes a part that is kept.
// goOn     as of sampledError(); the search's own share is guessed from the interval's width.
std::optional<Interval> farthest(const Surface& from, const Surface& to, const Search& search,
                                 const GoOn& goOn);

}  // namespace merlin::render
