// Checks whether this user may use the files of merlind's group: its sockets and its content
// folder.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::cli {

// Checks that this user may write to the file or socket, or into the folder. A missing file is not
// an error here. Errors: kIo (no permission); the text names the group that may write and how to
// join it.
Result<Ok> checkAllowed(const std::string& path);

}  // namespace merlin::cli
