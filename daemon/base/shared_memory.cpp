#include "daemon/base/shared_memory.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/stat.h>

namespace merlin {
namespace {

constexpr mode_t kMode = 0644;      // the umask of the service may narrow it
constexpr mode_t kLockMode = 0600;  // no other user can hold the lock

Error shmError(const std::string& name, const char* step, int error) {
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("shared memory {}: {}: {}", name, step, std::strerror(error))};
}

std::string lockName(const std::string& name) { return name + ".lock"; }

// Describes an open-file-description write lock on the whole file, which needs a descriptor that is
// open for writing.
struct flock wholeFile() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}
bool takeLock(int fd) {
  struct flock exclusive = wholeFile();
  return ::fcntl(fd, F_OFD_SETLK, &exclusive) == 0;
}

// Whether the name still refers to `fd`'s object: it may have been removed or replaced.
bool isCurrent(int fd, const std::string& name) {
  const UniqueFd again(::shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat mine {
  }, named{};
  return again.valid() && ::fstat(fd, &mine) == 0 && ::fstat(again.get(), &named) == 0 &&
         mine.st_ino == named.st_ino;
}

std::string userName(uid_t user) {
  passwd entry{};
  passwd* found = nullptr;
  char buffer[1024];
  ::getpwuid_r(user, &entry, buffer, sizeof buffer, &found);
  return found ? found->pw_name : fmt::format("number {}", user);
}

// Removes the object of this name if there is one. Only root can remove an object of another user.
Result<Ok> removeObject(const std::string& name) {
  if (::shm_unlink(name.c_str()) == 0 || errno == ENOENT) return Ok{};
  const int error = errno;
  struct stat status {};
  const std::string path = "/dev/shm" + name;
  if (::lstat(path.c_str(), &status) == 0 && status.st_uid != ::geteuid()) {
    return Error{Errc::kIo,
                 fmt::format("{} belongs to user {} and cannot be replaced; remove it as root, or "
                             "set another \"instance\"",
                             path, userName(status.st_uid))};
  }
  return shmError(name, "remove", error);
}

// Creates the lock object of the name if it is missing, and locks it. Replaces a lock object of
// another user if permitted. Errors: kBusy (another process holds the lock), kIo.
Result<UniqueFd> claim(const std::string& name) {
  const std::string lock = lockName(name);
  for (int attempt = 0; attempt < 100; ++attempt) {
    UniqueFd fd(::shm_open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kLockMode));
    struct stat status {};
    const bool ours = fd.valid() && ::fstat(fd.get(), &status) == 0 && status.st_uid == ::geteuid();
    if (!ours) {
      if (const auto removed = removeObject(lock); !removed) return removed.error();
      continue;
    }
    if (!takeLock(fd.get()))
      return Error{Errc::kBusy, fmt::format("shared memory {}: another merlind owns it", name)};
    if (isCurrent(fd.get(), lock)) return fd;
  }
  return Error{Errc::kBusy,
               fmt::format("shared memory {}: other processes keep recreating it", name)};
}

// Creates a new object of zeros. REQUIRES: we hold the name's lock.
Result<UniqueFd> makeObject(const std::string& name, std::size_t size) {
  UniqueFd fd;
  for (int attempt = 0; attempt < 100 && !fd.valid(); ++attempt) {
    fd = UniqueFd(::shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kMode));
    if (fd.valid()) break;
    if (errno != EEXIST) return shmError(name, "open", errno);
    if (const auto removed = removeObject(name); !removed) return removed.error();
  }
  if (!fd.valid())
    return Error{Errc::kBusy,
                 fmt::format("shared memory {}: other processes keep recreating it", name)};
  // Not ftruncate(): on a full tmpfs that succeeds, and a later write ends the process.
  const int error = ::posix_fallocate(fd.get(), 0, static_cast<off_t>(size));
  if (error == 0) return fd;
  ::shm_unlink(name.c_str());
  return shmError(name, fmt::format("{} bytes", size).c_str(), error);
}

bool accepts(SharedMemory::From from, const struct stat& status) {
  if (from == SharedMemory::From::kAnyone) return true;
  if (status.st_uid == ::geteuid() || status.st_uid == 0) return true;
  // group_member() of glibc: the effective or a supplementary group of this process
  return from == SharedMemory::From::kOwnGroup && ::group_member(status.st_gid) != 0;
}

Error notReadable(const std::string& name) {
  struct stat status {};
  group entry{};
  group* found = nullptr;
  char buffer[4096];
  if (::lstat(("/dev/shm" + name).c_str(), &status) == 0)
    ::getgrgid_r(status.st_gid, &entry, buffer, sizeof buffer, &found);
  return {Errc::kIo,
          fmt::format("shared memory {}: Permission denied; members of the group {} may read it "
                      "(usermod -aG GROUP USER, then log in again)",
                      name, found ? found->gr_name : "that owns it")};
}

}  // namespace

Result<SharedMemory> SharedMemory::create(const std::string& name, std::size_t size) {
  auto lock = claim(name);
  if (!lock) return lock.error();
  auto object = makeObject(name, size);
  if (!object) {
    ::shm_unlink(lockName(name).c_str());
    return object.error();
  }
  void* data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, object->get(), 0);
  if (data == MAP_FAILED) {
    const int error = errno;
    ::shm_unlink(name.c_str());
    ::shm_unlink(lockName(name).c_str());
    return shmError(name, "map", error);
  }
  return SharedMemory(*std::move(lock), *std::move(object), static_cast<std::byte*>(data), size,
                      name);
}

Result<std::string> SharedMemory::mend() {
  const bool lock_is_there = isCurrent(lock_.get(), lockName(owned_name_));
  const bool object_is_there = isCurrent(object_.get(), owned_name_);
  if (lock_is_there && object_is_there) return std::string();
  if (!lock_is_there) {
    auto lock = claim(owned_name_);
    if (!lock) return lock.error();
    lock_ = *std::move(lock);
  }
  if (!object_is_there) {
    if (const auto remade = remake(); !remade) return remade.error();
  }
  return fmt::format("another program removed shared memory {}; it was created again",
                     object_is_there ? lockName(owned_name_) : owned_name_);
}

// Copies the bytes into a new object, whose pages then replace the old ones at the same address,
// atomically for all threads.
Result<Ok> SharedMemory::remake() {
  auto fresh = makeObject(owned_name_, size_);
  if (!fresh) return fresh.error();
  for (std::size_t done = 0; done < size_;) {
    const ssize_t n = ::pwrite(fresh->get(), data_ + done, size_ - done, static_cast<off_t>(done));
    if (n <= 0) return shmError(owned_name_, "copy", errno);
    done += static_cast<std::size_t>(n);
  }
  constexpr int kInPlace = MAP_SHARED | MAP_FIXED;
  if (::mmap(data_, size_, PROT_READ | PROT_WRITE, kInPlace, fresh->get(), 0) == MAP_FAILED)
    return shmError(owned_name_, "map", errno);
  object_ = *std::move(fresh);
  return Ok{};
}

Result<SharedMemory> SharedMemory::open(const std::string& name, From from) {
  const UniqueFd fd(::shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat status {};
  if (!fd.valid() && errno == EACCES) return notReadable(name);
  if (!fd.valid() || ::fstat(fd.get(), &status) != 0) return shmError(name, "open", errno);
  if (!accepts(from, status)) {
    return Error{Errc::kIo, fmt::format("shared memory {}: belongs to user {} and is not accepted",
                                        name, userName(status.st_uid))};
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return Error{Errc::kMalformed, fmt::format("shared memory {}: is empty", name)};
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd.get(), 0);
  if (data == MAP_FAILED) return shmError(name, "map", errno);
  return SharedMemory({}, {}, static_cast<std::byte*>(data), size, {});
}

bool SharedMemory::owned(const std::string& name) {
  const UniqueFd fd(::shm_open(lockName(name).c_str(), O_RDWR | O_CLOEXEC, 0));
  struct stat status {};
  // Another user's lock under this name does not count: claim() removes it.
  if (!fd.valid() || ::fstat(fd.get(), &status) != 0 || status.st_uid != ::geteuid()) return false;
  struct flock probe = wholeFile();
  return ::fcntl(fd.get(), F_OFD_GETLK, &probe) == 0 && probe.l_type != F_UNLCK;
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : lock_(std::move(other.lock_)),
      object_(std::move(other.object_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      owned_name_(std::exchange(other.owned_name_, {})) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(lock_, other.lock_);
  std::swap(object_, other.object_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(owned_name_, other.owned_name_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (data_) ::munmap(data_, size_);
  // If our lock was removed, another owner may have the name now.
  if (owned_name_.empty() || !isCurrent(lock_.get(), lockName(owned_name_))) return;
  ::shm_unlink(owned_name_.c_str());
  ::shm_unlink(lockName(owned_name_).c_str());
}

}  // namespace merlin
