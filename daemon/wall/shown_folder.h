// ShownFolder: the content folder, into which `merlin show FILE` puts the content that it makes
// from a file. Its group may write to it, so no file in it can be trusted.
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

// A file or a folder of slides in the content folder.
struct FolderFile {
  std::string name;
  std::uint64_t bytes = 0;
  Duration age{};  // time since it was written
  bool is_folder = false;
};

// Returns the names of the files to be removed so that there is room for the next client's file.
// The files in `kept` are not removed. Of the others, from the newest to the oldest, each is kept
// if all kept files together have at most half of `limit_bytes`. Hidden files, which are still
// being written, are neither removed nor counted. Pure.
std::vector<std::string> surplusOf(std::vector<FolderFile> files, std::span<const std::string> kept,
                                   std::uint64_t limit_bytes);

// Returns the names of hidden files that are older than an hour: clients that were killed have left
// them. Pure.
std::vector<std::string> leftOversOf(std::span<const FolderFile> files);

// Returns the names of the contents in these files, each with the name of its file, newest first.
// If two have the same name, only the newer one is listed. Hidden files and files that are no
// contents are omitted. Pure.
struct NamedFile {
  std::string name, file;
};
std::vector<NamedFile> namedFilesOf(std::vector<FolderFile> files);

// Thread-safe.
class ShownFolder {
 public:
  // `configured`: paths that the configuration names; tidy() never removes those of them that are
  // in the folder.
  explicit ShownFolder(const ShownSettings& settings,
                       const std::vector<std::string>& configured = {});

  // Creates the folder if it is missing; the group of this process may write to it, and files in it
  // get this group. Removes the files that killed clients have left. Errors: kUnsupported (no
  // folder is set), kIo; those of checkWritableFolder(). To be called once, at the daemon's start.
  Result<Ok> make();

  const std::string& path() const noexcept { return settings_.folder; }
  std::uint64_t limitBytes() const noexcept {
    return static_cast<std::uint64_t>(settings_.limit_mb) * 1'000'000;
  }
  // Returns why the folder cannot be used; empty: it can be used.
  const std::string& fault() const noexcept { return fault_; }

  // Returns the content with the file name `name` in the folder. Errors: those of contentBelow();
  // kUnsupported (the folder cannot be used), kInvalidArgument (`name` is not a plain name, or the
  // content is larger than limitBytes()).
  Result<ContentEntry> entryOf(const std::string& name) const;

  // Returns the contents in the folder that can be shown again: namedFilesOf() for its first
  // kMostLookedAt files.
  std::vector<NamedFile> namedFiles() const;
  static constexpr std::size_t kMostLookedAt = 1000;

  // Removes the files that surplusOf() returns for the folder. Keeps the files that the
  // configuration names, the file `shown`, which is shown now, and the one that was shown before
  // it. Returns a sentence about each file that cannot be removed.
  std::vector<std::string> tidy(const std::string& shown);

 private:
  std::vector<FolderFile> files() const;
  std::vector<std::string> remove(const std::vector<std::string>& names) const;

  ShownSettings settings_;
  std::vector<std::string> configured_;  // names of configured files in the folder
  std::string fault_;
  std::mutex mutex_;
  std::string shown_, shown_before_;  // guarded by mutex_
};

}  // namespace merlin::wall
