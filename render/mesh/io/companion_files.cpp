#include "render/mesh/io/companion_files.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"

namespace merlin::render::mesh {

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
  const std::string own = path.substr(folderOf(path).size());
  const bool text = isText(own);
  std::string name;
  for (const char c : own) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte < 0x80 ? std::isalnum(byte) || c == '.' || c == '-' || c == '_' : text;
    name += plain ? std::string(1, c) : fmt::format("={:02X}", byte);
  }
  return name;
}

}  // namespace merlin::render::mesh
