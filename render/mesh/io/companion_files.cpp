#include "render/mesh/io/companion_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kMostNames = 65536;  // limit of names read from one folder

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

// Adds a name to `names`, under its lower-case form. If names differ only in case, the first one by
// its bytes is kept.
void addName(const std::string& name, std::map<std::string, std::string>& names) {
  const auto [found, fresh] = names.try_emplace(lowerCase(name), name);
  if (!fresh) found->second = std::min(found->second, name);
}

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

CompanionFinder::CompanionFinder(std::string folder, const std::vector<std::string>& files)
    : folder_(std::move(folder)), lists_(false) {
  for (const std::string& file : files) {
    if (!file.starts_with(folder_)) continue;
    std::string above = folder_;
    for (std::size_t at = folder_.size(), end = 0; end != std::string::npos; at = end + 1) {
      end = file.find('/', at);
      const std::string name = file.substr(at, end - at);
      addName(name, folders_[above]);
      above += name + '/';
    }
  }
}

const CompanionFinder::Names& CompanionFinder::namesIn(const std::string& folder) {
  const auto [found, fresh] = folders_.try_emplace(folder);
  if (!fresh || !lists_) return found->second;
  std::error_code error;
  std::filesystem::directory_iterator entries(folder.empty() ? "." : folder, error), end;
  for (std::size_t n = 0; !error && entries != end && n < kMostNames; ++n) {
    addName(entries->path().filename().string(), found->second);
    entries.increment(error);
  }
  return found->second;
}

// Returns an existing path that differs from `path` only in case; `path` itself if there is none.
std::string CompanionFinder::inAnyCase(const std::string& path) {
  std::string found = folder_;
  for (std::size_t at = folder_.size(), end = 0; end != std::string::npos; at = end + 1) {
    end = path.find('/', at);
    std::string name = path.substr(at, end - at);
    if (!exists(found + name)) {
      const Names& names = namesIn(found);
      const auto like = names.find(lowerCase(name));
      if (like == names.end()) return path;
      name = like->second;
    }
    found += end == std::string::npos ? name : name + '/';
  }
  return found;
}

std::string CompanionFinder::find(std::string_view name) {
  std::string path = pathBeside(folder_, name);
  if (exists(path)) return path;
  std::string found = inAnyCase(path);
  if (found != path) other_.try_emplace(std::move(path), found);
  return found;
}

std::string CompanionFinder::note() const {
  if (other_.empty()) return {};
  const auto& [named, found] = *other_.begin();
  const std::string others = other_.size() == 1
                                 ? std::string()
                                 : fmt::format("; the same holds for {} more", other_.size() - 1);
  return fmt::format("{}: is taken for {}, which is not there; the names differ only in capitals{}",
                     found, named.substr(folder_.size()), others);
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
