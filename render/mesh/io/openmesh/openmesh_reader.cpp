// Reads OM and STL files with OpenMesh's readers; defines two rows of the table of readers. A
// Collector stores the vertices and faces; their counts are then compared with those in the file's
// header.
#include <algorithm>
#include <cstring>
#include <istream>
#include <streambuf>

#include <OpenMesh/Core/IO/reader/OMReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <fmt/format.h>

#include "daemon/base/child_work.h"
#include "daemon/base/words.h"
#include "render/mesh/io/openmesh/collector.h"
#include "render/mesh/io/openmesh/stl_colours.h"
#include "render/mesh/io/openmesh/stl_text.h"
#include "render/mesh/io/reader.h"

namespace merlin::render::mesh {
namespace {

using OpenMesh::IO::Options;

// A seekable stream over a file in memory.
class Buffer final : public std::streambuf {
 public:
  explicit Buffer(std::string_view content) {
    char* const begin = const_cast<char*>(content.data());  // the buffer never writes to it
    setg(begin, begin, begin + content.size());
  }

 private:
  pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type size = egptr() - eback();
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::end ? size
                                                       : gptr() - eback();
    if (base + by < 0 || base + by > size) return pos_type(off_type(-1));
    setg(eback(), eback() + base + by, egptr());
    return pos_type(base + by);
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode mode) override {
    return seekoff(off_type(to), std::ios_base::beg, mode);
  }
};

struct Counts {
  std::size_t vertices = 0, faces = 0;
};

Error malformed(const std::string& what) { return {Errc::kMalformed, what}; }

// Reads a mesh with OpenMesh. The stream throws at its end, which stops loops whose count exceeds
// the file. The counts of vertices and faces, not the reader's result, decide whether the file was
// complete.
Result<Mesh> collect(OpenMesh::IO::BaseReader& reader, std::string_view content,
                     const Counts& promised, Options options) {
  Collector collector(content.size() + 1);
  try {
    Buffer buffer(content);
    std::istream in(&buffer);
    in.exceptions(std::ios_base::failbit | std::ios_base::badbit);
    options += Options::VertexNormal;
    options += Options::VertexColor;
    options += Options::VertexTexCoord;
    try {
      reader.read(in, collector, options);
    } catch (const std::ios_base::failure&) {  // the counts tell whether something is missing
    }
    if (collector.vertices() < promised.vertices || collector.faces() != promised.faces) {
      return malformed(fmt::format("declares {} vertices and {} faces, but {} and {} were read",
                                   promised.vertices, promised.faces, collector.vertices(),
                                   collector.faces()));
    }
    return collector.take();
  } catch (const BrokenFile& broken) {
    return malformed(broken.what());
  } catch (const std::exception& e) {
    return malformed(fmt::format("cannot be read: {}", e.what()));
  }
}

constexpr std::pair<const char*, std::size_t> kFeatures[] = {
    {"normal", 3}, {"colour", 3}, {"texcoord", 2}};

// append(), takeFrom(), packed() and unpacked() convert a mesh to bytes and back: positions,
// triangles and features, each array after its length.
template <typename T>
void append(std::string& to, const std::vector<T>& values) {
  const std::uint64_t size = values.size();
  to.append(reinterpret_cast<const char*>(&size), sizeof size);
  if (size > 0) to.append(reinterpret_cast<const char*>(values.data()), size * sizeof(T));
}

template <typename T>
void takeFrom(std::string_view& from, std::vector<T>& values) {
  std::uint64_t size = 0;
  std::memcpy(&size, from.data(), sizeof size);
  values.resize(size);
  if (size > 0) std::memcpy(values.data(), from.data() + sizeof size, size * sizeof(T));
  from.remove_prefix(sizeof size + size * sizeof(T));
}

std::string packed(const Mesh& mesh) {
  std::string bytes;
  append(bytes, mesh.positions);
  append(bytes, mesh.triangles);
  for (const auto& [name, dimension] : kFeatures) {
    const Feature* const f = mesh.find(name);
    append(bytes, f ? f->values : std::vector<float>());
  }
  return bytes;
}

Mesh unpacked(std::string_view bytes) {
  Mesh mesh;
  takeFrom(bytes, mesh.positions);
  takeFrom(bytes, mesh.triangles);
  for (const auto& [name, dimension] : kFeatures) {
    Feature f{name, dimension, {}};
    takeFrom(bytes, f.values);
    if (!f.values.empty()) mesh.features.push_back(std::move(f));
  }
  return mesh;
}

// Reads a mesh in a child process, because assertions in Debian's OpenMesh end the process if a
// file is damaged.
Result<LoadedMesh> readBy(OpenMesh::IO::BaseReader& reader, std::string_view content,
                          const Counts& promised, const Options& options) {
  constexpr std::size_t kBytesPerSecond = 100'000;  // CPU time limit; OpenMesh is 100 times as fast
  const std::chrono::seconds limit(10 + content.size() / kBytesPerSecond);
  const auto bytes = inChild(
      [&]() -> Result<std::string> {
        const auto mesh = collect(reader, content, promised, options);
        if (!mesh) return mesh.error();
        return packed(*mesh);
      },
      "is damaged: OpenMesh's reader failed on it", limit);
  if (!bytes) return bytes.error();
  LoadedMesh loaded;
  loaded.mesh = unpacked(*bytes);
  return loaded;
}

// Returns false if the header declares more vertices or faces than the file has bytes. Checked
// before any memory is allocated.
bool possible(const Counts& counts, std::string_view content) {
  return counts.vertices <= content.size() && counts.faces <= content.size();
}

std::uint32_t littleEndian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

// Size in bytes of an OM header: "OM", the kind of mesh, the version, then the numbers of vertices,
// faces and edges.
constexpr std::size_t kOmHeader = 16;

Result<Counts> omCounts(std::string_view content) {
  if (content.size() < kOmHeader || !content.starts_with("OM"))
    return malformed("does not begin with the header of an OpenMesh file");
  return Counts{littleEndian(content, 4), littleEndian(content, 8)};
}

Result<LoadedMesh> readOm(std::string_view content, const std::string&) {
  const auto counts = omCounts(content);
  if (!counts) return counts.error();
  if (!possible(*counts, content))
    return malformed(fmt::format("declares {} vertices and {} faces in a file of {} bytes",
                                 counts->vertices, counts->faces, content.size()));
  return readBy(OpenMesh::IO::OMReader(), content, *counts, Options(Options::Binary));
}

std::optional<MeshFileSize> omSize(std::string_view content, const std::string&) {
  const auto counts = omCounts(content);
  if (!counts) return std::nullopt;
  return MeshFileSize{{counts->vertices, counts->faces, 0}, {}};
}

// Returns whether a file is a complete binary STL, for which its size must match its count of
// triangles. The first word does not show this: ASCII files begin with "solid", but so do some
// binary ones.
bool isBinaryStl(std::string_view content) {
  return content.size() >= kStlHeader &&
         content.size() == kStlHeader + kStlTriangle * littleEndian(content, 80);
}

Result<LoadedMesh> readBinaryStl(std::string_view content) {
  auto loaded = readBy(OpenMesh::IO::STLReader(), content, {0, littleEndian(content, 80)},
                       Options(Options::Binary));
  if (!loaded) return loaded;
  StlColours colours = stlColours(content);
  loaded->facet_colours = std::move(colours.of_triangles);
  if (colours.unread > 0)
    loaded->notes.push_back(fmt::format(
        "left out: the attributes of {} triangles, which are not colours", colours.unread));
  return loaded;
}

// Reads an STL file. OpenMesh merges corners at the same position, which STL repeats in each
// triangle.
Result<LoadedMesh> readStl(std::string_view content, const std::string&) {
  if (isBinaryStl(content)) return readBinaryStl(content);
  if (lowerCase(content.substr(0, 5)) != "solid")
    return malformed(
        "is neither an ASCII STL (it does not begin with solid) nor a complete binary one "
        "(its size does not match its number of triangles)");
  const auto facets = checkStlText(content);
  if (!facets) return facets.error();
  const std::string text = lowerCase(content) + "\n";
  return readBy(OpenMesh::IO::STLReader(), text, {0, *facets}, Options());
}

std::optional<MeshFileSize> stlSize(std::string_view content, const std::string&) {
  if (isBinaryStl(content)) {
    const std::size_t triangles = littleEndian(content, 80);
    return MeshFileSize{{3 * triangles, triangles, 0}, {}};
  }
  const auto facets = checkStlText(content);
  if (!facets) return std::nullopt;
  return MeshFileSize{{3 * *facets, *facets, 0}, content.size()};  // readStl() copies the text
}

// Returns whether a file is OM. The third byte is the kind of mesh, the fourth the version.
bool isOm(std::string_view content) {
  return content.size() >= kOmHeader && content.starts_with("OM") &&
         std::string_view("TQP").find(content[2]) != std::string_view::npos &&
         static_cast<unsigned char>(content[3]) < 0x80;
}

bool isStl(std::string_view content) { return isBinaryStl(content) || isStlText(content); }

}  // namespace

const MeshReader kOmReader = {"om", "OpenMesh's own format: normals, colours, texture coordinates",
                              readOm, omSize, isOm};
const MeshReader kStlReader = {
    "stl",
    "ASCII and binary: triangles, and their colours as Magics and VisCAM "
    "write them; corners at the same position become one vertex",
    readStl, stlSize, isStl};

}  // namespace merlin::render::mesh
