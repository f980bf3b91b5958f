// Work in a process of its own, for libraries that end the program at input that they do not
// expect.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "daemon/base/result.h"

namespace merlin {

// Forks, runs `work` in the child and returns the bytes that it hands over. What the child prints
// is discarded. Errors: those of `work`; kMalformed with `ended` if the child is ended by a signal
// (an assertion, a bad access) or takes more CPU time than `limit`; kIo. Thread-safe; `work` must
// not take a lock that another thread of this process may hold.
Result<std::string> inChild(const std::function<Result<std::string>()>& work,
                            const std::string& ended, std::chrono::seconds limit);

}  // namespace merlin
