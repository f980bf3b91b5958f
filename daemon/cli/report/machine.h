// The texts of a report about the machine: versions and hardware, read from /sys, /proc and /etc
// without other programs.
#pragma once

#include <string>
#include <vector>

#include "daemon/cli/report/tar_file.h"

namespace merlin::cli {

// `root`: the folder that has /sys, /proc, /dev and /etc; empty for this machine's. Missing facts
// are left out of the texts. Reentrant.

// MERLIN, kernel and distribution, one per line.
std::string versionsText(const std::string& root);
// The files of libraries that a process has loaded, by their full paths, which include the
// versions. Empty if the process is another user's.
std::string librariesText(const std::string& root, const std::string& pid);

// CPU, memory, file systems of MERLIN's folders, graphics cards, displays at their connectors, PCI
// and USB devices, serial adapters by id, and input devices.
std::string hardwareText(const std::string& root);
// The identification (EDID) of each display, by connector: "card0-HDMI-A-1.edid".
std::vector<PackedFile> displayIds(const std::string& root);

}  // namespace merlin::cli
