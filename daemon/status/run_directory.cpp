#include "daemon/status/run_directory.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace merlin::status {
namespace {

std::string usual() {
  // NOLINTBEGIN(concurrency-mt-unsafe): read once, at the start
  if (const char* given = std::getenv("RUNTIME_DIRECTORY"); given && *given) return given;
  if (::geteuid() == 0) return "/run/merlin";
  if (const char* own = std::getenv("XDG_RUNTIME_DIR"); own && *own)
    return fmt::format("{}/merlin", own);
  // NOLINTEND(concurrency-mt-unsafe)
  return fmt::format("/tmp/merlin-{}", ::geteuid());
}

bool everybodyWritesTo(const std::string& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 && (status.st_mode & S_IWOTH) != 0;
}

std::string parentOf(const std::string& path) {
  return std::filesystem::path(path + "/..").lexically_normal().string();
}

}  // namespace

Result<Ok> checkRunDirectory(const std::string& wanted) {
  std::string path = wanted.empty() ? usual() : wanted;
  // The path of a UNIX socket has at most 107 bytes.
  if (path.size() > 70)
    return Error{Errc::kIo,
                 fmt::format("{}: the name is too long for sockets in this folder", path)};
  while (path.size() > 1 && path.back() == '/') path.pop_back();  // lstat() would follow a link
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return Ok{};
  const bool link = S_ISLNK(status.st_mode);
  // Anyone who can write to the folder could replace our sockets. Root may check the folder of a
  // service for the user that it will run as, so it accepts another user's folder; but not in a
  // folder where everybody can create folders, since no service's folder is there.
  const bool foreign = status.st_uid != ::geteuid() && status.st_uid != 0;
  const bool others = foreign && (::geteuid() != 0 || everybodyWritesTo(parentOf(path)));
  const bool anybody = (status.st_mode & S_IWOTH) != 0 && (status.st_mode & S_ISVTX) == 0;
  if (!link && !others && !anybody && S_ISDIR(status.st_mode)) return Ok{};
  return Error{Errc::kIo, fmt::format("{}: {}; set run_directory to a folder of this user", path,
                                      link      ? "is a link"
                                      : others  ? "belongs to another user"
                                      : anybody ? "can be written to by every user"
                                                : "is not a folder")};
}

Result<std::string> runDirectory(const std::string& wanted) {
  if (const auto good = checkRunDirectory(wanted); !good) return good.error();
  const std::string path = wanted.empty() ? usual() : wanted;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", path, error.message())};
  if (const auto good = checkRunDirectory(wanted); !good) return good.error();
  return path;
}

}  // namespace merlin::status
