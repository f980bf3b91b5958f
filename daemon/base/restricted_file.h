// Writes a file that not everybody may read.
#pragma once

#include <string>
#include <string_view>

#include <sys/types.h>

#include "daemon/base/result.h"

namespace merlin {

// Like writeFile() (daemon/base/files.h), with the permissions `mode` less the process' umask; also
// while it is being written, nobody else can read the file.
Result<Ok> writeRestrictedFile(const std::string& path, std::string_view content, mode_t mode);

}  // namespace merlin
