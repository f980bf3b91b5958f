#include "render/lod/io/mrm_file.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <xxhash.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/lod/io/mrm_layout.h"

namespace merlin::render::lod {
namespace {

using namespace mrm;

static_assert(std::endian::native == std::endian::little,
              "an .mrm file is mapped without conversion");

constexpr std::uint32_t kMostSections = 1024;

std::uint64_t checksum(const void* data, std::size_t size) { return XXH3_64bits(data, size); }

Error broken(const std::string& path, const std::string& what) {
  return {Errc::kMalformed, path + ": " + what};
}

// Returns the name of a section kind; nullptr if the kind is unknown.
const char* nameOf(std::uint32_t kind) {
  switch (static_cast<Kind>(kind)) {
    case Kind::kPositions: return "positions";
    case Kind::kFeature: return "feature";
    case Kind::kParents: return "parents";
    case Kind::kTriangles: return "triangles";
    case Kind::kAlive: return "alive";
    case Kind::kError: return "error";
    case Kind::kAbout: return "about";
    case Kind::kTexture: return "texture";
  }
  return nullptr;
}

class MrmReader {
 public:
  // `owner` keeps `bytes` alive.
  MrmReader(std::string path, std::span<const std::byte> bytes, std::shared_ptr<const void> owner)
      : path_(std::move(path)), bytes_(bytes), owner_(std::move(owner)) {}

  // Checks the header of a file of `file_size` bytes; `bytes` need not contain more than the
  // header.
  Result<Ok> checkHeader(std::uint64_t file_size) { return readHeader(file_size); }

  Result<Dendrogram> read() {
    if (const auto done = readHeader(size()); !done) return done.error();
    if (const auto done = readTable(); !done) return done.error();
    for (std::uint32_t i = 0; i < header_.sections; ++i) {
      SectionEntry entry{};
      std::memcpy(&entry, data() + sizeof header_ + i * sizeof entry, sizeof entry);
      if (const auto done = readSection(entry); !done) return done.error();
    }
    if (const auto done = checkCounts(); !done) return done.error();
    auto made = Dendrogram::make(std::move(arrays_), owner_);
    if (!made) return broken(path_, made.error().what);
    return made;
  }

 private:
  const std::byte* data() const { return bytes_.data(); }
  std::uint64_t size() const { return bytes_.size(); }

  Result<Ok> readHeader(std::uint64_t file_size) {
    if (size() < sizeof header_) return broken(path_, "is too short for an .mrm file");
    std::memcpy(&header_, data(), sizeof header_);
    if (std::memcmp(header_.magic, kMagic, sizeof kMagic) != 0) {
      return broken(path_, "is not an .mrm file (make one with: merlin mesh reduce IN -o OUT.mrm)");
    }
    if (header_.version != kVersion) {
      return Error{Errc::kUnsupported,
                   fmt::format("{}: is version {} of .mrm, but this program reads version {}; "
                               "make it again with: merlin mesh reduce",
                               path_, header_.version, kVersion)};
    }
    if (header_.header_checksum != checksum(&header_, offsetof(FileHeader, header_checksum))) {
      return broken(path_, "the header is damaged");
    }
    if (header_.file_size != file_size) {
      return broken(path_, fmt::format("has {} bytes, its header says {}: cut short or overwritten",
                                       file_size, header_.file_size));
    }
    return Ok{};
  }

  Result<Ok> readTable() const {
    const std::uint64_t table = header_.sections * sizeof(SectionEntry);
    if (header_.sections > kMostSections || sizeof header_ + table > size() ||
        header_.table_checksum != checksum(data() + sizeof header_, table)) {
      return broken(path_, "the section table is damaged");
    }
    return Ok{};
  }

  Result<Ok> readSection(const SectionEntry& e) {
    if (nameOf(e.kind) == nullptr) {  // cannot be checked, as the size of its values is unknown
      if (e.kind >= kFirstOptional) return Ok{};
      return Error{Errc::kUnsupported,
                   fmt::format("{}: section kind {} is not known", path_, e.kind)};
    }
    const std::uint64_t row = std::uint64_t{e.dimension} * unitOf(e.kind);
    if (row == 0 || row > size() || e.offset % kAlignment != 0 || e.offset > size() ||
        e.rows > (size() - e.offset) / row) {
      return broken(path_, fmt::format("section {} does not lie in the file", nameOf(e.kind)));
    }
    const std::byte* at = data() + e.offset;
    if (e.checksum != checksum(at, e.rows * row)) {
      return broken(path_, fmt::format("section {} is damaged", nameOf(e.kind)));
    }
    if (e.kind == static_cast<std::uint32_t>(Kind::kFeature) && !isText(nameIn(e)))
      return broken(path_, "a feature's name is not valid UTF-8");
    place(e, at);
    return Ok{};
  }

  static std::string_view nameIn(const SectionEntry& e) {
    const std::string_view name(e.name, strnlen(e.name, sizeof e.name));
    return name.size() == sizeof e.name - 1 ? wholeCharacters(name) : name;
  }

  void place(const SectionEntry& e, const std::byte* at) {
    const std::size_t values = e.rows * e.dimension;
    const std::span floats(reinterpret_cast<const float*>(at), values);
    const std::span words(reinterpret_cast<const std::uint32_t*>(at), values);
    switch (static_cast<Kind>(e.kind)) {
      case Kind::kPositions: arrays_.positions = floats; break;
      case Kind::kFeature:
        arrays_.features.push_back({std::string(nameIn(e)), e.dimension, floats});
        break;
      case Kind::kParents: arrays_.parents = words; break;
      case Kind::kTriangles: arrays_.triangles = words; break;
      case Kind::kAlive: arrays_.alive = words; break;
      case Kind::kError: arrays_.error = floats; break;
      case Kind::kTexture:
        arrays_.texture = {reinterpret_cast<const std::uint8_t*>(at), values};
        break;
      case Kind::kAbout: arrays_.about.assign(reinterpret_cast<const char*>(at), values); break;
    }
  }

  Result<Ok> checkCounts() const {
    if (arrays_.positions.size() == header_.nodes * 3 &&
        arrays_.parents.size() == header_.collapses &&
        arrays_.triangles.size() == header_.triangles * 3) {
      return Ok{};
    }
    return broken(path_, "a section is missing, or its size is not what the header says");
  }

  std::string path_;
  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;  // is passed on to the dendrogram
  FileHeader header_{};
  Dendrogram::Arrays arrays_;
};

}  // namespace

namespace {

template <typename File>
Result<Dendrogram> readFrom(const std::string& path, Result<File> file) {
  if (!file) return file.error();
  const auto kept = std::make_shared<File>(*std::move(file));
  return MrmReader(path, kept->bytes(), kept).read();
}

// Reads a copy of a file. Checks the header alone first, so that a large file of another format is
// not read completely; read() then checks the whole copy, as the file may have changed in between.
// `read`: returns the first `most` bytes of the file.
template <typename Read>
Result<Dendrogram> readCopy(const std::string& path, FileStamp* stamp, const Read& read) {
  const Result<FileCopy> head = read(sizeof(FileHeader));
  if (!head) return head.error();
  const auto good = MrmReader(path, head->bytes(), nullptr).checkHeader(head->stamp().size);
  if (!good) return good.error();
  Result<FileCopy> file = read(FileCopy::kAll);
  if (stamp && file) *stamp = file->stamp();
  return readFrom(path, std::move(file));
}

}  // namespace

Result<Dendrogram> readMrm(const std::string& path) {
  return readFrom(path, MappedFile::open(path));
}

Result<Dendrogram> readMrmCopy(const std::string& path, FileStamp* stamp) {
  return readCopy(path, stamp, [&](std::size_t most) { return FileCopy::read(path, most); });
}

Result<Dendrogram> readMrmCopy(int fd, const std::string& path, FileStamp* stamp) {
  return readCopy(path, stamp, [&](std::size_t most) { return FileCopy::read(fd, path, most); });
}

}  // namespace merlin::render::lod
