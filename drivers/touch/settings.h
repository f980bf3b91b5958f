// Settings of a touch frame, touch screen or mouse that the kernel reads.
#pragma once

#include "daemon/base/setting_fault.h"
#include "drivers/port/port_address.h"
#include "drivers/port/touch_frames.h"

namespace merlin {

class SettingsVisitor;

struct TouchSettings {
  TouchOrientation orientation;
  double aspect = 0;        // width / height as a person sees it; 0: as the device reports
  int mouse_counts = 2000;  // counts of a mouse for the surface's whole height
};

// Returns a fault for a port of the wrong kind. Its JSON pointer is "/port".
SettingFaults validate(const TouchSettings& settings, const LineSettings& line);

// Calls `visitor` for every setting, in the order in which MERLIN writes them to a file.
void describe(TouchSettings& settings, SettingsVisitor& visitor);

}  // namespace merlin
