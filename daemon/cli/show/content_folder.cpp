#include "daemon/cli/show/content_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/fs.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "daemon/cli/allowed.h"
#include "daemon/cli/roles.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

Error failedWith(const std::string& path, int error) {
  return {error == ENOENT ? Errc::kNotFound : Errc::kIo,
          fmt::format("{}: {}", path, std::strerror(error))};
}

// Gives the file, or the folder and its files, to the group. The mode is set last, because chown()
// may clear bits of it.
Result<Ok> giveToGroup(const std::string& made, gid_t group) {
  const auto give = [group](const fs::path& path, mode_t mode) -> Result<Ok> {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return failedWith(path.string(), errno);
    const bool other = status.st_gid != group;
    if ((other && ::lchown(path.c_str(), static_cast<uid_t>(-1), group) != 0) ||
        ::chmod(path.c_str(), mode) != 0)
      return failedWith(path.string(), errno);
    return Ok{};
  };
  std::error_code error;
  if (!fs::is_directory(made, error)) return give(made, 0640);
  for (const auto& entry : fs::directory_iterator(made, error)) {
    if (auto given = give(entry.path(), 0640); !given) return given;
  }
  return give(made, 0770);
}

// Syncs the file or folder to the disk. To be called before it is renamed.
Result<Ok> sync(const std::string& path) {
  const UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid() || ::fsync(file.get()) != 0) return failedWith(path, errno);
  return Ok{};
}

// Copies the next bytes within the kernel. Returns their number; 0 if that is not possible for
// these files, or at the end; -1 after an error (errno).
ssize_t copyInKernel(int from, int to, std::size_t most) {
  const ssize_t n = ::copy_file_range(from, nullptr, to, nullptr, most, 0);
  const bool cannot = n < 0 && (errno == EXDEV || errno == EINVAL || errno == ENOSYS ||
                                errno == EOPNOTSUPP || errno == EPERM);
  return cannot ? 0 : n;
}

ssize_t copyByHand(int from, int to, std::vector<char>& block) {
  const ssize_t n = ::read(from, block.data(), block.size());
  for (ssize_t done = 0; done < n;) {
    const ssize_t written = ::write(to, block.data() + done, static_cast<std::size_t>(n - done));
    if (written < 0 && errno != EINTR) return -1;
    done += std::max<ssize_t>(written, 0);
  }
  return n;
}

}  // namespace

Result<ContentFolder> contentFolderOf(const std::string& instance) {
  const auto asked = askRole(instance, "wall", {"status"});
  if (!asked) return asked.error();
  const auto status = nlohmann::json::parse(*asked, nullptr, false);
  const auto found = status.is_object() ? status.find("shown_folder") : status.end();
  if (!status.is_object() || found == status.end() || !found->is_object())
    return Error{Errc::kUnsupported, "merlind is older than merlin and has no content folder"};
  const std::string fault = found->value("fault", "");
  if (!fault.empty()) return Error{Errc::kUnsupported, fault};
  return ContentFolder{found->value("path", ""), found->value("limit_bytes", std::uint64_t{0})};
}

bool isIn(const ContentFolder& folder, const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error).lexically_normal();
  return fs::equivalent(whole.parent_path(), folder.path, error);
}

std::uint64_t sizeOfAll(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(path, error))) return fs::file_size(path, error);
  std::uint64_t bytes = 0;
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(path, kSkip, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code gone;
    if (!fs::is_regular_file(it->symlink_status(gone))) continue;
    const std::uintmax_t size = it->file_size(gone);
    if (!gone) bytes += size;
  }
  return bytes;
}

Result<std::uint64_t> roomIn(const ContentFolder& folder) {
  if (const auto allowed = checkAllowed(folder.path); !allowed) return allowed.error();
  const std::uint64_t used = sizeOfAll(folder.path);
  if (used < folder.limit_bytes) return folder.limit_bytes - used;
  return Error{Errc::kUnsupported,
               fmt::format("{}: has {} MB, which is all that it may have (/wall/shown/limit_mb); "
                           "remove files there, or show a small one: then merlind removes old ones",
                           folder.path, used / 1'000'000)};
}

Result<Ok> handOver(const std::string& made, const ContentFolder& folder, const std::string& name) {
  struct stat status {};
  if (::stat(folder.path.c_str(), &status) != 0) return failedWith(folder.path, errno);
  if (const auto given = giveToGroup(made, status.st_gid); !given) return given;
  if (const auto written = sync(made); !written) return written;
  const std::string to = folder.path + "/" + name;
  if (std::rename(made.c_str(), to.c_str()) == 0) return Ok{};
  // rename() cannot replace a folder that is not empty, so the former one is moved into the work
  // folder, with which it is removed.
  const bool other = errno == ENOTEMPTY || errno == EEXIST || errno == EISDIR || errno == ENOTDIR;
  if (!other || std::rename(to.c_str(), (made + ".old").c_str()) != 0 ||
      std::rename(made.c_str(), to.c_str()) != 0)
    return failedWith(to, errno);
  return Ok{};
}

Result<Ok> copyFile(const std::string& from, const std::string& to,
                    const std::function<void(double share)>& on_progress) {
  const UniqueFd source(::open(from.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!source.valid() || ::fstat(source.get(), &status) != 0) return failedWith(from, errno);
  if (!S_ISREG(status.st_mode)) return Error{Errc::kMalformed, from + ": is not a regular file"};
  const UniqueFd copy(::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!copy.valid()) return failedWith(to, errno);
  if (::ioctl(copy.get(), FICLONE, source.get()) == 0) return Ok{};
  constexpr std::size_t kAtOnce = 64 << 20;
  std::vector<char> block;
  for (off_t done = 0; done < status.st_size;) {
    ssize_t n = block.empty() ? copyInKernel(source.get(), copy.get(), kAtOnce) : 0;
    if (n == 0) {
      block.resize(1 << 20);
      n = copyByHand(source.get(), copy.get(), block);
    }
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return failedWith(to, errno);
    if (n == 0) return Error{Errc::kIo, from + ": became shorter while it was copied"};
    done += n;
    if (on_progress) on_progress(static_cast<double>(done) / static_cast<double>(status.st_size));
  }
  return Ok{};
}

}  // namespace merlin::cli
