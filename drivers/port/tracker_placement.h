// TrackerPlacement: how the frame of a tracker that measures in one of its own, as motion capture
// and VR systems do, lies in the frame that the rest of MERLIN takes all trackers to have. Pure.
#pragma once

#include <array>
#include <string>

#include "daemon/base/result.h"
#include "daemon/base/setting_fault.h"
#include "drivers/port/samples.h"

namespace merlin {

class SettingsVisitor;

struct TrackerPlacement {
  // Which of its axes (1 x, 2 y, 3 z; negative: reversed) are x, y and z of the samples.
  std::array<int, 3> axes = {1, 2, 3};
  // The place of its origin, in the frame of the samples [m].
  std::array<double, 3> origin_m{};
};

// Turns and moves the sample's pose. Axes may also mirror the frame: rotations then turn the other
// way about their mirrored axis. REQUIRES: checkPlacement() finds nothing.
void place(const TrackerPlacement& placement, TrackerSample& sample) noexcept;

// The placement whose origin is `origin`, whose x axis goes through `on_x` and whose y axis lies on
// the side of `on_y`: places as they are sent [m]. Errors: kMalformed (an axis lies more than 20
// degrees off those that are sent, both lie along one).
Result<TrackerPlacement> placementOf(const std::array<double, 3>& origin,
                                     const std::array<double, 3>& on_x,
                                     const std::array<double, 3>& on_y);

// Adds a fault if the axes are not each of x, y and z once. `pointer`: of the driver's settings.
void checkPlacement(const TrackerPlacement& placement, const std::string& pointer,
                    SettingFaults& faults);

// Calls `visitor` for "axes" and "origin_m".
void describe(TrackerPlacement& placement, SettingsVisitor& visitor);

}  // namespace merlin
