// Shared by the tests of .mrm: a model whose numbers are all given here, and access to a file's
// bytes, so that a test can damage them and correct the checksums.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <xxhash.h>

#include "render/lod/io/mrm_file.h"
#include "render/lod/io/mrm_layout.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {

using render::lod::CollapseLog;
using render::lod::Dendrogram;

inline const std::string kGoldenCube =
    std::string(MERLIN_SOURCE_DIR) + "/tests/data/golden/cube.mrm";

// Returns the cube with normals along its diagonals, collapsed along x, then y. The collapse log is
// written by hand, so that only buildDendrogram() and writeMrm() affect the golden file.
inline Dendrogram goldenCube() {
  Mesh mesh = cube();
  render::mesh::Feature normal{"normal", 3, mesh.positions};
  for (float& x : normal.values) x *= 0.57735026F;
  mesh.features.push_back(std::move(normal));
  constexpr float kHalf = 0.70710677F;
  CollapseLog log;
  log.children = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {8, 9}, {10, 11}};
  log.positions = {0, -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, 0, -1, 0, 0, 1};
  log.features = {{0, -kHalf, -kHalf, 0, kHalf, -kHalf, 0, -kHalf, kHalf,  //
                   0, kHalf, kHalf, 0, 0, -1, 0, 0, 1}};
  log.error = {0.25F, 0.125F, 0.5F, 0.5F, 1, 1};
  log.about = "cost=by hand\nmade=for the tests\n";
  return buildDendrogram(mesh, log);
}

// The bytes of an .mrm file, with access to its parts.
class MrmBytes {
 public:
  using Header = render::lod::mrm::FileHeader;
  using Entry = render::lod::mrm::SectionEntry;

  explicit MrmBytes(std::string file) : bytes(std::move(file)) {}

  Header header() const { return at<Header>(0); }
  void set(const Header& header) { put(0, header); }

  static std::size_t entryAt(std::size_t i) { return sizeof(Header) + i * sizeof(Entry); }
  Entry entry(std::size_t i) const { return at<Entry>(entryAt(i)); }
  void set(std::size_t i, const Entry& entry) { put(entryAt(i), entry); }

  // Returns the index in the table of the first section of `kind`.
  std::size_t find(render::lod::mrm::Kind kind) const {
    for (std::size_t i = 0; i < header().sections; ++i) {
      if (entry(i).kind == static_cast<std::uint32_t>(kind)) return i;
    }
    ADD_FAILURE() << "no section of kind " << static_cast<std::uint32_t>(kind);
    return 0;
  }
  static std::size_t sizeOf(const Entry& e) {
    return e.rows * e.dimension * render::lod::mrm::unitOf(e.kind);
  }

  // Overwrites a number in a section.
  template <typename T>
  void put(render::lod::mrm::Kind kind, std::size_t index, T value) {
    put(entry(find(kind)).offset + index * sizeof value, value);
  }

  // Recomputes all checksums; those of sections only where the section lies within the file.
  MrmBytes& seal() {
    for (std::size_t i = 0; i < header().sections && entryAt(i + 1) <= bytes.size(); ++i) {
      Entry e = entry(i);
      if (e.offset > bytes.size() || sizeOf(e) > bytes.size() - e.offset) continue;
      e.checksum = XXH3_64bits(&bytes[e.offset], sizeOf(e));
      set(i, e);
    }
    return sealTable();
  }
  // Recomputes the checksums of table and header only.
  MrmBytes& sealTable() {
    Header h = header();
    const std::size_t table = std::min(h.sections * sizeof(Entry), bytes.size() - sizeof h);
    h.table_checksum = XXH3_64bits(&bytes[sizeof h], table);
    h.header_checksum = XXH3_64bits(&h, offsetof(Header, header_checksum));
    set(h);
    return *this;
  }

  // Returns whether the byte is padding that aligns a section.
  bool isPadding(std::size_t at) const {
    if (at < entryAt(header().sections)) return false;
    for (std::size_t i = 0; i < header().sections; ++i) {
      if (at >= entry(i).offset && at < entry(i).offset + sizeOf(entry(i))) return false;
    }
    return true;
  }

  std::string bytes;

 private:
  using Kind = render::lod::mrm::Kind;

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, &bytes.at(offset), sizeof value);
    return value;
  }
  template <typename T>
  void put(std::size_t offset, const T& value) {
    std::memcpy(&bytes.at(offset), &value, sizeof value);
  }
};

template <typename T>
std::vector<T> copyOf(std::span<const T> values) {
  return {values.begin(), values.end()};
}

inline void expectSame(const Dendrogram& a, const Dendrogram& b) {
  const Dendrogram::Arrays &x = a.arrays(), &y = b.arrays();
  EXPECT_EQ(copyOf(x.positions), copyOf(y.positions));
  EXPECT_EQ(copyOf(x.parents), copyOf(y.parents));
  EXPECT_EQ(copyOf(x.triangles), copyOf(y.triangles));
  EXPECT_EQ(copyOf(x.alive), copyOf(y.alive));
  EXPECT_EQ(copyOf(x.error), copyOf(y.error));
  EXPECT_EQ(x.about, y.about);
  EXPECT_EQ(std::vector<std::uint8_t>(x.texture.begin(), x.texture.end()),
            std::vector<std::uint8_t>(y.texture.begin(), y.texture.end()));
  ASSERT_EQ(x.features.size(), y.features.size());
  for (std::size_t f = 0; f < x.features.size(); ++f) {
    EXPECT_EQ(x.features[f].name, y.features[f].name);
    EXPECT_EQ(x.features[f].dimension, y.features[f].dimension);
    EXPECT_EQ(copyOf(x.features[f].values), copyOf(y.features[f].values));
  }
}

}  // namespace merlin::test
