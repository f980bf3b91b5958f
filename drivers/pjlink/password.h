// The password of a projector, which stands in a file of its own.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::pjlink {

// The first line of the file, 1 to 64 printable ASCII characters; empty if `path` is. Errors name
// the file and never its content: kNotFound, kIo, kMalformed.
Result<std::string> readPassword(const std::string& path);

}  // namespace merlin::pjlink
