// The parts of a report, and how each is collected.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/cli/report/part.h"

namespace merlin::cli {

// Settings with which a process of merlind runs while the configuration is invalid (merlind
// --last-good).
struct KeptSettings {
  std::string file;
  LoadedSettings loaded;
};

// What a report is about.
struct ReportSubject {
  std::string config;                // the configuration's file
  LoadedSettings loaded;             // what it says
  std::string instance;              // name of the daemon
  std::string run_directory;         // of its sockets; flight recordings are in its folder flight
  std::vector<KeptSettings> kept{};  // if `loaded` is invalid: instead of it

  bool isValid() const { return loaded.verdict() != LoadedSettings::Verdict::kInvalid; }
  // The settings by which the daemon is found: those of the file, or else the first that are kept.
  const Settings& settings() const {
    return isValid() || kept.empty() ? loaded.settings : kept.front().loaded.settings;
  }
};

struct ReportPart {
  PartSettings settings;
  std::string about;  // what it is, as a clause
};

// In the order in which they are collected; the most useful first, since they get their room first.
// `subject` outlives them.
std::vector<ReportPart> reportParts(const ReportSubject& subject);

// The findings of a configuration, one per line, without text of the file that may be anything.
std::string findingsText(const std::string& file, const LoadedSettings& loaded);

}  // namespace merlin::cli
