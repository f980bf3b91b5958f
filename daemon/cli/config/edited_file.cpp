#include "daemon/cli/config/edited_file.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 16U << 20;  // large enough: a configuration has at most 1 MiB

Error fault(const std::string& path, int number) {
  const auto code = number == ENOENT ? Errc::kNotFound : Errc::kIo;
  return {code, fmt::format("{}: {}", path, std::generic_category().message(number))};
}

bool writeAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

// Returns the path of the copy: ".merlin.edit.json" for "merlin.json". Editors recognise the
// language by the ending; the dot keeps merlind from reading the copy as a file of conf.d.
std::string copyName(const fs::path& path) {
  const std::string name =
      fmt::format(".{}.edit{}", path.stem().string(), path.extension().string());
  return (path.parent_path() / name).string();
}

// A temporary file with a new name beside `path`. rename() syncs it and gives it its final name;
// otherwise the destructor removes it.
class NewFile {
 public:
  explicit NewFile(const std::string& path) : name_(path + ".XXXXXX") {
    fd_.reset(::mkostemp(name_.data(), O_CLOEXEC));
  }
  ~NewFile() {
    if (fd_.valid() && !renamed_) ::unlink(name_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  int fd() const noexcept { return fd_.get(); }
  bool rename(const std::string& path) {
    renamed_ = ::fsync(fd_.get()) == 0 && std::rename(name_.c_str(), path.c_str()) == 0;
    return renamed_;
  }

 private:
  std::string name_;
  UniqueFd fd_;
  bool renamed_ = false;
};

// Syncs the folder of `path`, because a renamed file survives a power failure only then.
void syncFolder(const fs::path& path) {
  const UniqueFd folder(::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.valid()) ::fsync(folder.get());
}

}  // namespace

Result<EditedFile> EditedFile::open(const std::string& path) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  if (error) return fault(path, error.value());
  EditedFile edited;
  edited.path_ = real.string();
  edited.lock_.reset(::open(real.c_str(), O_RDONLY | O_CLOEXEC));
  if (!edited.lock_.valid()) return fault(edited.path_, errno);
  if (::flock(edited.lock_.get(), LOCK_EX | LOCK_NB) != 0)
    return Error{Errc::kBusy, edited.path_ + ": somebody else is editing it"};
  if (const auto writable = checkWritable(edited.path_); !writable) return writable.error();
  const auto file = FileCopy::read(edited.path_, kMostBytes);
  if (!file) return file.error();
  edited.before_ = std::string(file->text());
  edited.stamp_ = file->stamp();
  // Replaces the copy that an interrupted edit may have left behind.
  const std::string copy = copyName(real);
  ::unlink(copy.c_str());
  const UniqueFd fd(::open(copy.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!fd.valid()) return fault(copy, errno);
  edited.copy_ = copy;
  if (!writeAll(fd.get(), edited.before_)) return fault(copy, errno);
  return edited;
}

EditedFile::EditedFile(EditedFile&& other) noexcept
    : path_(std::move(other.path_)),
      copy_(std::exchange(other.copy_, {})),
      before_(std::move(other.before_)),
      stamp_(other.stamp_),
      lock_(std::move(other.lock_)),
      kept_(other.kept_) {}

EditedFile::~EditedFile() {
  if (!copy_.empty() && !kept_) ::unlink(copy_.c_str());
}

Result<bool> EditedFile::hasChanged() const {
  const auto copy = FileCopy::read(copy_, kMostBytes);
  if (!copy) return copy.error();
  return copy->text() != before_;
}

Result<Ok> EditedFile::replace() {
  const auto copy = FileCopy::read(copy_, kMostBytes);
  if (!copy) return copy.error();
  struct stat old {};
  if (::stat(path_.c_str(), &old) != 0) return fault(path_, errno);
  if (fileStamp(path_) != stamp_) {
    return Error{Errc::kIo, path_ +
                                ": another program has changed this file since it was opened; your "
                                "edits are not saved into it"};
  }
  NewFile fresh(copy_);
  if (fresh.fd() < 0 || !writeAll(fresh.fd(), copy->text())) return fault(path_, errno);
  struct stat now {};
  ::fstat(fresh.fd(), &now);
  const bool same = now.st_uid == old.st_uid && now.st_gid == old.st_gid;
  if (!same && ::fchown(fresh.fd(), old.st_uid, old.st_gid) != 0) {
    return Error{Errc::kIo,
                 fmt::format("{}: its owner or group cannot be kept by this user (they are {} and "
                             "{}); use sudo",
                             path_, old.st_uid, old.st_gid)};
  }
  // The mode is set after fchown(), which may clear bits of it.
  if (::fchmod(fresh.fd(), old.st_mode & 07777) != 0) return fault(path_, errno);
  if (!fresh.rename(path_)) return fault(path_, errno);
  syncFolder(path_);
  return Ok{};
}

}  // namespace merlin::cli
