// Writes the manual page of configuration files, merlin.json(5).
#pragma once

#include <string>

namespace merlin {

// Returns the page in the macros of man(7): every setting with its type, range, default and
// meaning, in the order of describe(). `version`: the version of MERLIN, printed at the foot of the
// page.
std::string settingsManual(const std::string& version);

}  // namespace merlin
