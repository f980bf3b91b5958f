// Writes .mrm files section by section, and each section in pieces, so that no section has to be in
// memory as a whole.
#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "daemon/base/blocks.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/lod/io/mrm_file.h"
#include "render/lod/io/mrm_layout.h"
#include "render/lod/removal_order.h"

namespace merlin::render::lod {
namespace {

using namespace mrm;

constexpr std::size_t kPiece = 1 << 16;  // number of rows that a thread gathers at a time

// Function type: writes the rows [first, end) of a section to memory that begins at `to`.
// Reentrant.
using Rows = std::function<void(std::size_t first, std::size_t end, std::byte* to)>;

struct Section {
  SectionEntry entry{};
  Rows rows;

  std::size_t rowBytes() const { return std::size_t{entry.dimension} * unitOf(entry.kind); }
  std::size_t bytes() const { return entry.rows * rowBytes(); }
};

// Returns the longest prefix of whole UTF-8 characters that fits into the name field.
std::string_view shortName(std::string_view name) {
  constexpr std::size_t kRoom = sizeof SectionEntry::name - 1;
  return name.size() > kRoom ? wholeCharacters(name.substr(0, kRoom)) : name;
}

// The sections of a model file, independent of the data structure that they come from.
struct Model {
  std::size_t nodes = 0, collapses = 0, triangles = 0;
  std::vector<Section> sections;

  void add(Kind kind, std::size_t rows, std::size_t dimension, std::string_view name, Rows fill) {
    Section s;
    s.entry.kind = static_cast<std::uint32_t>(kind);
    s.entry.dimension = static_cast<std::uint32_t>(dimension);
    s.entry.rows = rows;
    std::ranges::copy(shortName(name), s.entry.name);
    s.rows = std::move(fill);
    sections.push_back(std::move(s));
  }

  // Adds a section whose rows are already in memory in the layout of the file.
  template <typename T>
  void add(Kind kind, std::span<const T> values, std::size_t dimension,
           std::string_view name = "") {
    const std::size_t row = dimension * sizeof(T);
    add(kind, values.size() / dimension, dimension, name,
        [values, row](std::size_t first, std::size_t end, std::byte* to) {
          if (first < end)
            std::memcpy(to, std::as_bytes(values).data() + first * row, (end - first) * row);
        });
  }
};

Model modelOf(const Dendrogram& d) {
  const Dendrogram::Arrays& a = d.arrays();
  Model model{d.nodeCount(), a.parents.size(), d.triangleCount(), {}};
  model.add(Kind::kAbout, std::span(a.about.data(), a.about.size()), 1);
  model.add(Kind::kAlive, a.alive, 1);
  model.add(Kind::kError, a.error, 1);
  model.add(Kind::kParents, a.parents, 1);
  model.add(Kind::kTriangles, a.triangles, 3);
  model.add(Kind::kPositions, a.positions, 3);
  for (const FeatureView& f : a.features) model.add(Kind::kFeature, f.values, f.dimension, f.name);
  if (!a.texture.empty()) model.add(Kind::kTexture, a.texture, 1);
  return model;
}

// Returns a function that writes rows of one value each; value_of(row) returns the value.
template <typename T, typename ValueOf>
Rows each(ValueOf value_of) {
  return [value_of](std::size_t first, std::size_t end, std::byte* to) {
    for (std::size_t i = first; i < end; ++i, to += sizeof(T)) {
      const T value = value_of(i);
      std::memcpy(to, &value, sizeof value);
    }
  };
}

// Returns a function that writes one value row (position or feature) per node, in the dendrogram's
// order of nodes.
Rows gathered(const std::vector<float>& leaves, const std::vector<float>& inner,
              std::size_t dimension, const RemovalOrder& order) {
  return [&leaves, &inner, dimension, &order](std::size_t first, std::size_t end, std::byte* to) {
    const std::size_t row = dimension * sizeof(float);
    for (std::size_t n = first; n < end; ++n, to += row) {
      const std::size_t at = order.nodeOf(n) * dimension;
      std::memcpy(to, at < leaves.size() ? &leaves[at] : &inner[at - leaves.size()], row);
    }
  };
}

// Returns a function that writes the corners of triangles, in the dendrogram's order of triangles.
Rows corners(const mesh::Mesh& mesh, const RemovalOrder& order) {
  return [&](std::size_t first, std::size_t end, std::byte* to) {
    for (std::size_t i = first; i < end; ++i, to += 3 * sizeof(std::uint32_t)) {
      const std::uint32_t* t = &mesh.triangles[3 * std::size_t{order.triangleOf(i)}];
      const std::uint32_t row[] = {order.numberOf(t[0]), order.numberOf(t[1]),
                                   order.numberOf(t[2])};
      std::memcpy(to, row, sizeof row);
    }
  };
}

// Returns the sections for a mesh and its log. The arguments must outlive the returned model.
Model modelOf(const mesh::Mesh& mesh, const CollapseLog& log, const RemovalOrder& order,
              const std::vector<float>& error) {
  const std::size_t vertices = mesh.vertexCount();
  Model model{order.nodeCount(), log.children.size(), mesh.triangleCount(), {}};
  model.add(Kind::kAbout, std::span(log.about.data(), log.about.size()), 1);
  model.add(Kind::kAlive, error.size(), 1, "",
            each<std::uint32_t>([&order](std::size_t level) { return order.aliveAt(level); }));
  model.add(Kind::kError, std::span(error), 1);
  model.add(Kind::kParents, log.children.size(), 1, "",
            each<std::uint32_t>(
                [&order, vertices](std::size_t k) { return order.numberOf(vertices + k); }));
  model.add(Kind::kTriangles, mesh.triangleCount(), 3, "", corners(mesh, order));
  model.add(Kind::kPositions, order.nodeCount(), 3, "",
            gathered(mesh.positions, log.positions, 3, order));
  for (std::size_t f = 0; f < mesh.features.size(); ++f) {
    const mesh::Feature& feature = mesh.features[f];
    model.add(Kind::kFeature, order.nodeCount(), feature.dimension, feature.name,
              gathered(feature.values, log.features[f], feature.dimension, order));
  }
  if (!mesh.texture.empty()) model.add(Kind::kTexture, std::span(mesh.texture), 1);
  return model;
}

class MrmWriter {
 public:
  MrmWriter(Model model, unsigned threads) : model_(std::move(model)), threads_(threads) {
    head_.resize(sizeof(FileHeader) + model_.sections.size() * sizeof(SectionEntry));
    size_ = head_.size();
    for (Section& s : model_.sections) {
      size_ = (size_ + kAlignment - 1) / kAlignment * kAlignment;
      s.entry.offset = size_;
      size_ += s.bytes();
    }
    low_.fill(std::numeric_limits<float>::max());
    high_.fill(std::numeric_limits<float>::lowest());
  }

  Result<Ok> write(const std::string& path) {
    return writeFileHeadLast(
        path, head_.size(),
        [this](const WriteBytes& write) {
          std::uint64_t at = head_.size();
          constexpr std::byte kPadding[kAlignment] = {};
          for (Section& s : model_.sections) {
            if (!write(std::span(kPadding, s.entry.offset - at))) return false;
            if (!writeSection(s, write)) return false;
            at = s.entry.offset + s.bytes();
          }
          return true;
        },
        [this] { return head(); });
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  bool writeSection(Section& s, const WriteBytes& write) {
    const std::unique_ptr<XXH3_state_t, Free> state(XXH3_createState());
    XXH3_64bits_reset(state.get());
    const std::size_t row = s.rowBytes(), most = 4 * threads_ * kPiece;
    std::vector<std::byte> bytes(std::min<std::size_t>(most, s.entry.rows) * row);
    for (std::size_t first = 0; first < s.entry.rows; first += most) {
      const std::size_t rows = std::min<std::size_t>(most, s.entry.rows - first);
      forBlocks(threads_, (rows + kPiece - 1) / kPiece, [&](std::size_t piece) {
        const std::size_t begin = piece * kPiece, end = std::min(rows, begin + kPiece);
        s.rows(first + begin, first + end, bytes.data() + begin * row);
      });
      const std::span<const std::byte> done(bytes.data(), rows * row);
      XXH3_64bits_update(state.get(), done.data(), done.size());
      if (s.entry.kind == static_cast<std::uint32_t>(Kind::kPositions)) enlargeBox(done);
      if (!write(done)) return false;
    }
    s.entry.checksum = XXH3_64bits_digest(state.get());
    return true;
  }

  void enlargeBox(std::span<const std::byte> positions) {
    for (std::size_t at = 0; at < positions.size(); at += 3 * sizeof(float)) {
      float p[3];
      std::memcpy(p, &positions[at], sizeof p);
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
  }

  // Returns the header and the section table; called after all sections have been written.
  std::span<const std::byte> head() {
    FileHeader h{};
    std::memcpy(h.magic, kMagic, sizeof kMagic);
    h.version = kVersion;
    h.sections = static_cast<std::uint32_t>(model_.sections.size());
    h.file_size = size_;
    h.nodes = model_.nodes;
    h.collapses = model_.collapses;
    h.triangles = model_.triangles;
    if (model_.nodes > 0) {
      std::copy(low_.begin(), low_.end(), h.box_low);
      std::copy(high_.begin(), high_.end(), h.box_high);
    }
    std::byte* table = head_.data() + sizeof h;
    for (std::size_t i = 0; i < model_.sections.size(); ++i)
      std::memcpy(table + i * sizeof(SectionEntry), &model_.sections[i].entry,
                  sizeof(SectionEntry));
    h.table_checksum = XXH3_64bits(table, head_.size() - sizeof h);
    h.header_checksum = XXH3_64bits(&h, offsetof(FileHeader, header_checksum));
    std::memcpy(head_.data(), &h, sizeof h);
    return head_;
  }

  Model model_;
  unsigned threads_;
  std::vector<std::byte> head_;
  std::uint64_t size_ = 0;  // size of the file [bytes]
  std::array<float, 3> low_{}, high_{};
};

}  // namespace

Result<Ok> checkNames(const mesh::Mesh& mesh) {
  std::set<std::string_view> names;
  for (const mesh::Feature& f : mesh.features) {
    if (!names.insert(shortName(f.name)).second) {
      return Error{
          Errc::kUnsupported,
          fmt::format("two features would both be called \"{}\" in an .mrm file, which has 31 "
                      "bytes for a name; rename \"{}\"",
                      shortName(f.name), f.name)};
    }
  }
  return Ok{};
}

Result<Ok> writeMrm(const std::string& path, const Dendrogram& dendrogram) {
  return MrmWriter(modelOf(dendrogram), 1).write(path);
}

Result<Ok> writeMrm(const std::string& path, const mesh::Mesh& mesh, const CollapseLog& log,
                    unsigned threads) {
  threads = threadsOr(threads);
  const RemovalOrder order(mesh, log, threads);
  const std::vector<float> error = risingError(log);
  return MrmWriter(modelOf(mesh, log, order, error), threads).write(path);
}

}  // namespace merlin::render::lod
