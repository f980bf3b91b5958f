#include "daemon/base/shared_memory.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

namespace merlin {
namespace {

constexpr mode_t kMode = 0644;  // the umask of the service may narrow it

Error shmError(const std::string& name, const char* step, int error) {
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("shared memory {}: {}: {}", name, step, std::strerror(error))};
}

// An open-file-description lock: asking about it (isLocked) does not take it, so that a reader can
// never be in an owner's way.
struct flock wholeFile(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}
bool lock(int fd) {
  struct flock exclusive = wholeFile(F_WRLCK);
  return ::fcntl(fd, F_OFD_SETLK, &exclusive) == 0;
}
bool isLocked(int fd) {
  struct flock probe = wholeFile(F_RDLCK);
  return ::fcntl(fd, F_OFD_GETLK, &probe) == 0 && probe.l_type != F_UNLCK;
}

// Whether `fd` is still what the name stands for: a stale object may be replaced under our feet.
bool isCurrent(int fd, const std::string& name) {
  const UniqueFd again(::shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat mine {
  }, named{};
  return again.valid() && ::fstat(fd, &mine) == 0 && ::fstat(again.get(), &named) == 0 &&
         mine.st_ino == named.st_ino;
}

// A fresh object under the name, locked; what is found there unlocked is left over and goes.
Result<UniqueFd> claim(const std::string& name) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    UniqueFd fd(::shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kMode));
    if (fd.valid()) {
      if (lock(fd.get()) && isCurrent(fd.get(), name)) return fd;
      continue;  // somebody took it for left over before we had locked it
    }
    if (errno != EEXIST) return shmError(name, "open", errno);
    const UniqueFd found(::shm_open(name.c_str(), O_RDWR | O_CLOEXEC, kMode));
    if (!found.valid() && errno == ENOENT) continue;
    if (!found.valid()) return shmError(name, "open", errno);
    if (!lock(found.get())) {
      return Error{Errc::kBusy, fmt::format("shared memory {}: another merlind owns it", name)};
    }
    if (isCurrent(found.get(), name)) ::shm_unlink(name.c_str());
  }
  return Error{Errc::kBusy, fmt::format("shared memory {}: others keep taking it", name)};
}

}  // namespace

Result<SharedMemory> SharedMemory::create(const std::string& name, std::size_t size) {
  auto fd = claim(name);
  if (!fd) return fd.error();
  // Not ftruncate: on tmpfs that succeeds beyond its size, and a write faults later.
  if (const int error = ::posix_fallocate(fd->get(), 0, static_cast<off_t>(size)); error != 0) {
    ::shm_unlink(name.c_str());
    return shmError(name, fmt::format("{} bytes", size).c_str(), error);
  }
  void* data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd->get(), 0);
  if (data == MAP_FAILED) {
    const int error = errno;
    ::shm_unlink(name.c_str());
    return shmError(name, "map", error);
  }
  return SharedMemory(*std::move(fd), static_cast<std::byte*>(data), size, name);
}

Result<SharedMemory> SharedMemory::open(const std::string& name) {
  UniqueFd fd(::shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat status {};
  if (!fd.valid() || ::fstat(fd.get(), &status) != 0) return shmError(name, "open", errno);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return Error{Errc::kMalformed, fmt::format("shared memory {}: is empty", name)};
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd.get(), 0);
  if (data == MAP_FAILED) return shmError(name, "map", errno);
  return SharedMemory(std::move(fd), static_cast<std::byte*>(data), size, {});
}

bool SharedMemory::owned(const std::string& name) {
  const UniqueFd fd(::shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  return fd.valid() && isLocked(fd.get());
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : fd_(std::move(other.fd_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      owned_name_(std::exchange(other.owned_name_, {})) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(owned_name_, other.owned_name_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (data_) ::munmap(data_, size_);
  if (!owned_name_.empty()) ::shm_unlink(owned_name_.c_str());
}

}  // namespace merlin
