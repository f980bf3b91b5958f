// Describes the machine for a report: versions and hardware, read from /sys, /proc and /etc without
// other programs.
#pragma once

#include <string>
#include <vector>

#include "daemon/cli/report/tar_file.h"

namespace merlin::cli {

// For all functions: `root` is the folder that contains sys, proc, dev and etc, for tests; empty
// for those of this machine. Facts that are not available are left out. Reentrant.

// Returns the versions of MERLIN, of the kernel and of the distribution, one per line.
std::string versionsText(const std::string& root);
// Returns the paths of the libraries that a process has loaded, which include the versions. `pid`:
// id of the process, or "self". Empty if the process belongs to another user.
std::string librariesText(const std::string& root, const std::string& pid);

// Returns a text about CPU, memory, the file systems of MERLIN's folders, graphics cards, displays
// at their connectors, PCI and USB devices, serial adapters, and input devices.
std::string hardwareText(const std::string& root);
// Returns the identification (EDID) of each display as a file named after its connector,
// "card0-HDMI-A-1.edid".
std::vector<PackedFile> displayIds(const std::string& root);

}  // namespace merlin::cli
