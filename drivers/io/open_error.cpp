#include "drivers/io/open_error.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>

namespace merlin::io {
namespace {

// Returns a hint such as " (its group is dialout: usermod -aG dialout USER)"; empty if this would
// not help.
std::string groupHint(const std::string& path, int error) {
  struct stat status {};
  if (error != EACCES || ::stat(path.c_str(), &status) != 0) return {};
  const group* owner = ::getgrgid(status.st_gid);
  return owner ? fmt::format(" (its group is {0}: usermod -aG {0} USER)", owner->gr_name) : "";
}

}  // namespace

Error openError(const std::string& path, int error) {
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("{}: {}{}", path, std::strerror(error), groupHint(path, error))};
}

}  // namespace merlin::io
