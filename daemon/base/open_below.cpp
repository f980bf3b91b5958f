#include "daemon/base/open_below.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/base/printable_text.h"

namespace merlin {
namespace {

constexpr int kAsItIs = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY;

// For a link, O_NOFOLLOW gives ELOOP, or ENOTDIR together with O_DIRECTORY.
Error failedAt(const std::string& path, int error) {
  if (error == ELOOP)
    return {Errc::kMalformed, path + ": is a link, and links are not followed here"};
  if (error == ENOTDIR)
    return {Errc::kMalformed, path + ": is not a folder (links are not followed here)"};
  // ENXIO: the path is a socket, or a device that is not present.
  if (error == ENXIO) return {Errc::kMalformed, path + ": is not a regular file"};
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("{}: {}", path, std::strerror(error))};
}

// Opens the last of the names with `last_flags`, the others as folders.
Result<UniqueFd> walk(const std::string& folder, std::string_view names, int last_flags) {
  UniqueFd at(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!at.valid()) return failedAt(folder, errno);
  std::string path = folder;
  for (bool last = false; !last;) {
    const std::size_t slash = names.find('/');
    last = slash == std::string_view::npos;
    const std::string name(names.substr(0, slash));
    if (!isPlainName(name)) {
      return Error{Errc::kInvalidArgument,
                   fmt::format("\"{}\" is not a plain file name: 1 to 200 bytes of text without "
                               "'/' and without a dot at the beginning",
                               excerpt(name))};
    }
    path += "/" + name;
    const int flags = last ? last_flags : kAsItIs | O_DIRECTORY;
    UniqueFd next(::openat(at.get(), name.c_str(), flags));
    if (!next.valid()) return failedAt(path, errno);
    at = std::move(next);
    if (!last) names.remove_prefix(slash + 1);
  }
  return at;
}

}  // namespace

bool isPlainName(std::string_view name) noexcept {
  return !name.empty() && name.size() <= 200 && name.front() != '.' &&
         name.find('/') == std::string_view::npos && isText(name);
}

Result<UniqueFd> openBelow(const std::string& folder, std::string_view name) {
  auto file = walk(folder, name, kAsItIs);
  if (!file) return file;
  struct stat status {};
  if (::fstat(file->get(), &status) == 0 && S_ISREG(status.st_mode)) return file;
  return Error{Errc::kMalformed, fmt::format("{}/{}: is not a regular file", folder, name)};
}

Result<UniqueFd> openFolderBelow(const std::string& folder, std::string_view name) {
  return walk(folder, name, kAsItIs | O_DIRECTORY);
}

}  // namespace merlin
