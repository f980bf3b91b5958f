// ThumbnailFiles: keeps models' thumbnails as JPEG files in a folder, so that they outlive the
// page's process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::page {

// Thread-bound.
class ThumbnailFiles {
 public:
  // A file is named PREFIX, a hash of the content's key, and ".jpg".
  ThumbnailFiles(std::string folder, std::string prefix)
      : folder_(std::move(folder)), prefix_(std::move(prefix)) {}

  // Returns the picture of the content with this key; nothing if there is none, or if the file is
  // not a JPEG picture of a thumbnail's size.
  std::optional<std::string> read(const std::string& key) const;
  // Writes the picture of the content with this key. Errors: writeFile()'s.
  Result<Ok> write(const std::string& key, const std::string& jpeg) const;
  // Removes the pictures of contents that are not among `keys`.
  void removeOthers(const std::vector<std::string>& keys) const;

 private:
  std::string fileName(const std::string& key) const;

  std::string folder_, prefix_;
};

}  // namespace merlin::page
