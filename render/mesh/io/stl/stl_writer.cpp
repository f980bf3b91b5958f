// Writes binary STL: a header of 80 bytes, the number of triangles, then 50 bytes per triangle with
// the face normal, three corners, and two bytes without a standard meaning. The format has neither
// shared vertices nor features.
#include "daemon/base/bytes.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

bool carriesNothing(const Mesh&, const Feature&) { return false; }

bool write(const Mesh& mesh, const Origin&, const std::string&, const WriteBytes& bytes) {
  std::string row = "written by MERLIN";  // must not begin with "solid", as ASCII files do
  row.resize(80, ' ');
  appendLe32(row, static_cast<std::uint32_t>(mesh.triangleCount()));
  if (!bytes(std::as_bytes(std::span(row)))) return false;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const float* corners[3];
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = &mesh.positions[3 * std::size_t{mesh.triangles[t + k]}];
    row.clear();
    for (const float x : faceNormal(corners[0], corners[1], corners[2])) appendLeFloat(row, x);
    for (const float* p : corners) {
      for (std::size_t k = 0; k < 3; ++k) appendLeFloat(row, p[k]);
    }
    row.append(2, '\0');
    if (!bytes(std::as_bytes(std::span(row)))) return false;
  }
  return true;
}

}  // namespace

const MeshWriter kStlWriter{"stl", carriesNothing, write};

}  // namespace merlin::render::mesh
