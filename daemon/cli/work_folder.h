// WorkFolder: a temporary folder in which a result is made before it is moved to its place.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/result.h"

namespace merlin::cli {

// The destructor removes the folder and its files. Thread-bound.
class WorkFolder {
 public:
  // Makes a folder with a new name in the folder of `result`. If that folder is writable for its
  // group but not for everybody, the group may also remove what a killed process has left behind.
  // Errors: kIo.
  static Result<WorkFolder> make(const std::filesystem::path& result) {
    const auto folder = std::filesystem::absolute(result).parent_path();
    std::string name = (folder / ".merlin-import-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      return Error{Errc::kIo, fmt::format("{}: {}", name, std::strerror(errno))};
    struct stat shared {};
    if (::stat(folder.c_str(), &shared) == 0 && (shared.st_mode & (S_IWGRP | S_IWOTH)) == S_IWGRP &&
        ::chown(name.c_str(), static_cast<uid_t>(-1), shared.st_gid) == 0)
      ::chmod(name.c_str(), 0770);
    return WorkFolder(std::move(name));
  }
  ~WorkFolder() {
    std::error_code error;
    if (!path_.empty()) std::filesystem::remove_all(path_, error);
  }
  WorkFolder(WorkFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::string& path() const noexcept { return path_; }

 private:
  explicit WorkFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace merlin::cli
