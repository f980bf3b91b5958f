#include "render/points/io/ply_cloud.h"

#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/ply/ply.h"
#include "render/mesh/io/ply/ply_body.h"
#include "render/mesh/io/ply/ply_header.h"

namespace merlin::render::points {
namespace {

using mesh::ply::Body;
using mesh::ply::Element;
using mesh::ply::Property;

// Reads the number of a property, or the last number of a list. Returns false at the end of the
// file.
bool nextOf(const Property& p, Body& body, double& value) {
  double count = 1;
  if (p.list && !body.next(p.count_type, count)) return false;
  for (auto left = static_cast<std::uint64_t>(count); left > 0; --left) {
    if (!body.next(p.type, value)) return false;
  }
  return true;
}

// Returns the first scalar property named x, y and z; nullptr if one is missing.
std::array<const Property*, 3> axesOf(const Element& vertices) {
  std::array<const Property*, 3> axes{};
  for (const Property& p : vertices.properties) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!p.list && !axes[k] && p.name == std::string_view("xyz").substr(k, 1)) axes[k] = &p;
  }
  return axes;
}

// Reads one row of an element; `point` receives the coordinates that the row has. Returns false at
// the end of the file.
bool nextRow(const Element& e, const std::array<const Property*, 3>& axes, Body& body,
             std::array<double, 3>& point) {
  for (const Property& p : e.properties) {
    double value = 0;
    if (!nextOf(p, body, value)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (axes[k] == &p) point[k] = value;
  }
  return true;
}

// Reads the coordinates again, as doubles, relative to the origin near the first point: the mesh
// parser stores floats, which are too coarse for map coordinates. REQUIRES: the parser has read the
// file.
void readExactly(std::string_view bytes, PointCloud& cloud) {
  const auto header = mesh::ply::parseHeader(bytes);
  if (!header) return;
  Body body(bytes.substr(header->size), header->form);
  for (const Element& e : header->elements) {
    const bool vertices = e.name == "vertex";
    const auto axes = axesOf(e);
    const std::uint64_t rows = e.properties.empty() ? 0 : e.count;
    for (std::uint64_t row = 0; row < rows; ++row) {
      std::array<double, 3> point{};
      if (!nextRow(e, axes, body, point)) return;
      if (!vertices) continue;
      if (row == 0) cloud.origin = mesh::originNear(point);
      for (std::size_t k = 0; k < 3; ++k)
        cloud.positions[3 * row + k] = static_cast<float>(point[k] - cloud.origin[k]);
    }
    if (vertices) return;
  }
}

// Checks the number of points. Errors: kUnsupported (more than kMostPoints points). Faults of the
// header are not reported here, since the parser finds them.
Result<Ok> checkCount(std::string_view bytes) {
  const auto header = mesh::ply::parseHeader(bytes);
  if (!header) return Ok{};
  for (const Element& e : header->elements) {
    if (e.name == "vertex" && e.count > kMostPoints)
      return Error{Errc::kUnsupported,
                   fmt::format("{} points; up to {} are read; thin it with: pdal translate IN "
                               "OUT.las sample --filters.sample.radius=0.1",
                               e.count, kMostPoints)};
  }
  return Ok{};
}

}  // namespace

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
  if (const auto few = checkCount(bytes); !few) return few.error();
  auto loaded = mesh::ply::parse(bytes);
  // The message quotes the file, so it is reduced to one line.
  if (!loaded) return Error{loaded.error().code, oneLine(loaded.error().what)};
  PointCloud cloud;
  cloud.format = "PLY without faces";
  cloud.positions = std::move(loaded->mesh.positions);
  readExactly(bytes, cloud);
  cloud.features = std::move(loaded->mesh.features);
  cloud.notes = std::move(loaded->notes);
  return cloud;
}

}  // namespace merlin::render::points
