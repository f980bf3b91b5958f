// Makes the name of a file independent of the working directory.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace merlin {

// Returns the absolute path without "." and ".."; symbolic links are not resolved. A relative
// `path` is taken from the working directory; an empty one stays empty.
inline std::string absolutePath(const std::string& path) {
  std::error_code error;
  return path.empty() ? "" : std::filesystem::absolute(path, error).lexically_normal().string();
}

}  // namespace merlin
