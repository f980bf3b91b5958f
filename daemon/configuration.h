// Configuration: a file with all that a start takes from it, checked. `--check-config` and the
// start are the same check, so that neither accepts what the other refuses.
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
  LoadedSettings loaded;            // with every finding
  std::vector<wall::Model> models;  // of the wall's role; meaningful unless invalid
};

// Reads the file, and what else a start with these roles would read; what another role would need
// is not looked for. Changes nothing on disk. Never fails: what is wrong is a finding. What may
// come or go while merlind runs (a device, a port that another program has) is none. O(models).
Configuration readConfiguration(const std::string& file, const DaemonOptions& options);

}  // namespace merlin
