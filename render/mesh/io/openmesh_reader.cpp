#include "render/mesh/io/openmesh_reader.h"

#include <exception>
#include <string_view>

#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <fmt/format.h>

#include "render/mesh/io/flat_importer.h"

namespace merlin::render {
namespace {

// OpenMesh prints to its own streams; a library that prints is silenced here.
class Silence {
 public:
  Silence() {
    omerr().disable();
    omlog().disable();
  }
  ~Silence() {
    omerr().enable();
    omlog().enable();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

// Lines of an OBJ file that start with `keyword` and a blank.
std::size_t countLines(std::string_view content, char keyword) {
  std::size_t lines = 0;
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    std::string_view line = content.substr(at, end - at);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.size() > 1 && line[0] == keyword && (line[1] == ' ' || line[1] == '\t')) ++lines;
    at = end + 1;
  }
  return lines;
}

// OpenMesh skips lines that it cannot read and says nothing, and every later index is then wrong.
Result<Ok> checkNothingSkipped(const FlatImporter& importer, std::string_view content) {
  const std::size_t vertices = countLines(content, 'v'), faces = countLines(content, 'f');
  if (vertices != importer.mesh.vertexCount()) {
    return Error{Errc::kMalformed, fmt::format("{} of {} \"v\" lines could not be read",
                                               vertices - importer.mesh.vertexCount(), vertices)};
  }
  if (faces != importer.faces) {
    return Error{Errc::kMalformed, fmt::format("{} of {} \"f\" lines could not be read",
                                               faces - importer.faces, faces)};
  }
  return Ok{};
}

}  // namespace

Result<LoadedMesh> readWithOpenMesh(const std::string& path, std::string_view content) {
  const Silence silence;
  FlatImporter importer;
  OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexColor);
  try {
    if (!OpenMesh::IO::OBJReader().read(path, importer, options)) {
      return Error{Errc::kMalformed, "OpenMesh finds no OBJ in it"};
    }
  } catch (const std::exception& e) {
    return Error{Errc::kMalformed, fmt::format("OpenMesh: {}", e.what())};
  }
  if (const auto whole = checkNothingSkipped(importer, content); !whole) return whole.error();
  LoadedMesh loaded;
  loaded.mesh = std::move(importer.mesh);
  if (importer.colours.size() == loaded.mesh.positions.size() && !importer.colours.empty()) {
    loaded.mesh.features.push_back({"colour", 3, std::move(importer.colours)});
  }
  return loaded;
}

}  // namespace merlin::render
