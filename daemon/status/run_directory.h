// Finds and creates the folder of a daemon's sockets and its emulators' pseudo-terminals.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::status {

// Returns `wanted` if it is not empty; otherwise the first that applies of $RUNTIME_DIRECTORY (set
// by systemd), /run/merlin (root), $XDG_RUNTIME_DIR/merlin, /tmp/merlin-UID. Creates the folder if
// it does not exist, with the permissions that the umask leaves. Errors: kIo, also if the name is
// too long for sockets or the path is a link, not a folder, writable for everybody (without the
// sticky bit), or belongs to another user. A folder that belongs to root is accepted. Root also
// accepts folders of other users, unless the parent folder is writable for everybody, such as /tmp.
Result<std::string> runDirectory(const std::string& wanted);

// Checks whether runDirectory(wanted) would accept the folder, by the length of its name and, if it
// exists, its owner and mode. Errors: kIo.
Result<Ok> checkRunDirectory(const std::string& wanted);

}  // namespace merlin::status
