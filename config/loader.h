// Reading a configuration file: every finding at once, each with the line, the JSON pointer, what
// was found and what is allowed.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"
#include "daemon/base/result.h"

namespace merlin {

struct Finding {
  bool adjusted = false;  // a number was clamped into its range; else the file is invalid
  int line = 0;
  std::string pointer;  // RFC 6901, "/wall/rate/rate_hz"
  std::string what;
};

struct LoadedSettings {
  enum class Verdict { kValid, kAdjusted, kInvalid };

  Settings settings;  // meaningful unless invalid
  std::vector<Finding> findings;
  std::map<std::string, int> lines;  // of each setting that the file has, by pointer

  Verdict verdict() const;
  // Where a setting stands; one that the file does not have, where the nearest group around it
  // does.
  int lineOf(const std::string& pointer) const;
  // One finding more, that makes the file invalid.
  void wrong(const std::string& pointer, std::string what);
};

// Reads a text. Relative paths in it are taken from `folder`. Never fails: syntax errors are
// findings.
LoadedSettings loadSettings(std::string_view json, const std::string& folder);

// Reads a file; what cannot be opened is a finding too (line 0).
LoadedSettings loadSettingsFile(const std::string& path);

// "demo.json:12: /wall/rate/rate_hz: ..." a line.
std::string toText(const std::string& file, const Finding& finding);

}  // namespace merlin
