// Determines how a touch surface is mounted from the corners that a person touches on request.
// Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "daemon/base/result.h"
#include "drivers/port/guided_step.h"
#include "drivers/port/samples.h"
#include "drivers/port/touch_frames.h"

namespace merlin {

// Returns the steps: touching the top left, the top right and the bottom left corner.
std::span<const GuidedStep> cornerSteps();

// A place on the surface, as shares 0..1 of the device's own axes.
using SurfacePlace = std::array<float, 2>;

class GuidedCorners {
 public:
  void begin(std::size_t step);  // starts or restarts a step; later samples belong to it
  // Adds a sample that was measured with the default orientation, thus in the device's own axes.
  void add(const TouchSample& sample);

  // Ends the current step with the mean place of the finger. Errors, all kMalformed: no finger or
  // several touched; the corner coincides with an earlier one, or is neither beside nor below the
  // first.
  Result<SurfacePlace> end();

  // Returns how the surface is mounted. REQUIRES: each step has ended without an error.
  TouchOrientation solve() const;

 private:
  std::size_t step_ = 0, samples_ = 0;
  bool several_ = false;
  SurfacePlace sum_{};
  std::array<SurfacePlace, 3> corners_{};
};

}  // namespace merlin
