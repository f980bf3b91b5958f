// WorkFolder: a folder beside a result that is not complete yet.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/result.h"

namespace merlin::cli {

// Its files go with this object. Thread-bound.
class WorkFolder {
 public:
  // Makes a folder of a new name where `result` lies or will lie. Errors: kIo.
  static Result<WorkFolder> make(const std::filesystem::path& result) {
    const auto folder = std::filesystem::absolute(result).parent_path();
    std::string name = (folder / ".merlin-import-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      return Error{Errc::kIo, fmt::format("{}: {}", name, std::strerror(errno))};
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
