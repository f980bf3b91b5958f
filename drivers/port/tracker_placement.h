// TrackerPlacement: transforms poses from a tracker's own frame, which motion capture and VR
// systems have, to the frame that the rest of MERLIN assumes for all trackers. Pure.
#pragma once

#include <array>
#include <string>

#include "daemon/base/result.h"
#include "daemon/base/setting_fault.h"
#include "drivers/port/samples.h"

namespace merlin {

class SettingsVisitor;

struct TrackerPlacement {
  // The tracker's axes (1 x, 2 y, 3 z; negative: reversed) that become x, y and z of the samples.
  std::array<int, 3> axes = {1, 2, 3};
  // Position of the tracker's origin in the frame of the samples.
  std::array<double, 3> origin_m{};
};

// Transforms the sample's pose. Axes may also mirror the frame; rotations about the mirrored axis
// are then reversed. REQUIRES: checkPlacement() finds nothing.
void place(const TrackerPlacement& placement, TrackerSample& sample) noexcept;

// Complaint about a pose that is plausible as received (drivers/port/plausible.h), but not after
// place(). A driver drops such a pose, since readers on other machines would reject it.
inline constexpr const char* kPlacedTooFar =
    "poses lie beyond 25 m with \"origin_m\" added: is \"origin_m\" right?";

// Returns the placement whose origin is `origin`, whose x axis goes through `on_x` and whose y axis
// lies on the side of `on_y`. The three places are as the tracker sends them [m]. Errors:
// kMalformed (an axis lies more than 20 degrees off each of the tracker's axes, or both lie along
// the same one).
Result<TrackerPlacement> placementOf(const std::array<double, 3>& origin,
                                     const std::array<double, 3>& on_x,
                                     const std::array<double, 3>& on_y);

// Adds a fault unless each of x, y and z is used by one axis. `pointer`: JSON pointer of the
// driver's settings.
void checkPlacement(const TrackerPlacement& placement, const std::string& pointer,
                    SettingFaults& faults);

// Calls `visitor` for the settings "axes" and "origin_m".
void describe(TrackerPlacement& placement, SettingsVisitor& visitor);

}  // namespace merlin
