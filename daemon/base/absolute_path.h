// The name of a file that means the same in any working directory.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace merlin {

// Without "." and ".."; links are kept. A relative name is taken from the working directory; an
// empty one stays empty.
inline std::string absolutePath(const std::string& path) {
  std::error_code error;
  return path.empty() ? "" : std::filesystem::absolute(path, error).lexically_normal().string();
}

}  // namespace merlin
