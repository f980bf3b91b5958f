#include "daemon/wall/shown_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/base/files.h"
#include "daemon/base/open_below.h"
#include "daemon/base/printable_text.h"

namespace merlin::wall {
namespace {

namespace fs = std::filesystem;

constexpr Duration kLeftOver = std::chrono::hours(1);

bool isHidden(const FolderFile& file) { return file.name.starts_with('.'); }

// Creates the folder, writable for the group of this process, with the set-group-ID bit, so that
// new files get this group. systemd's RestrictSUIDSGID= forbids this bit; clients then set the
// group of their files themselves. Returns false if the folder cannot be created; errno has the
// reason.
bool makeForGroup(const std::string& folder) {
  if (::mkdir(folder.c_str(), 0770) != 0) return false;
  return ::chmod(folder.c_str(), 02770) == 0 || ::chmod(folder.c_str(), 0770) == 0;
}

// Returns the size of a file, or the total size of the files in a folder of slides. Links are not
// followed.
std::uint64_t bytesIn(const fs::directory_entry& entry) {
  std::error_code error;
  if (entry.symlink_status(error).type() == fs::file_type::regular) {
    const std::uintmax_t size = entry.file_size(error);
    return error ? 0 : size;  // 0 if it was removed meanwhile
  }
  if (entry.symlink_status(error).type() != fs::file_type::directory) return 0;
  std::uint64_t bytes = 0;
  for (fs::directory_iterator it(entry.path(), error), end; !error && it != end;
       it.increment(error)) {
    std::error_code unknown;
    if (it->symlink_status(unknown).type() != fs::file_type::regular) continue;
    const std::uintmax_t size = it->file_size(unknown);
    if (!unknown) bytes += size;
  }
  return bytes;
}

// Returns the time since the file was written; for a link, since the link was made. Zero if the
// file was removed meanwhile.
Duration ageOf(const std::string& path) {
  struct stat status {};
  timespec now{};
  if (::lstat(path.c_str(), &status) != 0 || ::clock_gettime(CLOCK_REALTIME, &now) != 0) return {};
  return std::chrono::seconds(now.tv_sec - status.st_mtim.tv_sec) +
         std::chrono::nanoseconds(now.tv_nsec - status.st_mtim.tv_nsec);
}

// Sorts by age; files of equal age are sorted by name, so that the order is deterministic.
void sortNewestFirst(std::vector<FolderFile>& files) {
  std::ranges::sort(files, [](const FolderFile& a, const FolderFile& b) {
    return std::pair(a.age, std::string_view(a.name)) < std::pair(b.age, std::string_view(b.name));
  });
}

}  // namespace

std::vector<std::string> surplusOf(std::vector<FolderFile> files, std::span<const std::string> kept,
                                   std::uint64_t limit_bytes) {
  std::erase_if(files, isHidden);
  sortNewestFirst(files);
  const auto isKept = [&](const FolderFile& file) {
    return std::ranges::find(kept, file.name) != kept.end();
  };
  std::uint64_t bytes = 0;
  for (const FolderFile& file : files) bytes += isKept(file) ? file.bytes : 0;
  std::vector<std::string> surplus;
  for (const FolderFile& file : files) {
    if (isKept(file)) continue;
    const bool fits = bytes <= limit_bytes / 2 && file.bytes <= limit_bytes / 2 - bytes;
    if (fits)
      bytes += file.bytes;
    else
      surplus.push_back(file.name);
  }
  return surplus;
}

std::vector<std::string> leftOversOf(std::span<const FolderFile> files) {
  std::vector<std::string> left;
  for (const FolderFile& file : files) {
    if (isHidden(file) && file.age > kLeftOver) left.push_back(file.name);
  }
  return left;
}

std::vector<NamedFile> namedFilesOf(std::vector<FolderFile> files) {
  std::erase_if(files, [](const FolderFile& file) {
    return !isPlainName(file.name) || !(file.is_folder || kindByEnding(file.name));
  });
  sortNewestFirst(files);
  std::vector<NamedFile> named;
  for (FolderFile& file : files) {
    std::string name = nameOf(file.name);
    if (std::ranges::find(named, name, &NamedFile::name) == named.end())
      named.push_back({std::move(name), std::move(file.name)});
  }
  return named;
}

ShownFolder::ShownFolder(const ShownSettings& settings, const std::vector<std::string>& configured)
    : settings_(settings) {
  if (settings_.folder.empty()) return;
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(settings_.folder, error);
  for (const std::string& path : configured) {
    const fs::path below = fs::weakly_canonical(path, error).lexically_relative(folder);
    if (!below.empty() && *below.begin() != ".." && *below.begin() != ".")
      configured_.push_back(below.begin()->string());
  }
}

Result<Ok> ShownFolder::make() {
  const auto cannot = [this](Errc code, const std::string& why) {
    fault_ = fmt::format("merlin show cannot show files: {} (/wall/shown/folder)", why);
    return Error{code, fault_};
  };
  const std::string& folder = settings_.folder;
  if (folder.empty())
    return cannot(Errc::kUnsupported,
                  "no content folder is set, and this user has no state folder to put one in");
  std::error_code error;
  fs::create_directories(fs::path(folder).parent_path(), error);
  if (!makeForGroup(folder) && errno != EEXIST)
    return cannot(Errc::kIo, fmt::format("{}: {}", folder, std::strerror(errno)));
  if (const auto usable = checkWritableFolder(folder); !usable)
    return cannot(usable.error().code, usable.error().what);
  const auto faults = remove(leftOversOf(files()));
  return faults.empty() ? Result<Ok>(Ok{}) : Error{Errc::kIo, faults.front()};
}

Result<ContentEntry> ShownFolder::entryOf(const std::string& name) const {
  if (!fault_.empty()) return Error{Errc::kUnsupported, fault_};
  if (!isPlainName(name)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("\"{}\" is not the name of a file in the content folder {}; merlind "
                             "opens no other file: `merlin show FILE` puts it there",
                             excerpt(name), settings_.folder)};
  }
  auto entry = contentBelow(settings_.folder, name);
  if (!entry) return entry;
  std::error_code gone;
  const std::uint64_t bytes = bytesIn(fs::directory_entry(entry->path, gone));
  if (bytes <= limitBytes()) return entry;
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: has {} bytes; /wall/shown/limit_mb allows {} MB", entry->path,
                           bytes, settings_.limit_mb)};
}

std::vector<NamedFile> ShownFolder::namedFiles() const {
  std::vector<FolderFile> found;
  std::error_code error;
  for (fs::directory_iterator it(settings_.folder, error), end;
       !error && it != end && found.size() < kMostLookedAt; it.increment(error)) {
    std::error_code gone;
    const fs::file_type type = it->symlink_status(gone).type();
    if (type == fs::file_type::regular || type == fs::file_type::directory)
      found.push_back({it->path().filename().string(), 0, ageOf(it->path().string()),
                       type == fs::file_type::directory});
  }
  return namedFilesOf(std::move(found));
}

std::vector<std::string> ShownFolder::tidy(const std::string& shown) {
  const std::lock_guard lock(mutex_);
  if (shown != shown_) shown_before_ = std::exchange(shown_, shown);
  std::vector<std::string> kept = configured_;
  kept.insert(kept.end(), {shown_, shown_before_});
  return remove(surplusOf(files(), kept, limitBytes()));
}

std::vector<FolderFile> ShownFolder::files() const {
  std::vector<FolderFile> files;
  std::error_code error;
  for (fs::directory_iterator it(settings_.folder, error), end; !error && it != end;
       it.increment(error)) {
    files.push_back({it->path().filename().string(), bytesIn(*it), ageOf(it->path().string())});
  }
  return files;
}

// Removes files and folders; of a link, only the link itself. Returns a sentence about each that
// cannot be removed.
std::vector<std::string> ShownFolder::remove(const std::vector<std::string>& names) const {
  std::vector<std::string> faults;
  for (const std::string& name : names) {
    std::error_code error;
    fs::remove_all(fs::path(settings_.folder) / name, error);
    if (error) {
      faults.push_back(
          fmt::format("{}/{} cannot be removed: {}", settings_.folder, name, error.message()));
    }
  }
  return faults;
}

}  // namespace merlin::wall
