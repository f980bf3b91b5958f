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

}  // namespace

Result<std::string> runDirectory(const std::string& wanted) {
  const std::string path = wanted.empty() ? usual() : wanted;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  struct stat status {};
  if (error || ::lstat(path.c_str(), &status) != 0) {
    return Error{Errc::kIo,
                 fmt::format("{}: {}", path, error ? error.message() : std::strerror(errno))};
  }
  // Somebody else's folder under our name in /tmp could hand us somebody else's sockets.
  if (S_ISLNK(status.st_mode) || (path.starts_with("/tmp/") && status.st_uid != ::geteuid())) {
    return Error{Errc::kIo, fmt::format("{}: belongs to somebody else; set run_directory", path)};
  }
  // A UNIX socket's name has 107 bytes at most.
  if (path.size() > 70)
    return Error{Errc::kIo, fmt::format("{}: is too long for sockets in it", path)};
  return path;
}

}  // namespace merlin::status
