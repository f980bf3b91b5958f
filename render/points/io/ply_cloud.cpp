#include "render/points/io/ply_cloud.h"

#include <utility>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/ply/ply.h"
#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::points {

bool isPlyCloud(std::string_view bytes) {
  if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r")) return false;
  const auto header = mesh::ply::parseHeader(bytes);
  if (!header) return false;
  bool vertices = false;
  for (const auto& element : header->elements) {
    if (element.name == "vertex") vertices = element.count > 0;
    const bool surface =
        element.name == "face" || element.name == "tristrips" || element.name == "range_grid";
    if (surface && element.count > 0) return false;
  }
  return vertices;
}

Result<PointCloud> parsePlyCloud(std::string_view bytes) {
  auto loaded = mesh::ply::parse(bytes);
  if (!loaded) return Error{loaded.error().code, oneLine(loaded.error().what)};  // it quotes
  PointCloud cloud;
  cloud.format = "PLY without faces";
  cloud.positions = std::move(loaded->mesh.positions);
  cloud.features = std::move(loaded->mesh.features);
  cloud.notes = std::move(loaded->notes);
  return cloud;
}

}  // namespace merlin::render::points
