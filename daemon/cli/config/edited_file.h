// EditedFile: a file, and a copy of it that a person edits and that finally replaces the file's
// content.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// The copy is in the folder of the file, so that relative file names in it have the same meaning.
// Thread-bound.
class EditedFile {
 public:
  // Makes the copy, which only this user may read. If `path` is a link, the file that it points to
  // is edited, and the link is kept. Errors: kNotFound, kIo (also if this user may not replace the
  // file), kBusy (somebody else is editing it).
  static Result<EditedFile> open(const std::string& path);
  EditedFile(EditedFile&&) noexcept;
  EditedFile& operator=(EditedFile&&) = delete;
  EditedFile(const EditedFile&) = delete;
  EditedFile& operator=(const EditedFile&) = delete;
  ~EditedFile();  // removes the copy, unless keepCopy() was called

  const std::string& path() const noexcept { return path_; }
  const std::string& copy() const noexcept { return copy_; }
  // Returns whether the copy differs from the file as it was at open(). Errors: those of reading
  // the copy.
  Result<bool> hasChanged() const;
  // Replaces the file atomically by one with the content of the copy and the same owner, group and
  // mode. Errors: kIo (also if the file has changed since open(), or its owner cannot be kept); the
  // file is then unchanged.
  Result<Ok> replace();
  // Leaves the copy behind when this object is destroyed.
  void keepCopy() noexcept { kept_ = true; }

 private:
  EditedFile() = default;

  std::string path_, copy_, before_;
  FileStamp stamp_;
  UniqueFd lock_;  // the file itself, with a lock (flock) against a second edit
  bool kept_ = false;
};

}  // namespace merlin::cli
