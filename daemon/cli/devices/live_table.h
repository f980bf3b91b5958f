// The newest values of all devices, as lines for a person.
#pragma once

#include <string>

#include "daemon/base/clock.h"
#include "daemon/shm/device_slots.h"

namespace merlin::cli {

// Each device with its health and its complaint; below it, if it works, its current values: bars
// for the ball's axes and the numbers of its buttons, the glove's joints in degrees and its
// posture, the position of each of the tracker's stations. Below all, the last gesture of each
// hand.
std::string liveTable(const shm::DeviceSlots& devices, Timestamp now);

// "[----|##  ]" for a share -1..1.
std::string axisBar(float share);

}  // namespace merlin::cli
