// ShownFolder: the content folder, into which `merlin show FILE` puts what it makes of a file. Its
// group may write to it, so nothing in it can be trusted.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/wall/settings.h"
#include "daemon/wall/wall_contents.h"

namespace merlin::wall {

// A file in the folder, or a folder of slides.
struct FolderFile {
  std::string name;
  std::uint64_t bytes = 0;
  Duration age{};  // since it was written
  bool is_folder = false;
};

// Names of the files to be removed so that the next client has room. Those in `kept` stay; of the
// others the newest stay, as many as fit if all that stay take at most half of `limit_bytes`.
// Hidden files, which are still being written, stay and do not count. Pure.
std::vector<std::string> surplusOf(std::vector<FolderFile> files, std::span<const std::string> kept,
                                   std::uint64_t limit_bytes);

// Names of hidden files older than an hour, which clients that were killed have left. Pure.
std::vector<std::string> leftOversOf(std::span<const FolderFile> files);

// Returns the names of the contents in these files, the newest first, each with its file. Of two
// with the same name the newer one counts. Hidden files, and files that are no content, are
// omitted. Pure.
struct NamedFile {
  std::string name, file;
};
std::vector<NamedFile> namedFilesOf(std::vector<FolderFile> files);

// Thread-safe.
class ShownFolder {
 public:
  // `configured`: files that the configuration names; those in the folder are never removed.
  explicit ShownFolder(const ShownSettings& settings,
                       const std::vector<std::string>& configured = {});

  // Makes the folder if it is missing, for the group of this process, and such that files in it
  // get that group; removes what clients that were killed have left. Errors: kUnsupported (no
  // folder is set), kIo. To be called once, as the daemon starts.
  Result<Ok> make();

  const std::string& path() const noexcept { return settings_.folder; }
  std::uint64_t limitBytes() const noexcept {
    return static_cast<std::uint64_t>(settings_.limit_mb) * 1'000'000;
  }
  // Why it cannot be used; empty: it can.
  const std::string& fault() const noexcept { return fault_; }

  // The content of that name in the folder. Errors: those of contentBelow(); kUnsupported (the
  // folder cannot be used), kInvalidArgument (it is larger than limitBytes()).
  Result<ContentEntry> entryOf(const std::string& name) const;

  // namedFilesOf() for the folder: the contents that can be shown again. Only the first
  // kMostLookedAt files are examined.
  std::vector<NamedFile> namedFiles() const;
  static constexpr std::size_t kMostLookedAt = 1000;

  // Removes the files that surplusOf() returns for the folder; keeps `shown`, that of the previous
  // call and the files that the configuration names. Returns a sentence about each that cannot be
  // removed.
  std::vector<std::string> tidy(const std::string& shown);

 private:
  std::vector<FolderFile> files() const;
  std::vector<std::string> remove(const std::vector<std::string>& names) const;

  ShownSettings settings_;
  std::vector<std::string> configured_;  // names in the folder
  std::string fault_;
  std::mutex mutex_;
  std::string shown_, shown_before_;  // guarded by mutex_
};

}  // namespace merlin::wall
