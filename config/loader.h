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

  // More are counted only: a file of 1 MiB can have hundreds of thousands.
  static constexpr std::size_t kMostFindings = 200;

  Settings settings;                 // meaningful unless invalid
  std::vector<Finding> findings;     // the first ones, in the order of the file's lines
  std::size_t left_out = 0;          // findings beyond those
  std::map<std::string, int> lines;  // of each setting that the file has, by pointer

  Verdict verdict() const;
  // Where a setting stands; one that the file does not have, where the nearest group around it
  // does.
  int lineOf(const std::string& pointer) const;
  // One finding more. Cost: bounded, whatever there are already.
  void add(Finding finding);
  // One that makes the file invalid.
  void wrong(const std::string& pointer, std::string what);
  // To be called after the last of these, for the order by lines.
  void sortFindings();

 private:
  bool left_out_invalid_ = false;
};

// Reads a text. Relative paths in it are taken from `folder`. Never fails: syntax errors are
// findings.
LoadedSettings loadSettings(std::string_view json, const std::string& folder);

// Reads a file; what cannot be opened is a finding too (line 0).
LoadedSettings loadSettingsFile(const std::string& path);

// "demo.json:12: /wall/rate/rate_hz ...": one line, without what a terminal would follow, whatever
// the file's name and its keys and values have in them.
std::string toText(const std::string& file, const Finding& finding);

}  // namespace merlin
