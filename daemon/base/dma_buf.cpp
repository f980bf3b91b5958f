#include "daemon/base/dma_buf.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

namespace merlin {

std::string deviceFolder(dev_t node) {
  std::error_code error;
  const auto folder = std::filesystem::canonical(
      fmt::format("/sys/dev/char/{}:{}/device", major(node), minor(node)), error);
  return error ? std::string() : folder.string();
}

std::string deviceFolder(const std::string& path) {
  struct stat node {};
  if (::stat(path.c_str(), &node) != 0 || !S_ISCHR(node.st_mode)) return {};
  return deviceFolder(node.st_rdev);
}

}  // namespace merlin
