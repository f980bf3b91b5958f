// Where a daemon keeps its sockets and emulators' lines.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::status {

// `wanted` if not empty; else $RUNTIME_DIRECTORY (systemd's), /run/merlin for root,
// $XDG_RUNTIME_DIR/merlin, /tmp/merlin-UID. Made if it is not there, mode 0755. Errors: kIo; also
// where it is another user's (root's is taken; by root any, but not in
// a folder that is everybody's to write to, as /tmp is), a link, or everybody's to write to.
Result<std::string> runDirectory(const std::string& wanted);

// Whether runDirectory() would take it, where it is there: its owner, its mode, its length.
// `wanted` as there. Errors: kIo.
Result<Ok> checkRunDirectory(const std::string& wanted);

}  // namespace merlin::status
