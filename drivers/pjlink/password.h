// Reads the password of a projector from its file.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::pjlink {

// Returns the first line of the file, 1 to 64 printable ASCII characters; empty if `path` is empty.
// Errors: kNotFound, kIo, kMalformed; the messages name the file, but never its content.
Result<std::string> readPassword(const std::string& path);

}  // namespace merlin::pjlink
