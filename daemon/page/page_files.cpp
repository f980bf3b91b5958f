#include "daemon/page/page_files.h"

#include <algorithm>

namespace merlin::page {

const PageFile* findPageFile(std::string_view path) {
  const std::span<const PageFile> files = pageFiles();
  const auto found = std::ranges::find(files, path == "/" ? "/index.html" : path, &PageFile::path);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace merlin::page
