#include "render/mesh/io/sample/raw_triangles.h"

#include <charconv>

#include <fmt/format.h>

namespace merlin::render::mesh {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// Adds the triangle in a line, which must have exactly nine numbers. `number`: line number.
Result<Ok> addTriangle(std::string_view line, std::size_t number, Mesh& mesh) {
  for (int k = 0; k < 9; ++k) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    float value = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc())
      return Error{Errc::kMalformed, fmt::format("line {}: has {} of 9 numbers", number, k)};
    mesh.positions.push_back(value);
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  }
  if (line.find_first_not_of(kBlanks) != std::string_view::npos)
    return Error{Errc::kMalformed, fmt::format("line {}: has more than 9 numbers", number)};
  for (std::uint32_t k = 0; k < 3; ++k)
    mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.vertexCount()) - 3 + k);
  return Ok{};
}

Result<LoadedMesh> read(std::string_view content, const std::string&) {
  LoadedMesh loaded;
  for (std::size_t number = 1; !content.empty(); ++number) {
    const std::string_view line = content.substr(0, content.find('\n'));
    content.remove_prefix(std::min(line.size() + 1, content.size()));
    if (line.find_first_not_of(kBlanks) == std::string_view::npos) continue;
    if (const auto added = addTriangle(line, number, loaded.mesh); !added) return added.error();
  }
  return loaded;
}

}  // namespace

const MeshReader kRawTrianglesReader = {"raw", "nine coordinates of a triangle on each line", read};

}  // namespace merlin::render::mesh
