// Reads a configuration (a file and those of conf.d beside it), and reports all findings at once,
// each with the file, the line, the JSON pointer, what was found and what is allowed.
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
  int line = 0;           // of its file; for add(): see LoadedSettings::lines
  std::string pointer;    // RFC 6901, "/wall/rate/rate_hz"
  std::string what;       // rest of the sentence, "is 900; allowed is 1 to 240"
  bool quotes = false;    // `what` quotes text that may be anything, also a secret
  std::string file = {};  // the file of conf.d; empty: the configuration itself
};

struct LoadedSettings {
  enum class Verdict { kValid, kAdjusted, kInvalid };

  // Findings beyond this number are only counted: a file of 1 MiB can have hundreds of thousands.
  static constexpr std::size_t kMostFindings = 200;

  // One of the files, in the order in which they are merged: the configuration, whose name is empty
  // here, and those of conf.d. Lines are counted through all files.
  struct Source {
    std::string file;
    int lines_before = 0, last_line = 0;
  };
  struct Place {
    std::string file;  // empty: the configuration itself
    int line = 0;      // of that file
  };

  Settings settings;              // meaningful unless the verdict is kInvalid
  std::vector<Finding> findings;  // the first ones, in the order of the files and their lines
  std::size_t left_out = 0;       // number of further findings, not kept
  // Line of each setting that the files have, by pointer. Lines are counted through all files;
  // placeAt() converts them.
  std::map<std::string, int> lines;
  std::vector<Source> sources;
  bool parsed = false;  // false: not parsed (see findings); settings are the defaults

  Verdict verdict() const;
  // Line of a setting; if no file has the setting, the line of the innermost enclosing group that a
  // file has; 0 if there is no such group. Counted through all files.
  int lineOf(const std::string& pointer) const;
  // Converts a line that is counted through all files to its file and the line there; 0 becomes
  // line 0 of the configuration itself.
  Place placeAt(int line) const;
  // Where a setting stands, for messages: "line 3", or with the file of conf.d "FILE:3".
  std::string placeText(const std::string& pointer) const;
  // Adds a finding; its line is counted through all files. Cost: O(files).
  void add(Finding finding);
  // Adds a finding that makes the file invalid.
  void addFinding(const std::string& pointer, std::string what);
  // Sorts the findings by file and line; to be called after the last add() or addFinding().
  void sortFindings();

 private:
  bool left_out_invalid_ = false;
};

// Reads settings from a JSON text. Relative paths in it are relative to `folder`. Never fails:
// syntax errors are findings.
LoadedSettings loadSettings(std::string_view json, const std::string& folder);

// Reads settings from a file and from conf.d/*.json in its folder (config/sources.h); a file that
// cannot be opened is a finding too (line 0). Relative paths in any of them are relative to the
// folder of `path`.
LoadedSettings loadSettingsFile(const std::string& path);

// The finding as one line, "demo.json:12: /wall/rate/rate_hz ..."; `file` is the configuration.
// Line breaks and terminal escape sequences in the file's name, keys or values are replaced.
std::string toText(const std::string& file, const Finding& finding);

}  // namespace merlin
