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
  bool page = false;    // the role page; without devices and wall
  bool alarms = false;  // the role alarms; without devices and wall
  // The file in which the settings in effect are kept; empty: they are not kept.
  std::string last_good{};
};

struct Configuration {
  LoadedSettings loaded;  // the settings, with all findings
  // For the role wall; not to be used if the verdict is kInvalid.
  std::vector<wall::WallContent> contents;
  std::string file;
  // A sentence: why this is not the configuration of `file` but the previous one
  // (daemon/last_good.h); empty: it is that of the file.
  std::string instead_of{};
};

// kAgain: merlind already runs with a configuration of this file; contents and renderer are not
// read again, because that may take long.
enum class Reading { kStart, kAgain };

// Reads the file and all other files that merlind reads when it starts with these roles; files that
// only other roles need are not checked. Changes nothing on disk. Never fails: faults are findings.
// Conditions that may change while merlind runs (a missing device, a port in use) are not faults.
// Cost: linear in the size of the models' files.
Configuration readConfiguration(const std::string& file, const DaemonOptions& options,
                                Reading reading = Reading::kStart);

// The findings as lines, and how many further ones there are.
std::vector<std::string> findingLines(const std::string& file, const LoadedSettings& loaded);

}  // namespace merlin
