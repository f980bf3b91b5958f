#include "render/lod/io/mrm_file.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <xxhash.h>

#include "daemon/base/files.h"
#include "render/lod/io/mrm_layout.h"

namespace merlin::render {
namespace {

using namespace mrm;

static_assert(std::endian::native == std::endian::little, "an .mrm file is mapped as it stands");

constexpr std::uint32_t kMostSections = 1024;

std::uint64_t checksum(const void* data, std::size_t size) { return XXH3_64bits(data, size); }

Error broken(const std::string& path, const std::string& what) {
  return {Errc::kMalformed, path + ": " + what};
}

// nullptr for a kind that is not known.
const char* nameOf(std::uint32_t kind) {
  switch (static_cast<Kind>(kind)) {
    case Kind::kPositions: return "positions";
    case Kind::kFeature: return "feature";
    case Kind::kParents: return "parents";
    case Kind::kTriangles: return "triangles";
    case Kind::kAlive: return "alive";
    case Kind::kError: return "error";
    case Kind::kAbout: return "about";
  }
  return nullptr;
}

class MrmReader {
 public:
  MrmReader(std::string path, MappedFile file)
      : path_(std::move(path)), file_(std::make_shared<MappedFile>(std::move(file))) {}

  Result<Dendrogram> read() {
    if (const auto done = readHeader(); !done) return done.error();
    for (std::uint32_t i = 0; i < header_.sections; ++i) {
      SectionEntry entry{};
      std::memcpy(&entry, data() + sizeof header_ + i * sizeof entry, sizeof entry);
      if (const auto done = readSection(entry); !done) return done.error();
    }
    if (const auto done = checkCounts(); !done) return done.error();
    auto made = Dendrogram::make(std::move(arrays_), file_);
    if (!made) return broken(path_, made.error().what);
    return made;
  }

 private:
  const std::byte* data() const { return file_->bytes().data(); }
  std::uint64_t size() const { return file_->bytes().size(); }

  Result<Ok> readHeader() {
    if (size() < sizeof header_) return broken(path_, "is too short for an .mrm file");
    std::memcpy(&header_, data(), sizeof header_);
    if (std::memcmp(header_.magic, kMagic, sizeof kMagic) != 0) {
      return broken(path_, "is no .mrm file (make one with: merlin mesh reduce IN -o OUT.mrm)");
    }
    if (header_.version != kVersion) {
      return Error{Errc::kUnsupported,
                   fmt::format("{}: is version {} of .mrm, this program reads {}", path_,
                               header_.version, kVersion)};
    }
    if (header_.header_checksum != checksum(&header_, offsetof(FileHeader, header_checksum))) {
      return broken(path_, "the header is damaged");
    }
    if (header_.file_size != size()) {
      return broken(path_, fmt::format("has {} bytes, its header says {}: cut short or overwritten",
                                       size(), header_.file_size));
    }
    const std::uint64_t table = header_.sections * sizeof(SectionEntry);
    if (header_.sections > kMostSections || sizeof header_ + table > size() ||
        header_.table_checksum != checksum(data() + sizeof header_, table)) {
      return broken(path_, "the section table is damaged");
    }
    return Ok{};
  }

  Result<Ok> readSection(const SectionEntry& e) {
    if (nameOf(e.kind) == nullptr) {  // nobody here knows how large its values are
      if (e.kind >= kFirstOptional) return Ok{};
      return Error{Errc::kUnsupported,
                   fmt::format("{}: section kind {} is not known", path_, e.kind)};
    }
    const std::uint64_t unit = e.kind == static_cast<std::uint32_t>(Kind::kAbout) ? 1 : 4;
    const std::uint64_t row = std::uint64_t{e.dimension} * unit;
    if (row == 0 || row > size() || e.offset % kAlignment != 0 || e.offset > size() ||
        e.rows > (size() - e.offset) / row) {
      return broken(path_, fmt::format("section {} does not lie in the file", nameOf(e.kind)));
    }
    const std::byte* at = data() + e.offset;
    if (e.checksum != checksum(at, e.rows * row)) {
      return broken(path_, fmt::format("section {} is damaged", nameOf(e.kind)));
    }
    place(e, at);
    return Ok{};
  }

  void place(const SectionEntry& e, const std::byte* at) {
    const std::size_t values = e.rows * e.dimension;
    const std::span floats(reinterpret_cast<const float*>(at), values);
    const std::span words(reinterpret_cast<const std::uint32_t*>(at), values);
    switch (static_cast<Kind>(e.kind)) {
      case Kind::kPositions: arrays_.positions = floats; break;
      case Kind::kFeature:
        arrays_.features.push_back(
            {std::string(e.name, strnlen(e.name, sizeof e.name)), e.dimension, floats});
        break;
      case Kind::kParents: arrays_.parents = words; break;
      case Kind::kTriangles: arrays_.triangles = words; break;
      case Kind::kAlive: arrays_.alive = words; break;
      case Kind::kError: arrays_.error = floats; break;
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
  std::shared_ptr<MappedFile> file_;
  FileHeader header_{};
  Dendrogram::Arrays arrays_;
};

struct Section {
  SectionEntry entry{};
  std::span<const std::byte> bytes;
};

template <typename T>
Section section(Kind kind, std::span<const T> values, std::size_t dimension,
                std::string_view name = "") {
  Section s{};
  s.bytes = std::as_bytes(values);
  s.entry.kind = static_cast<std::uint32_t>(kind);
  s.entry.dimension = static_cast<std::uint32_t>(dimension);
  s.entry.rows = values.size() / dimension;
  s.entry.checksum = checksum(s.bytes.data(), s.bytes.size());
  std::copy_n(name.begin(), std::min(name.size(), sizeof s.entry.name - 1), s.entry.name);
  return s;
}

std::vector<Section> sectionsOf(const Dendrogram::Arrays& a) {
  std::vector<Section> all;
  all.push_back(section(Kind::kAbout, std::span(a.about.data(), a.about.size()), 1));
  all.push_back(section(Kind::kAlive, a.alive, 1));
  all.push_back(section(Kind::kError, a.error, 1));
  all.push_back(section(Kind::kParents, a.parents, 1));
  all.push_back(section(Kind::kTriangles, a.triangles, 3));
  all.push_back(section(Kind::kPositions, a.positions, 3));
  for (const FeatureView& f : a.features) {
    all.push_back(section(Kind::kFeature, f.values, f.dimension, f.name));
  }
  std::uint64_t at = sizeof(FileHeader) + all.size() * sizeof(SectionEntry);
  for (Section& s : all) {
    at = (at + kAlignment - 1) / kAlignment * kAlignment;
    s.entry.offset = at;
    at += s.bytes.size();
  }
  return all;
}

FileHeader headerFor(const Dendrogram& d, const std::vector<Section>& sections,
                     std::span<const SectionEntry> table) {
  FileHeader h{};
  std::memcpy(h.magic, kMagic, sizeof kMagic);
  h.version = kVersion;
  h.sections = static_cast<std::uint32_t>(sections.size());
  h.file_size = sections.back().entry.offset + sections.back().bytes.size();
  h.nodes = d.nodeCount();
  h.collapses = d.arrays().parents.size();
  h.triangles = d.triangleCount();
  const Box box = boundingBox(d.arrays().positions);
  std::copy(box.low.begin(), box.low.end(), h.box_low);
  std::copy(box.high.begin(), box.high.end(), h.box_high);
  h.table_checksum = checksum(table.data(), table.size_bytes());
  h.header_checksum = checksum(&h, offsetof(FileHeader, header_checksum));
  return h;
}

}  // namespace

Result<Dendrogram> readMrm(const std::string& path) {
  auto file = MappedFile::open(path);
  if (!file) return file.error();
  return MrmReader(path, *std::move(file)).read();
}

Result<Ok> writeMrm(const std::string& path, const Dendrogram& dendrogram) {
  const std::vector<Section> sections = sectionsOf(dendrogram.arrays());
  std::vector<SectionEntry> table;
  for (const Section& s : sections) table.push_back(s.entry);
  const FileHeader header = headerFor(dendrogram, sections, table);
  return writeFile(path, [&](const WriteBytes& write) {
    if (!write(std::as_bytes(std::span(&header, 1))) || !write(std::as_bytes(std::span(table)))) {
      return false;
    }
    std::uint64_t at = sizeof header + table.size() * sizeof(SectionEntry);
    constexpr std::byte kPadding[kAlignment] = {};
    for (const Section& s : sections) {
      if (!write(std::span(kPadding, s.entry.offset - at)) || !write(s.bytes)) return false;
      at = s.entry.offset + s.bytes.size();
    }
    return true;
  });
}

}  // namespace merlin::render
