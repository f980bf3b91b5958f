#include "render/import/companion_path.h"

#include <charconv>

#include "daemon/base/files.h"

namespace merlin::render::import {
namespace {

// Decodes %XX in a URI. A "%" without two hexadecimal digits stays unchanged, and so does "%00",
// which would end the name.
std::string percentDecoded(const std::string& name) {
  std::string decoded;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned char byte = 0;
    const char* digits = name.data() + i + 1;
    const bool coded = name[i] == '%' && i + 2 < name.size() &&
                       std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2 && byte != 0;
    decoded += coded ? static_cast<char>(byte) : name[i];
    if (coded) i += 2;
  }
  return decoded;
}

}  // namespace

std::string companionPath(mesh::CompanionFinder& files, const std::string& name) {
  std::string path = files.find(name);
  if (name.find('%') == std::string::npos || fileStamp(path)) return path;
  return files.find(percentDecoded(name));
}

std::string companionPath(const std::string& folder, const std::string& name) {
  mesh::CompanionFinder as_written(folder, {});
  return companionPath(as_written, name);
}

}  // namespace merlin::render::import
