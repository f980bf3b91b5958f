#include "daemon/cli/allowed.h"

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

namespace merlin::cli {
namespace {

// NOLINTBEGIN(concurrency-mt-unsafe): merlin asks on one thread
std::string groupNamed(gid_t id) {
  const group* const found = ::getgrgid(id);
  return found ? found->gr_name : std::to_string(id);
}

std::string userNamed(uid_t id) {
  const passwd* const found = ::getpwuid(id);
  return found ? found->pw_name : std::to_string(id);
}
// NOLINTEND(concurrency-mt-unsafe)

}  // namespace

Result<Ok> checkAllowed(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return Ok{};
  const int how = S_ISDIR(status.st_mode) ? R_OK | W_OK | X_OK : W_OK;
  if (::faccessat(AT_FDCWD, path.c_str(), how, AT_EACCESS) == 0 || errno != EACCES) return Ok{};
  return Error{Errc::kIo,
               fmt::format("{0}: user {2} may not write to it; it is for the group {1}: join it "
                           "(sudo usermod -aG {1} {2}) and log in again",
                           path, groupNamed(status.st_gid), userNamed(::geteuid()))};
}

}  // namespace merlin::cli
