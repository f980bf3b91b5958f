// Defines the parts of a report, and how each is collected.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/cli/report/part.h"

namespace merlin::cli {

// The last valid settings, with which a merlind runs while its configuration is invalid (merlind
// --last-good).
struct KeptSettings {
  std::string file;
  LoadedSettings loaded;
};

// The subject of a report: a configuration and its daemon.
struct ReportSubject {
  std::string config;                // the configuration's file
  LoadedSettings loaded;             // the settings in it
  std::string instance;              // name of the daemon
  std::string run_directory;         // folder of its sockets; "flight" in it has flight recordings
  std::vector<KeptSettings> kept{};  // the last valid settings, used if `loaded` is invalid

  bool isValid() const { return loaded.verdict() != LoadedSettings::Verdict::kInvalid; }
  // Returns the settings by which the daemon is found: those in `loaded` or, if these are invalid,
  // the first in `kept`.
  const Settings& settings() const {
    return isValid() || kept.empty() ? loaded.settings : kept.front().loaded.settings;
  }
};

struct ReportPart {
  PartSettings settings;
  std::string about;  // a description, as a clause
};

// Returns the parts in the order in which they are collected: the most useful first, because they
// get space first. `subject` must outlive the parts.
std::vector<ReportPart> reportParts(const ReportSubject& subject);

// Returns the findings of a configuration, one per line. Text quoted from the file is left out,
// because it may contain secrets.
std::string findingsText(const std::string& file, const LoadedSettings& loaded);

}  // namespace merlin::cli
