// Reads a configuration file and reports all findings at once, each with the line, the JSON
// pointer, what was found and what is allowed.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"
#include "daemon/base/result.h"

namespace merlin {

struct Finding {
  bool adjusted = false;  // a number was clamped into its range; false: the file is invalid
  int line = 0;
  std::string pointer;  // RFC 6901, "/wall/rate/rate_hz"
  std::string what;     // rest of the sentence, "is 900; allowed is 1 to 240"
  bool quotes = false;  // `what` quotes text that may be anything, also a secret
};

struct LoadedSettings {
  enum class Verdict { kValid, kAdjusted, kInvalid };

  // Findings beyond this number are only counted: a file of 1 MiB can have hundreds of thousands.
  static constexpr std::size_t kMostFindings = 200;

  Settings settings;                 // meaningful unless the verdict is kInvalid
  std::vector<Finding> findings;     // the first ones, in the order of the file's lines
  std::size_t left_out = 0;          // number of further findings, not kept
  std::map<std::string, int> lines;  // line of each setting that the file has, by pointer

  Verdict verdict() const;
  // Line of a setting; if the file does not have the setting, the line of the innermost enclosing
  // group that the file has; 0 if there is no such group.
  int lineOf(const std::string& pointer) const;
  // Adds a finding. Cost: constant.
  void add(Finding finding);
  // Adds a finding that makes the file invalid.
  void addFinding(const std::string& pointer, std::string what);
  // Sorts the findings by line; to be called after the last add() or addFinding().
  void sortFindings();

 private:
  bool left_out_invalid_ = false;
};

// Reads settings from a JSON text. Relative paths in it are relative to `folder`. Never fails:
// syntax errors are findings.
LoadedSettings loadSettings(std::string_view json, const std::string& folder);

// Reads settings from a file; a file that cannot be opened is a finding too (line 0).
LoadedSettings loadSettingsFile(const std::string& path);

// The finding as one line, "demo.json:12: /wall/rate/rate_hz ...". Line breaks and terminal escape
// sequences in the file's name, keys or values are replaced.
std::string toText(const std::string& file, const Finding& finding);

}  // namespace merlin
