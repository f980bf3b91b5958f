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

// The subject of a report: a configuration and its daemon.
struct ReportSubject {
  std::string config;                // the configuration's file
  LoadedSettings loaded;             // the settings in it
  std::string instance;              // name of the daemon
  std::string run_directory;         // folder of its sockets; "flight" in it has flight recordings
  std::vector<KeptSettings> kept{};  // used instead of `loaded` if that is invalid

  bool isValid() const { return loaded.verdict() != LoadedSettings::Verdict::kInvalid; }
  // The settings by which the daemon is found: those of the file, or, if they are invalid, the
  // first that are kept.
  const Settings& settings() const {
    return isValid() || kept.empty() ? loaded.settings : kept.front().loaded.settings;
  }
};

struct ReportPart {
  PartSettings settings;
  std::string about;  // a description, as a clause
};

// The parts in the order in which they are collected; the most useful first, since they get space
// first. `subject` must outlive them.
std::vector<ReportPart> reportParts(const ReportSubject& subject);

// The findings of a configuration, one per line, without text copied from the file, which may
// contain anything.
std::string findingsText(const std::string& file, const LoadedSettings& loaded);

}  // namespace merlin::cli
