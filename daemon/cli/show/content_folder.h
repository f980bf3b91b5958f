// Accesses the content folder of a running wall (daemon/wall/shown_folder.h) from a client.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/base/result.h"

namespace merlin::cli {

struct ContentFolder {
  std::string path;
  std::uint64_t limit_bytes = 0;  // limit for the size of all files in it together
};

// Asks the wall for its content folder. Errors: those of askRole(); kUnsupported (the wall has no
// content folder; the text says why).
Result<ContentFolder> contentFolderOf(const std::string& instance);

// Returns whether the file or folder is directly in the content folder, so that it need not be
// copied there.
bool isIn(const ContentFolder& folder, const std::string& path);

// Checks that this user may write to the folder, and returns how many bytes are left of its limit.
// Cost: O(files in the folder). Errors: kIo (no permission; the text names the group and a remedy),
// kUnsupported (no space is left).
Result<std::uint64_t> roomIn(const ContentFolder& folder);

// Gives `made` (a file, or a folder that contains files only) to the group of the content folder,
// then moves it into the folder as `name`, in place of a former file or folder of that name.
// Readers see either the former or the complete new one; a former folder is missing for a moment.
// REQUIRES: `made` is in a work folder in the content folder. Errors: kIo.
Result<Ok> handOver(const std::string& made, const ContentFolder& folder, const std::string& name);

// Copies a file; shares its blocks if the file system supports that. `to` must not exist.
// `on_progress` may be empty. Errors: kNotFound, kIo, kMalformed (not a regular file).
Result<Ok> copyFile(const std::string& from, const std::string& to,
                    const std::function<void(double share)>& on_progress);

// Returns the size of a regular file, or of all regular files in a folder and its subfolders
// [bytes].
std::uint64_t sizeOfAll(const std::string& path);

}  // namespace merlin::cli
