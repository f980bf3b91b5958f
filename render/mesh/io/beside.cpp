#include "render/mesh/io/beside.h"

#include <algorithm>
#include <cctype>

namespace merlin::render {

std::string folderOf(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

std::string pathBeside(const std::string& folder, std::string_view name) {
  std::string path(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  const bool leaves = path.starts_with('/') || path.find("..") != std::string::npos ||
                      path.find(':') != std::string::npos;
  if (leaves) path = path.substr(path.find_last_of('/') + 1);
  while (path.starts_with("./")) path.erase(0, 2);
  return folder + path;
}

std::string plainName(const std::string& path) {
  std::string name = path.substr(folderOf(path).size());
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '-' || c == '_';
  };
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return !plain(static_cast<unsigned char>(c)); }, '_');
  return name;
}

}  // namespace merlin::render
