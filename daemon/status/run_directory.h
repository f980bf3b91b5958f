// The folder of a daemon's sockets and emulators' pseudo-terminals.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::status {

// Returns `wanted` if it is not empty; otherwise the first that applies of $RUNTIME_DIRECTORY (set
// by systemd), /run/merlin (root), $XDG_RUNTIME_DIR/merlin, /tmp/merlin-UID. Creates the folder,
// mode 0755, if it does not exist. Errors: kIo; also if the folder is a link, is writable for
// everybody, or belongs to another user. A folder of root's is accepted; root accepts any user's,
// unless it is in a folder that everybody can write to, such as /tmp.
Result<std::string> runDirectory(const std::string& wanted);

// Checks whether runDirectory(wanted) would accept the folder, by the length of its name and, if it
// exists, its owner and mode. Errors: kIo.
Result<Ok> checkRunDirectory(const std::string& wanted);

}  // namespace merlin::status
