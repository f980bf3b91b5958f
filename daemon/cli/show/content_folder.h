// The content folder of a running wall (daemon/wall/shown_folder.h), as a client uses it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/base/result.h"

namespace merlin::cli {

struct ContentFolder {
  std::string path;
  std::uint64_t limit_bytes = 0;  // of all files in it together
};

// Asks the wall for its content folder. Errors: those of askRole(); kUnsupported (the wall has no
// content folder, and why).
Result<ContentFolder> contentFolderOf(const std::string& instance);

// Whether the path lies directly in the folder, so that it need not be copied there.
bool isIn(const ContentFolder& folder, const std::string& path);

// Checks that this user may put files there, and returns the free space in bytes. O(files in the
// folder). Errors: kIo, with the folder, its group and a remedy; kUnsupported (full).
Result<std::uint64_t> roomIn(const ContentFolder& folder);

// Gives `made` (a file, or a folder that contains files only) to the group of the content folder,
// then moves it there under `name`, where it replaces what had that name. Readers see either the
// old one or the complete new one. REQUIRES: `made` is in a work folder in the content folder.
// Errors: kIo.
Result<Ok> handOver(const std::string& made, const ContentFolder& folder, const std::string& name);

// Copies a file, by sharing its blocks where the file system can. `on_progress` may be empty.
// Errors: kNotFound, kIo, kMalformed (not a regular file).
Result<Ok> copyFile(const std::string& from, const std::string& to,
                    const std::function<void(double share)>& on_progress);

// Size of a file, or of the files in a folder [bytes].
std::uint64_t sizeOfAll(const std::string& path);

}  // namespace merlin::cli
