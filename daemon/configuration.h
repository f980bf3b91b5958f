// Configuration: the configuration file and the files that it names, read and checked.
// `--check-config` and the start use the same check, so that they always agree.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/wall/wall_checks.h"

namespace merlin {

struct DaemonOptions {
  bool devices = true, wall = true;  // roles
  bool emulate = false;
};

struct Configuration {
  LoadedSettings loaded;            // the settings, with all findings
  std::vector<wall::Model> models;  // for the role wall; meaningful unless the verdict is kInvalid
};

// Reads the file, and all other files that a start with these roles would read; files that only
// other roles need are not checked. Changes nothing on disk. Never fails: faults are findings.
// Things that may change while merlind runs (a missing device, a port in use) are not faults.
// O(models).
Configuration readConfiguration(const std::string& file, const DaemonOptions& options);

}  // namespace merlin
