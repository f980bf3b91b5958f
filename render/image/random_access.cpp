#include "render/image/random_access.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace merlin::render::image {
namespace {

std::int64_t nanoseconds(const timespec& t) {
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

Result<std::unique_ptr<FileAccess>> FileAccess::open(const std::string& path) {
  return of(UniqueFd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)), path);
}

Result<std::unique_ptr<FileAccess>> FileAccess::of(UniqueFd file, const std::string& path) {
  struct stat s {};
  if (!file.valid() || ::fstat(file.get(), &s) != 0) {
    return Error{errno == ENOENT ? Errc::kNotFound : Errc::kIo,
                 fmt::format("{}: {}", path, std::strerror(errno))};
  }
  if (!S_ISREG(s.st_mode)) return Error{Errc::kMalformed, path + ": is not a regular file"};
  const FileStamp stamp{s.st_dev, s.st_ino, static_cast<std::uint64_t>(s.st_size),
                        nanoseconds(s.st_mtim), nanoseconds(s.st_ctim)};
  return std::unique_ptr<FileAccess>(new FileAccess(std::move(file), stamp));
}

Result<Ok> FileAccess::read(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  const std::size_t wanted = bytes.size();
  for (auto at = static_cast<off_t>(offset); !bytes.empty();) {
    const ssize_t n = ::pread(file_.get(), bytes.data(), bytes.size(), at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return Error{Errc::kIo, fmt::format("at byte {}: {}", offset, std::strerror(errno))};
    if (n == 0) {
      return Error{Errc::kMalformed,
                   fmt::format("at byte {}: {} bytes were expected, and {} are there", offset,
                               wanted, wanted - bytes.size())};
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += n;
  }
  return Ok{};
}

}  // namespace merlin::render::image
