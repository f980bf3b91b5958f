// The files of the page, embedded in the program by CMake (www/).
#pragma once

#include <span>
#include <string_view>

namespace merlin::page {

struct PageFile {
  std::string_view path;  // "/page.js"
  std::string_view type;  // "text/javascript; charset=utf-8"
  std::string_view etag;  // with its quotation marks; differs if the content does
  std::string_view content;
};

std::span<const PageFile> pageFiles();

// Returns the file at this path, and the page itself for "/". Null if there is none.
const PageFile* findPageFile(std::string_view path);

}  // namespace merlin::page
