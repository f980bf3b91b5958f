// Blend: computes the share of its light that a projector emits where a neighbour emits the rest,
// and where its black level is to be raised to that of an overlap. Pure.
#pragma once

#include "render/correct/settings.h"

namespace merlin::render::correct {

// Returns the share of the light at distance t from the border, t in ramp widths: half a cosine
// wave from 0 at the border to 1 at t = 1. ramp(t) + ramp(1 - t) = 1, so the light of two
// neighbours adds up to the picture's. The slope is 0 at both ends, where a kink would be visible.
double ramp(double t);

// Returns the product of the ramps, 0..1 in linear light, at (x, y) [px] in an uncorrected picture
// of width x height pixels.
double blendGain(const BlendSettings& blend, double x, double y, double width, double height);

// Returns the share, 0..1, of black.level that is added at (x, y) [px]. A projector that shows
// black still emits some light, b; where n projectors overlap there is n b. The share makes up for
// the difference to the largest n of this picture. With ramps at the sides only, or at top and
// bottom only, the share is 1 outside the ramps and 0 in them; with both it is 1 outside, two
// thirds in one ramp and 0 in two. At the end of a ramp the transition is one pixel wide.
double blackShare(const BlendSettings& blend, double x, double y, double width, double height);

}  // namespace merlin::render::correct
