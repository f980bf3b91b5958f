#include "render/mesh/io/openmesh_reader.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <sstream>
#include <string>
#include <utility>

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

// The first word of `text`, which is shortened by it.
std::string_view takeWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
  text.remove_prefix(word.size());
  return word;
}

// "7", "7/1", "7//2", "-1/1/2": what a corner of a face starts with is a vertex.
bool isCorner(std::string_view word) {
  int vertex = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, vertex);
  return error == std::errc() && (rest == end || *rest == '/');
}

bool isNumber(std::string_view word) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && rest == end;
}

// The lines of an OBJ file that make a surface.
struct Surface {
  std::string lines;
  std::size_t vertices = 0, faces = 0;
};

// OpenMesh is shown nothing else: it would open the material files that others name, and a corner
// without a vertex ("//1") breaks an assertion of its own.
Result<Surface> surfaceOf(std::string_view content) {
  Surface surface;
  surface.lines.reserve(content.size());
  std::size_t number = 0;
  for (std::size_t at = 0; at < content.size(); ++number) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    std::string_view line = content.substr(at, end - at);
    line = line.substr(0, line.find('#'));
    at = end + 1;
    std::string_view rest = line;
    const std::string_view keyword = takeWord(rest);
    if (keyword != "v" && keyword != "f") continue;
    const bool face = keyword == "f";
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
      if (face ? isCorner(word) : isNumber(word)) continue;
      return Error{Errc::kMalformed, fmt::format("line {}: \"{}\" is no {}", number + 1, word,
                                                 face ? "corner of a face" : "number")};
    }
    ++(face ? surface.faces : surface.vertices);
    surface.lines.append(line).push_back('\n');
  }
  return surface;
}

// OpenMesh skips lines that it cannot read and says nothing, and every later index is then wrong.
Result<Ok> checkNothingSkipped(const FlatImporter& importer, const Surface& surface) {
  if (surface.vertices != importer.mesh.vertexCount()) {
    return Error{Errc::kMalformed,
                 fmt::format("{} of {} \"v\" lines could not be read",
                             surface.vertices - importer.mesh.vertexCount(), surface.vertices)};
  }
  if (surface.faces != importer.faces) {
    return Error{Errc::kMalformed, fmt::format("{} of {} \"f\" lines could not be read",
                                               surface.faces - importer.faces, surface.faces)};
  }
  return Ok{};
}

}  // namespace

Result<LoadedMesh> readWithOpenMesh(std::string_view content) {
  auto surface = surfaceOf(content);
  if (!surface) return surface.error();
  const Silence silence;
  FlatImporter importer;
  OpenMesh::IO::Options options(OpenMesh::IO::Options::VertexColor);
  try {
    std::istringstream lines(std::move(surface->lines));
    if (!OpenMesh::IO::OBJReader().read(lines, importer, options)) {
      return Error{Errc::kMalformed, "OpenMesh finds no OBJ in it"};
    }
  } catch (const std::exception& e) {
    return Error{Errc::kMalformed, fmt::format("OpenMesh: {}", e.what())};
  }
  if (const auto whole = checkNothingSkipped(importer, *surface); !whole) return whole.error();
  LoadedMesh loaded;
  loaded.mesh = std::move(importer.mesh);
  if (importer.colours.size() == loaded.mesh.positions.size() && !importer.colours.empty()) {
    loaded.mesh.features.push_back({"colour", 3, std::move(importer.colours)});
  }
  return loaded;
}

}  // namespace merlin::render
