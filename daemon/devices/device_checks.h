// Checks of the device settings against the files that they name; the loader itself reads no other
// file.
#pragma once

#include "config/loader.h"

namespace merlin::devices {

// Adds a finding for a network that cannot be read, and for each binding to a posture that the
// network does not know. Only bindings in the file are checked: a network may lack a posture that
// is bound by default.
void checkPostures(LoadedSettings& loaded);

// The same for the gestures' file and the bindings to gestures; also for a binding to a gesture
// while /gestures/file names none.
void checkGestures(LoadedSettings& loaded);

// Adds a finding for each binding to a key or button whose name the kernel does not know, and for
// each such name in the list "buttons" of an input device.
void checkKeys(LoadedSettings& loaded);

// Adds a finding for each port whose text is invalid, and for each transcript ("replay:FILE") that
// cannot be played, and for each port that is, through a link, the same as an earlier one. A
// missing device is not a fault: it may be connected later.
void checkPorts(LoadedSettings& loaded);

// Adds a finding for each projector whose password cannot be read from its file.
void checkPasswords(LoadedSettings& loaded);

}  // namespace merlin::devices
