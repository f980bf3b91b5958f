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
  // True: a number was clamped into its range, or the finding is only a warning. False: the file is
  // invalid.
  bool adjusted = false;
  // Line in `file`; 0: unknown. In the argument of LoadedSettings::add(), if `file` is empty, the
  // line is counted through all files.
  int line = 0;
  std::string pointer;  // RFC 6901, "/wall/rate/rate_hz"
  // The rest of the sentence after the pointer, "is 900; allowed is 1 to 240".
  std::string what;
  bool quotes = false;    // `what` quotes text of the file, which may contain a secret
  std::string file = {};  // the file of conf.d; empty: the configuration itself
};

struct LoadedSettings {
  enum class Verdict { kValid, kAdjusted, kInvalid };

  // Maximum number of findings that are kept; further ones are only counted, because a file of 1
  // MiB can have hundreds of thousands.
  static constexpr std::size_t kMostFindings = 200;

  // A file that was read: the configuration, whose name is empty here, or a file of conf.d. Its
  // lines are counted through all files, in the order in which they are merged.
  struct Source {
    std::string file;
    int lines_before = 0, last_line = 0;
  };
  struct Place {
    std::string file;  // empty: the configuration itself
    int line = 0;      // line in `file`
  };

  Settings settings;              // meaningful unless the verdict is kInvalid
  std::vector<Finding> findings;  // at most kMostFindings, sorted by file and line
  std::size_t left_out = 0;       // number of further findings, not kept
  // Line of each setting that a file contains, by JSON pointer. Lines are counted through all
  // files; placeAt() converts them.
  std::map<std::string, int> lines;
  std::vector<Source> sources;
  // False: a file could not be read or parsed (see findings); settings are the defaults.
  bool parsed = false;

  Verdict verdict() const;
  // Returns the line of a setting, counted through all files. If no file contains the setting,
  // returns the line of the innermost enclosing group that a file contains, or 0 if there is none.
  int lineOf(const std::string& pointer) const;
  // Converts a line that is counted through all files to its file and the line there; 0 becomes
  // line 0 of the configuration itself.
  Place placeAt(int line) const;
  // Returns the place of a setting, for messages: "line 3", or "FILE:3" in a file of conf.d.
  std::string placeText(const std::string& pointer) const;
  // Adds a finding. If its `file` is empty, its line is taken to be counted through all files, and
  // both are converted to the file and the line there. Cost: O(files).
  void add(Finding finding);
  // Adds a finding about the setting at `pointer` that makes the configuration invalid.
  void addFinding(const std::string& pointer, std::string what);
  // Sorts the findings by file and line; to be called after the last add() or addFinding().
  void sortFindings();

 private:
  bool left_out_invalid_ = false;
};

// Reads settings from a JSON text. Relative paths in the text are relative to `folder`. Never
// fails; syntax errors become findings.
LoadedSettings loadSettings(std::string_view json, const std::string& folder);

// Reads settings from a file and from conf.d/*.json in its folder (config/sources.h); a file that
// cannot be opened causes a finding (line 0). Relative paths in all these files are relative to the
// folder of `path`.
LoadedSettings loadSettingsFile(const std::string& path);

// Returns the finding as one line, "demo.json:12: /wall/rate/rate_hz ...". `file`: name of the
// configuration, used if the finding is not in a file of conf.d. Line breaks and terminal escape
// sequences in the file's name, keys or values are replaced.
std::string toText(const std::string& file, const Finding& finding);

}  // namespace merlin
