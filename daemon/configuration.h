// Configuration: reads and checks the configuration file and the files that it names. merlind uses
// the same checks for `--check-config` and when it starts, so that both always agree.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/wall/wall_checks.h"

namespace merlin {

struct DaemonOptions {
  bool devices = true, wall = true;  // the roles of this process
  bool emulate = false;
  bool page = false;    // whether this process has the role page; it then has no other
  bool alarms = false;  // whether this process has the role alarms; it then has no other
  // The file in which the last good settings are kept (daemon/last_good.h); empty: they are not
  // kept.
  std::string last_good{};
};

struct Configuration {
  LoadedSettings loaded;  // the settings, with all findings
  // The wall's contents; only for the role wall, and not to be used if the verdict is kInvalid.
  std::vector<wall::WallContent> contents;
  std::string file;
  // Why the last good settings are used instead of those of `file` (daemon/last_good.h), as a
  // sentence; empty: these are the settings of `file`.
  std::string instead_of{};
};

// Why the configuration is read. kStart: merlind starts. kAgain: merlind runs and reloads the file;
// the contents are not read and the renderer is not checked again, because that may take long.
enum class Reading { kStart, kAgain };

// Reads the file and all other files that merlind reads when it starts with these roles; files that
// only other roles need are not checked. Changes nothing on disk. Never fails: faults are findings.
// Conditions that may change while merlind runs (a missing device, a port in use) are not faults.
// Cost: linear in the size of the models' files.
Configuration readConfiguration(const std::string& file, const DaemonOptions& options,
                                Reading reading = Reading::kStart);

// Returns one line of text for each finding and, if some findings were left out, a last line with
// their number. `file`: name of the configuration, for the lines.
std::vector<std::string> findingLines(const std::string& file, const LoadedSettings& loaded);

}  // namespace merlin
