#include "daemon/state/state_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "daemon/base/absolute_path.h"
#include "daemon/base/files.h"
#include "daemon/base/unique_fd.h"
#include "daemon/json/json_tree.h"

namespace merlin::state {
namespace {

constexpr const char* kServiceFolder = "/var/lib/merlin";  // state folder of the installed services

Error failed(const std::string& path, int error) {
  return {Errc::kIo, fmt::format("{}: {}", path, std::strerror(error))};
}

// Reads at most one byte more than a JSON file may have, so that the parser refuses a longer file.
Result<std::string> textOf(const std::string& path) {
  const auto copy = FileCopy::read(path, kMostJsonBytes + 1);
  if (!copy) return copy.error();
  return std::string(copy->text());
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// Writes the folder's entries to the disk, so that a rename survives a power failure.
Result<Ok> syncFolder(const std::string& folder) {
  const UniqueFd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.valid() && ::fsync(fd.get()) == 0) return Ok{};
  return failed(folder, errno);
}

Result<Ok> rename(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) == 0) return Ok{};
  return failed(to, errno);
}

// Gives the file `from` the second name `to`, which replaces a file of that name. `meanwhile`: a
// temporary name, which is needed because link() replaces no file. Succeeds without any effect if
// `from` does not exist.
Result<Ok> linkAs(const std::string& from, const std::string& to, const std::string& meanwhile) {
  ::unlink(meanwhile.c_str());
  if (::link(from.c_str(), meanwhile.c_str()) != 0) {
    if (errno == ENOENT) return Ok{};  // the first state has no previous one
    return failed(to, errno);
  }
  return rename(meanwhile, to);
}

// Returns the first folder of a list with ':' between the folders, as systemd sets it.
std::string firstOf(std::string_view list) { return std::string(list.substr(0, list.find(':'))); }

}  // namespace

std::string stateFolder() {
  // NOLINTBEGIN(concurrency-mt-unsafe): called before any thread starts
  if (const char* given = std::getenv("STATE_DIRECTORY"); given && *given) return firstOf(given);
  if (::geteuid() == 0) return kServiceFolder;
  if (const char* own = std::getenv("XDG_STATE_HOME"); own && *own == '/')
    return fmt::format("{}/merlin", own);
  if (const char* home = std::getenv("HOME"); home && *home == '/')
    return fmt::format("{}/.local/state/merlin", home);
  // NOLINTEND(concurrency-mt-unsafe)
  return {};
}

Result<std::string> StateFolder::read() { return textOf(path_); }

Result<std::string> StateFolder::readPrevious() { return textOf(path_ + ".previous"); }

// The new state is written completely under a temporary name before the old state becomes the
// previous one.
Result<Ok> StateFolder::write(const std::string& text) {
  const std::string folder = folderOf(path_), next = path_ + ".next";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", folder, error.message())};
  if (auto written = writeFile(next, text); !written) return written;
  if (auto kept = linkAs(path_, path_ + ".previous", path_ + ".keep"); !kept) return kept;
  if (auto replaced = rename(next, path_); !replaced) return replaced;
  return syncFolder(folder);
}

Result<Ok> StateFolder::putAside() { return rename(path_, path_ + ".damaged"); }

std::string stateFile(const std::string& wanted, const std::string& instance, bool has_wall) {
  const char* const ending = has_wall ? "" : ".devices";
  if (!wanted.empty()) return wanted + ending;
  const std::string folder = stateFolder();
  return folder.empty() ? folder : fmt::format("{}/{}.state.json{}", folder, instance, ending);
}

std::string findStateFile(const std::string& wanted, const std::string& instance) {
  const std::string own = stateFile(wanted, instance, true);
  const std::string service = fmt::format("{}/{}.state.json", kServiceFolder, instance);
  return wanted.empty() && !fileStamp(own) && fileStamp(service) ? service : own;
}

namespace {

// Returns the path of a stored configuration, such as
// "FOLDER/etc-merlin-merlin.json.wall.last-good". The name contains the whole path of the
// configuration, because configurations in several folders may have the same name, and the role,
// because each role checks other files. A '/' in the path becomes a dash, and a dash is doubled.
std::string lastGoodIn(const std::string& folder, const std::string& configuration,
                       std::string_view role) {
  const std::string path = absolutePath(configuration);
  if (folder.empty() || path.empty()) return {};
  std::string name;
  for (const char c : path.substr(1)) name += c == '/' ? "-" : c == '-' ? "--" : std::string(1, c);
  return fmt::format("{}/{}.{}.last-good", folder, name, role);
}

}  // namespace

std::string lastGoodFile(const std::string& configuration, const std::string& role) {
  return lastGoodIn(stateFolder(), configuration, role);
}

std::vector<std::string> findLastGoodFiles(const std::string& configuration) {
  for (const std::string& folder : {stateFolder(), std::string(kServiceFolder)}) {
    std::vector<std::string> found;
    for (const char* role : {"wall", "devices", "all"}) {
      const std::string file = lastGoodIn(folder, configuration, role);
      if (fileStamp(file)) found.push_back(file);
    }
    if (!found.empty()) return found;
  }
  return {};
}

std::string shownFolder(const std::string& wanted, const std::string& file,
                        const std::string& instance) {
  if (wanted.empty() && file.empty()) return {};
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(
      wanted.empty() ? fmt::format("{}/{}.shown", folderOf(file), instance) : wanted, error);
  const std::string folder = whole.lexically_normal().string();
  return folder.size() > 1 && folder.ends_with('/') ? folder.substr(0, folder.size() - 1) : folder;
}

}  // namespace merlin::state
