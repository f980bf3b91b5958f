// OM and STL files through OpenMesh's readers, each a row of the table of readers. What they
// find goes to a Collector, and is compared with what the file's header promises.
#include <algorithm>
#include <cstring>
#include <istream>
#include <streambuf>

#include <OpenMesh/Core/IO/reader/OMReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <fmt/format.h>

#include "daemon/base/child_work.h"
#include "render/mesh/io/openmesh/collector.h"
#include "render/mesh/io/reader.h"

namespace merlin::render {
namespace {

using OpenMesh::IO::Options;

// A file in memory, which OpenMesh may also seek in.
class Buffer final : public std::streambuf {
 public:
  explicit Buffer(std::string_view content) {
    char* const begin = const_cast<char*>(content.data());  // is only read
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

// Reads with OpenMesh. The stream throws at its end, which ends loops over counts that the file
// does not hold; whether all is there, the counts say and not the reader.
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
      return malformed(fmt::format("promises {} vertices and {} faces, and {} and {} were read",
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

// Arrays behind one another, each with its length before it: positions, triangles, features.
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

// In a process of its own: assertions of Debian's OpenMesh end the program at a damaged file.
Result<LoadedMesh> readBy(OpenMesh::IO::BaseReader& reader, std::string_view content,
                          const Counts& promised, const Options& options) {
  constexpr std::size_t kBytesPerSecond = 100'000;  // of CPU time; a hundredth of what it takes
  const std::chrono::seconds limit(10 + content.size() / kBytesPerSecond);
  const auto bytes = inChild(
      [&]() -> Result<std::string> {
        const auto mesh = collect(reader, content, promised, options);
        if (!mesh) return mesh.error();
        return packed(*mesh);
      },
      "is damaged: OpenMesh's reader broke off at it", limit);
  if (!bytes) return bytes.error();
  LoadedMesh loaded;
  loaded.mesh = unpacked(*bytes);
  return loaded;
}

// More of anything than bytes is a lie, and is found before memory is taken for it.
bool possible(const Counts& counts, std::string_view content) {
  return counts.vertices <= content.size() && counts.faces <= content.size();
}

std::uint32_t littleEndian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

// "OM", the kind of mesh, the version, then the numbers of vertices, faces and edges.
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
    return malformed(fmt::format("promises {} vertices and {} faces in {} bytes", counts->vertices,
                                 counts->faces, content.size()));
  return readBy(OpenMesh::IO::OMReader(), content, *counts, Options(Options::Binary));
}

std::optional<MeshFileSize> omSize(std::string_view content, const std::string&) {
  const auto counts = omCounts(content);
  if (!counts) return std::nullopt;
  return MeshFileSize{{counts->vertices, counts->faces, 0}, {}};
}

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

// A binary file's size follows from its count; plain letters begin with "solid", and so do some
// binary files.
bool isBinaryStl(std::string_view content) {
  return content.size() >= kStlHeader &&
         content.size() == kStlHeader + kStlTriangle * littleEndian(content, 80);
}

std::size_t countOf(std::string_view text, std::string_view word) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string_view::npos; at += word.size())
    ++n;
  return n;
}

// Corners in one place, which each triangle has for itself, become one vertex.
Result<LoadedMesh> readStl(std::string_view content, const std::string&) {
  if (isBinaryStl(content))
    return readBy(OpenMesh::IO::STLReader(), content, {0, littleEndian(content, 80)},
                  Options(Options::Binary));
  if (!content.starts_with("solid"))
    return malformed(
        "is neither an STL in plain letters (it does not begin with solid) nor a whole "
        "binary one (its size does not follow from its number of triangles)");
  const std::string text = std::string(content) + "\n";
  return readBy(OpenMesh::IO::STLReader(), text, {0, countOf(content, "endfacet")}, Options());
}

std::optional<MeshFileSize> stlSize(std::string_view content, const std::string&) {
  if (!isBinaryStl(content)) return std::nullopt;
  const std::size_t triangles = littleEndian(content, 80);
  return MeshFileSize{{3 * triangles, triangles, 0}, {}};
}

}  // namespace

const MeshReader kOmReader = {"om", "OpenMesh's own format: normals, colours, texture coordinates",
                              readOm, omSize};
const MeshReader kStlReader = {"stl",
                               "ascii and binary: triangles, whose corners in one place "
                               "become one vertex",
                               readStl, stlSize};

}  // namespace merlin::render
