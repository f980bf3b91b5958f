// Explains to a person why a port's file cannot be opened.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::io {

// Returns the error of an open() of `path` that failed with the errno value `error`: kNotFound or
// kIo. If permission is missing, the message names the group to join.
Error openError(const std::string& path, int error);

}  // namespace merlin::io
