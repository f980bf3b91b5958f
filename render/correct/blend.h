// Blend: the share of its light that a projector emits where a neighbour emits the rest, and where
// its black level has to be raised to that of an overlap.
#pragma once

#include "render/correct/settings.h"

namespace merlin::render::correct {

// Share of the light at distance t from the border, t in ramp widths: half a cosine wave from 0 at
// the border to 1 at t = 1. ramp(t) + ramp(1 - t) = 1, so the light of two neighbours adds up to
// the picture's. The slope is 0 at both ends, where a kink would be visible.
double ramp(double t);

// Product of the ramps, 0..1, at (x, y) [px] in an uncorrected picture of width x height pixels.
// Linear light.
double blendGain(const BlendSettings& blend, double x, double y, double width, double height);

// Share, 0..1, of black.level that is added at (x, y). A projector that shows black still emits
// some light, b; where n projectors overlap there is n b. The difference to the largest n of this
// picture is added. With ramps at the sides only, or at top and bottom only, the share is 1 outside
// the ramps and 0 in them; with both it is 1 outside, two thirds in one ramp and 0 in two. At the
// end of a ramp the transition is one pixel wide.
double blackShare(const BlendSettings& blend, double x, double y, double width, double height);

}  // namespace merlin::render::correct
