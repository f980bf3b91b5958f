#include "render/mesh/io/companion_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

// Writes files, and removes them in its destructor unless keep() was called.
class WrittenFiles {
 public:
  WrittenFiles() = default;
  ~WrittenFiles() {
    std::error_code gone;
    for (const std::string& path : paths_) std::filesystem::remove(path, gone);
  }
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;

  Result<Ok> make(const CompanionFile& file) {
    const auto done = writeFile(file.path, file.content);
    if (done) paths_.push_back(file.path);
    return done;
  }
  void keep() { paths_.clear(); }

 private:
  std::vector<std::string> paths_;
};

}  // namespace

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

std::optional<CompanionFile> pictureBeside(const Mesh& mesh, const std::string& path) {
  if (!isTextured(mesh)) return std::nullopt;
  const std::string name = pictureName(mesh, plainName(path));
  return CompanionFile{name, folderOf(path) + name, {mesh.texture.begin(), mesh.texture.end()}};
}

Result<bool> isThere(const CompanionFile& file) {
  std::error_code absent;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file.path, absent))) return false;
  const auto there = MappedFile::open(file.path);
  if (there && there->text() == file.content) return true;
  return Error{Errc::kInvalidArgument,
               file.path + ": exists with different content; remove it or name another output"};
}

Result<Ok> writeBeside(std::span<const CompanionFile> files,
                       const std::function<Result<Ok>()>& write) {
  WrittenFiles written;
  for (const CompanionFile& file : files) {
    const auto there = isThere(file);
    if (!there) return there.error();
    const auto done = *there ? Result<Ok>(Ok{}) : written.make(file);
    if (!done) return done;
  }
  const auto done = write();
  if (done) written.keep();
  return done;
}

}  // namespace merlin::render::mesh
