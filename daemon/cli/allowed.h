// Whether this user may use what belongs to merlind's group: its sockets, its content folder.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::cli {

// Checks that this user may write to the file or socket, or into the folder. A missing file is no
// error here. Errors: kIo, with the group that may write and how to join it.
Result<Ok> checkAllowed(const std::string& path);

}  // namespace merlin::cli
