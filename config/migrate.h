// Migrations: a configuration of an earlier version becomes one of this version.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin {

// A setting that an earlier version had elsewhere, or in another form.
struct MovedSetting {
  const char* pointer;  // where it was, as a JSON pointer
  const char* now;      // what stands in its place, as part of a sentence
};

// Null where no earlier version had it. Reentrant.
const MovedSetting* findMoved(std::string_view pointer);

struct Migration {
  std::string text;                  // the file in the form of this version
  std::vector<std::string> changes;  // a sentence each; empty: it was in this form already
};

// Rewrites what earlier versions had in another form, and keeps all else as it is, in its order.
// Errors: kMalformed (not a JSON object; with the line), kInvalidArgument (it has both forms of a
// setting).
Result<Migration> migrate(std::string_view json);

}  // namespace merlin
