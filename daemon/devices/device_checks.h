// Checks of the device settings against the files that they name; the loader itself does not read
// these files.
#pragma once

#include "config/loader.h"

namespace merlin::devices {

// Adds a finding if the network of postures cannot be read, and one for each binding to a posture
// that the network does not know. Only bindings in the configuration file are checked, since a
// network may lack a posture that is bound by default.
void checkPostures(LoadedSettings& loaded);

// Adds a finding if the file of gestures cannot be read, and one for each binding in the
// configuration file to a gesture that this file lacks. If /gestures/file names no file, each
// binding to a gesture gets a finding.
void checkGestures(LoadedSettings& loaded);

// Adds a finding for each binding in the configuration file to a key or button whose name the
// kernel does not know, and for each unknown name in the list "buttons" of an input device.
void checkKeys(LoadedSettings& loaded);

// Adds a finding for each port whose text is invalid, for each transcript ("replay:FILE") that
// cannot be read, and for each port that is the same device as an earlier one when symbolic links
// are followed. A missing device is not a fault, since it may be connected later.
void checkPorts(LoadedSettings& loaded);

// Adds a finding for each projector whose password cannot be read from its file.
void checkPasswords(LoadedSettings& loaded);

}  // namespace merlin::devices
