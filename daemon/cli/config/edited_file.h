// EditedFile: a file and the copy of it that a person edits, until the copy takes the file's place.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// The copy lies in the file's folder, so that relative names in it mean the same. Thread-bound.
class EditedFile {
 public:
  // Makes the copy, for this user only. A link is followed: the file that it names is edited, and
  // stays where it is. Errors: kNotFound, kIo (also if this user may not replace the file), kBusy
  // (somebody else edits it).
  static Result<EditedFile> open(const std::string& path);
  EditedFile(EditedFile&&) noexcept;
  EditedFile& operator=(EditedFile&&) = delete;
  EditedFile(const EditedFile&) = delete;
  EditedFile& operator=(const EditedFile&) = delete;
  ~EditedFile();  // removes the copy, unless keepCopy()

  const std::string& path() const noexcept { return path_; }
  const std::string& copy() const noexcept { return copy_; }
  // Whether copy and file differ. Errors: those of reading the copy.
  Result<bool> hasChanged() const;
  // Replaces the file's content by the copy's, atomically, with the owner, group and mode of the
  // file. Errors: kIo (also if the file has changed since open(), or its owner cannot be kept);
  // the file is then as it was.
  Result<Ok> replace();
  // Leaves the copy behind when this object is destroyed.
  void keepCopy() noexcept { kept_ = true; }

 private:
  EditedFile() = default;

  std::string path_, copy_, before_;
  FileStamp stamp_;
  UniqueFd lock_;  // the file itself, locked against another edit
  bool kept_ = false;
};

}  // namespace merlin::cli
