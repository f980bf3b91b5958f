// Writes a file that not everybody may read.
#pragma once

#include <string>
#include <string_view>

#include <sys/types.h>

#include "daemon/base/result.h"

namespace merlin {

// Like writeFile() (daemon/base/files.h), with these permissions, of which the process' umask takes
// away: at no moment may more people read the file.
Result<Ok> writeRestrictedFile(const std::string& path, std::string_view content, mode_t mode);

}  // namespace merlin
