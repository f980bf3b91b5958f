// Writes a file that not everybody may read.
#pragma once

#include <string>
#include <string_view>

#include <sys/types.h>

#include "daemon/base/result.h"

namespace merlin {

// Writes a file like writeFile() (daemon/base/files.h), with the permissions `mode` less the
// process's umask. The file has these permissions from its creation, so nobody else can read it
// while it is written. Errors: those of writeFile().
Result<Ok> writeRestrictedFile(const std::string& path, std::string_view content, mode_t mode);

}  // namespace merlin
