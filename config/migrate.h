// Migration: converts a configuration file of an earlier version to the form of this version.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin {

// A setting that an earlier version had at another pointer, or in another form.
struct MovedSetting {
  const char* pointer;  // JSON pointer of the setting in the earlier version
  const char* now;      // its replacement in this version, as a clause for messages
};

// Returns the entry of the setting that an earlier version had at this JSON pointer and that this
// version has elsewhere or in another form; null if there is no such setting. Reentrant.
const MovedSetting* findMoved(std::string_view pointer);

struct Migration {
  std::string text;                  // the configuration in the form of this version
  std::vector<std::string> changes;  // one sentence per change; empty: no change was necessary
};

// Rewrites the settings that earlier versions had elsewhere or in another form; all other settings
// and their order are kept. Errors: kMalformed (not a JSON object; with the line), kInvalidArgument
// (the file contains a setting both in its old and in its new form, or a group is not an object).
Result<Migration> migrate(std::string_view json);

}  // namespace merlin
