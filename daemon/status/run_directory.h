// Where a daemon keeps its sockets and emulators' lines.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::status {

// `wanted` if not empty; else $RUNTIME_DIRECTORY (systemd's), /run/merlin for root,
// $XDG_RUNTIME_DIR/merlin, /tmp/merlin-UID. Made if it is not there, mode 0755; one in /tmp has to
// be ours. Errors: kIo.
Result<std::string> runDirectory(const std::string& wanted);

}  // namespace merlin::status
