// Formats the newest values of all devices as lines for a person.
#pragma once

#include <string>

#include "daemon/base/clock.h"
#include "daemon/shm/device_slots.h"

namespace merlin::cli {

// Returns a line for each device with its health, rate and fault. If the device works, its current
// values follow: bars for the ball's axes and its pressed buttons, the glove's joints [degrees] and
// its posture, the pose of each tracker station, or the fingers on the touch surface. The last
// gesture of each hand is at the end.
std::string liveTable(const shm::DeviceSlots& devices, Timestamp now);

// Returns a bar for a share from -1 to 1, with 10 characters on each side of the middle: 0.5 gives
// "[          |#####     ]".
std::string axisBar(float share);

}  // namespace merlin::cli
