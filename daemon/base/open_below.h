// Safely opens a file in a folder that other users may write to.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

// Whether `name` is plain, that is, allowed in such a folder: 1 to 200 bytes of text, no '/', no
// dot at the beginning.
bool isPlainName(std::string_view name) noexcept;

// Opens `name`, a plain name or several with '/' between them, below `folder` for reading. No link
// is followed below the folder, and nothing blocks. Errors, with the file's path: kInvalidArgument
// (a name that is not plain), kNotFound, kIo, kMalformed (a link, or not a regular file).
Result<UniqueFd> openBelow(const std::string& folder, std::string_view name);

// Opens a folder like openBelow(). Errors: those of openBelow(), where kMalformed means a link, or
// not a folder.
Result<UniqueFd> openFolderBelow(const std::string& folder, std::string_view name);

}  // namespace merlin
