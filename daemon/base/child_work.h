// Runs a function in a child process, for libraries that abort the process on malformed input.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "daemon/base/result.h"

namespace merlin {

// Forks, calls `work` in the child and returns the bytes that `work` returned. The child's output
// is discarded. Errors: those of `work`; kMalformed with the text `ended` if a signal ends the
// child (an assertion, a bad access) or it takes more CPU time than `limit`; kIo (no pipe or
// process can be made). Thread-safe; `work` must not take a lock that another thread of this
// process may hold.
Result<std::string> inChild(const std::function<Result<std::string>()>& work,
                            const std::string& ended, std::chrono::seconds limit);

}  // namespace merlin
