#include "daemon/base/files.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "daemon/base/process_memory.h"
#include "daemon/base/restricted_file.h"
#include "daemon/base/unique_fd.h"

namespace merlin {
namespace {

Error fileError(const std::string& path, int error) {
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("{}: {}", path, std::strerror(error))};
}

bool writeAll(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

// Collects small writes and writes 1 MiB at a time.
class Buffered {
 public:
  explicit Buffered(int fd) : fd_(fd) { pending_.reserve(kSize); }

  bool write(std::span<const std::byte> bytes) {
    if (pending_.size() + bytes.size() > kSize && !flush()) return false;
    if (bytes.size() >= kSize) return writeAll(fd_, bytes);
    pending_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return true;
  }
  bool flush() {
    const bool done = writeAll(fd_, std::as_bytes(std::span(pending_)));
    pending_.clear();
    return done;
  }

 private:
  static constexpr std::size_t kSize = 1 << 20;
  int fd_;
  std::string pending_;
};

// Refuses a path that is not a regular file: the rename would replace a device, a pipe or a socket.
Result<Ok> checkReplaceable(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return Ok{};
  if (S_ISDIR(status.st_mode)) return fileError(path, EISDIR);
  return Error{Errc::kIo,
               path + ": is not a regular file and is not replaced; choose another name"};
}

FileStamp stampOf(const struct stat& s) {
  const auto ns = [](const timespec& t) {
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
  };
  return {s.st_dev, s.st_ino, static_cast<std::uint64_t>(s.st_size), ns(s.st_mtim), ns(s.st_ctim)};
}

// Whether `size` bytes leave a tenth of the available memory free; true if that is unknown.
bool fitsIntoMemory(std::size_t size) {
  const auto available = availableMemory();
  return !available || size < *available / 10 * 9;
}

// Reads from the beginning of the file until `to` is full or the file ends. Returns the number of
// bytes read; -1 on an error.
ssize_t readAll(int fd, std::span<std::byte> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t n = ::pread(fd, to.data() + done, to.size() - done, static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return -1;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return static_cast<ssize_t>(done);
}

}  // namespace

std::optional<FileStamp> fileStamp(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return stampOf(status);
}

std::optional<FileStamp> fileOrFolderStamp(const std::string& path) {
  struct stat status {};
  const bool there = ::stat(path.c_str(), &status) == 0;
  if (!there || !(S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))) return std::nullopt;
  return stampOf(status);
}

Result<FileCopy> FileCopy::read(const std::string& path, std::size_t most) {
  const UniqueFd fd(::open(
      path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // O_NONBLOCK: opening a pipe would block
  return fd.valid() ? read(fd.get(), path, most) : fileError(path, errno);
}

Result<FileCopy> FileCopy::read(int fd, const std::string& path, std::size_t most) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return fileError(path, errno);
  if (!S_ISREG(status.st_mode)) return Error{Errc::kMalformed, path + ": is not a regular file"};
  FileCopy copy;
  copy.stamp_ = stampOf(status);
  copy.size_ = std::min<std::size_t>(copy.stamp_.size, most);
  if (copy.size_ == 0) return copy;
  const Error too_large{Errc::kIo, fmt::format("{}: its {} bytes do not fit into this machine's "
                                               "memory",
                                               path, copy.size_)};
  if (!fitsIntoMemory(copy.size_)) return too_large;
  try {
    copy.bytes_ = HugeArray<std::byte>(copy.size_);
  } catch (const std::bad_alloc&) {
    return too_large;
  }
  const ssize_t n = readAll(fd, {copy.bytes_.data(), copy.size_});
  if (n < 0) return fileError(path, errno);
  if (static_cast<std::size_t>(n) != copy.size_ || ::fstat(fd, &status) != 0 ||
      stampOf(status).size != copy.stamp_.size ||
      stampOf(status).modified_ns != copy.stamp_.modified_ns) {
    return Error{Errc::kIo,
                 path + ": another program changed the file while it was read; try again"};
  }
  return copy;
}

Result<MappedFile> MappedFile::open(const std::string& path) {
  const UniqueFd fd(::open(
      path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // O_NONBLOCK: opening a pipe would block
  struct stat status {};
  if (!fd.valid() || ::fstat(fd.get(), &status) != 0) return fileError(path, errno);
  if (!S_ISREG(status.st_mode)) return Error{Errc::kMalformed, path + ": is not a regular file"};
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return MappedFile();
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd.get(), 0);
  if (data == MAP_FAILED && errno == ENOMEM)
    return Error{Errc::kNoMemory, fmt::format("{}: its {} bytes take more memory than this program "
                                              "may use (a limit such as ulimit -v)",
                                              path, size)};
  if (data == MAP_FAILED) return fileError(path, errno);
  return MappedFile(static_cast<const std::byte*>(data), size);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

MappedFile::~MappedFile() {
  if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

Result<Ok> writeFile(const std::string& path, const std::function<bool(const WriteBytes&)>& fill) {
  return writeFileHeadLast(path, 0, fill, [] { return std::span<const std::byte>(); });
}

namespace {

constexpr mode_t kUsualMode = 0666;  // before the process's umask is applied

std::string folderOf(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

// A new file that replaces `path` once it is complete. If the file system supports O_TMPFILE, the
// file has no name until then, so that a killed process leaves nothing behind.
class FreshFile {
 public:
  FreshFile(const std::string& path, mode_t mode)
      : path_(path), named_(fmt::format("{}.{}.tmp", path, ::getpid())) {
    removeLeftOvers();
    fd_.reset(::open(folderOf(path).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, mode));
    if (fd_.valid()) return;
    fd_.reset(::open(named_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
    has_name_ = fd_.valid();
  }
  ~FreshFile() {
    if (has_name_) ::unlink(named_.c_str());
  }
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;

  int fd() const noexcept { return fd_.get(); }

  // Syncs the file to the disk and renames it to `path`. Returns false with errno set on failure.
  bool replace() {
    if (::fsync(fd_.get()) != 0) return false;
    const std::string self = fmt::format("/proc/self/fd/{}", fd_.get());
    if (!has_name_ &&
        ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, named_.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return false;
    has_name_ = true;
    if (std::rename(named_.c_str(), path_.c_str()) != 0) return false;
    has_name_ = false;
    return true;
  }

 private:
  // Removes temporary files beside `path` that killed processes, or this one, have left.
  void removeLeftOvers() const {
    std::error_code error;
    const std::string start = std::filesystem::path(path_).filename().string() + ".";
    for (const auto& entry : std::filesystem::directory_iterator(folderOf(path_), error)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with(start) || !name.ends_with(".tmp")) continue;
      const std::string number = name.substr(start.size(), name.size() - start.size() - 4);
      int pid = 0;
      const auto [end, wrong] = std::from_chars(number.data(), number.data() + number.size(), pid);
      if (wrong != std::errc{} || end != number.data() + number.size() || pid <= 0) continue;
      const bool dead = ::kill(pid, 0) != 0 && errno == ESRCH;
      if (dead || pid == ::getpid()) ::unlink(entry.path().c_str());
    }
  }

  std::string path_, named_;
  UniqueFd fd_;
  bool has_name_ = false;
};

}  // namespace

Result<Ok> writeFileHeadLast(const std::string& path, std::size_t head_size,
                             const std::function<bool(const WriteBytes&)>& fill,
                             const std::function<std::span<const std::byte>()>& head) {
  if (auto replaceable = checkReplaceable(path); !replaceable) return replaceable;
  FreshFile fresh(path, kUsualMode);
  if (fresh.fd() < 0) return fileError(path, errno);
  Buffered buffer(fresh.fd());
  const auto seek = [&](std::size_t at) {
    return ::lseek(fresh.fd(), static_cast<off_t>(at), SEEK_SET) >= 0;
  };
  const bool written =
      seek(head_size) &&
      fill([&](std::span<const std::byte> bytes) { return buffer.write(bytes); }) &&
      buffer.flush() && seek(0) && writeAll(fresh.fd(), head()) && fresh.replace();
  return written ? Result<Ok>(Ok{}) : fileError(path, errno);
}

Result<Ok> writeRestrictedFile(const std::string& path, std::string_view content, mode_t mode) {
  if (auto replaceable = checkReplaceable(path); !replaceable) return replaceable;
  FreshFile fresh(path, mode);
  if (fresh.fd() < 0) return fileError(path, errno);
  const bool written =
      writeAll(fresh.fd(), std::as_bytes(std::span(content.data(), content.size()))) &&
      fresh.replace();
  return written ? Result<Ok>(Ok{}) : fileError(path, errno);
}

Result<Ok> checkWritableFolder(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return fileError(path, errno);
  if (!S_ISDIR(status.st_mode)) return fileError(path, ENOTDIR);
  if (::access(path.c_str(), W_OK | X_OK) != 0) return fileError(path, errno);
  return Ok{};
}

Result<Ok> checkFolder(const std::string& path) {
  struct stat status {};
  std::filesystem::path there = path;
  while (::lstat(there.c_str(), &status) != 0 && errno == ENOENT && there.has_relative_path()) {
    if (!there.has_filename()) there = there.parent_path();  // "folder/"
    there = there.parent_path();
    if (there.empty()) there = ".";
  }
  return checkWritableFolder(there.string());
}

Result<Ok> checkWritable(const std::string& path) {
  const std::string folder = folderOf(path);
  if (auto replaceable = checkReplaceable(path); !replaceable) return replaceable;
  if (::access(folder.c_str(), W_OK) != 0) return fileError(path, errno);
  return Ok{};
}

Result<Ok> checkWritable(std::initializer_list<std::string> paths) {
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    if (auto writable = checkWritable(path); !writable) return writable;
  }
  return Ok{};
}

Result<Ok> writeFile(const std::string& path, std::string_view content) {
  return writeFile(path, [&](const WriteBytes& write) {
    return write(std::as_bytes(std::span(content.data(), content.size())));
  });
}

}  // namespace merlin
