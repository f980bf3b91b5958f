#include "render/import/assimp_folder.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "daemon/base/files.h"
#include "render/import/companion_path.h"
#include "render/mesh/io/companion_files.h"

namespace merlin::render::import {
namespace {

// A read-only file in memory, without the byte order mark that a text editor may have put before
// it.
class MappedStream final : public Assimp::IOStream {
 public:
  explicit MappedStream(MappedFile file) : file_(std::move(file)) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (FileSize() - at_) / size);
    if (items > 0) std::memcpy(to, file_.text().data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin from) override {
    const std::size_t size = FileSize();
    const std::size_t base = from == aiOrigin_SET ? 0 : from == aiOrigin_CUR ? at_ : size;
    // A negative offset wraps around, which gives the right sum.
    const std::size_t to = base + offset;
    if (to > size) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return file_.text().size(); }
  void Flush() override {}

 private:
  MappedFile file_;
  std::size_t at_ = 0;
};

}  // namespace

ModelFolder::ModelFolder(const ModelFile& file)
    : file_(file), name_("model." + file.format), folder_(mesh::folderOf(file.path)) {}

bool ModelFolder::Exists(const char* name) const { return fileStamp(pathOf(name)).has_value(); }

Assimp::IOStream* ModelFolder::Open(const char* name, const char* mode) {
  if (std::strchr(mode, 'w') || std::strchr(mode, 'a') || std::strchr(mode, '+')) return nullptr;
  auto file = MappedFile::open(pathOf(name));
  return file ? new MappedStream(*std::move(file)) : nullptr;
}

std::string ModelFolder::pathOf(const char* name) const {
  return name == name_ ? file_.path : companionPath(folder_, name);
}

}  // namespace merlin::render::import
