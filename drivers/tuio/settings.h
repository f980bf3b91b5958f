// Settings of a touch surface that a TUIO tracker reports over the network.
#pragma once

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"
#include "drivers/port/touch_frames.h"

namespace merlin {

class SettingsVisitor;

struct TuioSettings {
  TouchOrientation orientation;
  double aspect = 16.0 / 9;  // the surface's width / height as a person sees it
};

// Returns a fault for a port of the wrong kind. Its JSON pointer is "/port".
SettingFaults validate(const TuioSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(TuioSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
