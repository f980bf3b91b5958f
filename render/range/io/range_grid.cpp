#include "render/range/io/range_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/ply/ply_body.h"
#include "render/mesh/io/ply/ply_header.h"
#include "render/mesh/io/ply_features.h"
#include "render/mesh/origin.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

namespace ply = mesh::ply;

constexpr std::size_t kMostPlyHeader = std::size_t{64} << 10;  // limit of the header [bytes]
constexpr std::size_t kMostProperties = 64;
constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

// The destination of a vertex property: a component of a plane.
struct Target {
  std::size_t plane = 0, offset = 0, dimension = 1;
  double factor = 1;
  bool kept = false;
};

// The vertices in the order of the file, and the vertex of each pixel.
struct Points {
  std::vector<float> xyz{};  // relative to the origin
  mesh::Origin origin{};     // offset from the file's coordinates, near the first vertex
  std::vector<Plane> planes{};
  std::vector<std::uint32_t> of_pixel{};

  // Returns a vertex in the file's coordinates.
  std::array<double, 3> at(std::uint32_t vertex) const {
    const float* p = &xyz[3 * std::size_t{vertex}];
    return {p[0] + origin[0], p[1] + origin[1], p[2] + origin[2]};
  }
};

struct Size {
  std::size_t width = 0, height = 0;
};

// Reads the size from the header's lines such as "obj_info num_cols 512".
Result<Size> sizeOf(std::string_view head) {
  Size size;
  for (std::size_t line = 1; !head.empty(); ++line) {
    std::string_view words = takeLine(head);
    if (takeWord(words) != "obj_info") continue;
    const std::string_view key = takeWord(words), value = takeWord(words);
    if (key != "num_cols" && key != "num_rows") continue;
    std::size_t& side = key == "num_cols" ? size.width : size.height;
    if (!readNumber(value, side) || side < 1 || side > kMostPixels)
      return Error{Errc::kMalformed, fmt::format("line {}: {} is \"{}\"; allowed are 1 to {}", line,
                                                 key, oneLine(excerpt(value)), kMostPixels)};
  }
  if (size.width > 0 && size.height > 0) {
    if (size.width <= kMostPixels / size.height) return size;
    return Error{Errc::kUnsupported, fmt::format("{} x {} pixels; allowed are {}", size.width,
                                                 size.height, kMostPixels)};
  }
  return Error{Errc::kMalformed,
               fmt::format("has a range_grid without its {}; a line of the header says it: "
                           "obj_info num_cols 512, obj_info num_rows 400",
                           size.width == 0 ? "num_cols" : "num_rows")};
}

Error endsIn(const ply::Element& element, std::uint64_t i, const ply::Body& body) {
  const std::string_view rest = body.rest();
  return {Errc::kMalformed,
          rest.empty()
              ? fmt::format("ends at {} {} of {}", oneLine(excerpt(element.name)), i, element.count)
              : fmt::format("{} {}: \"{}\" is not a number it may have",
                            oneLine(excerpt(element.name)), i, oneLine(rest))};
}

bool isInteger(ply::Scalar type) {
  return type != ply::Scalar::kFloat32 && type != ply::Scalar::kFloat64;
}

std::size_t planeNamed(const std::string& name, std::size_t dimension, Points& points) {
  for (std::size_t i = 0; i < points.planes.size(); ++i) {
    if (points.planes[i].name == name) return i;
  }
  Plane plane{name, dimension, {}, "", 0, 0};
  if (name == "colour") plane.high = 1;
  points.planes.push_back(std::move(plane));
  return points.planes.size() - 1;
}

Target targetOf(const ply::Property& property, Points& points) {
  Target target;
  for (const ply::PropertyMapping& row : ply::kPropertyMappings) {
    if (property.name != row.property) continue;
    // Others, such as normals, are not kept.
    if (std::string_view(row.feature) != "colour") return target;
    target = {planeNamed("colour", 3, points), row.offset, 3,
              isInteger(property.type) ? 1.0 / 255 : 1, true};
    return target;
  }
  if (property.list) return target;
  return {planeNamed(property.name, 1, points), 0, 1, 1, true};
}

// Skips the next list. Returns false if the body ends within it.
bool skipList(ply::Body& body, const ply::Property& list) {
  double count = 0, value = 0;
  if (!body.next(list.count_type, count) || !(count >= 0)) return false;
  constexpr double kMost = 1e18;  // more than any file has
  const auto items = static_cast<std::uint64_t>(std::min(count, kMost));
  for (std::uint64_t i = 0; i < items; ++i) {
    if (!body.next(list.type, value)) return false;
  }
  return true;
}

Error tooMany(const ply::Element& element) {
  return {Errc::kMalformed, fmt::format("the header says {} elements {}, more than the file has "
                                        "bytes for",
                                        element.count, oneLine(excerpt(element.name)))};
}

Result<Ok> skipElement(const ply::Element& element, ply::Body& body) {
  if (element.properties.empty()) return Ok{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const ply::Property& p : element.properties) {
      double value = 0;
      if (p.list ? !skipList(body, p) : !body.next(p.type, value)) return endsIn(element, i, body);
    }
  }
  return Ok{};
}

// The destinations of the properties of one vertex: x, y, z and the planes' values.
struct VertexLayout {
  std::vector<Target> targets{};
  // Indices of the properties x, y, z.
  std::array<std::size_t, 3> axis = {kNoVertex, kNoVertex, kNoVertex};
};

Result<VertexLayout> layoutOf(const ply::Element& element, Points& points) {
  VertexLayout layout;
  if (element.properties.size() > kMostProperties)
    return Error{Errc::kUnsupported, fmt::format("a vertex has {} properties; allowed are {}",
                                                 element.properties.size(), kMostProperties)};
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const ply::Property& p = element.properties[i];
    const std::size_t axis = p.name.size() == 1 && !p.list ? std::string("xyz").find(p.name) : 3;
    if (axis < 3) layout.axis[axis] = i;
    layout.targets.push_back(axis < 3 ? Target{} : targetOf(p, points));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (layout.axis[axis] == kNoVertex)
      return Error{Errc::kMalformed, fmt::format("the vertices have no property {}", "xyz"[axis])};
  }
  return layout;
}

Result<Ok> readVertices(const ply::Element& element, ply::Body& body, Points& points) {
  const auto layout = layoutOf(element, points);
  if (!layout) return layout.error();
  points.xyz.resize(3 * element.count);
  for (Plane& plane : points.planes) plane.values.resize(plane.dimension * element.count);
  std::vector<double> values(element.properties.size());
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      const ply::Property& p = element.properties[k];
      if (p.list ? !skipList(body, p) : !body.next(p.type, values[k]))
        return endsIn(element, i, body);
      const Target& to = layout->targets[k];
      if (to.kept)
        points.planes[to.plane].values[to.dimension * i + to.offset] =
            static_cast<float>(values[k] * to.factor);
    }
    const auto& axis = layout->axis;
    const std::array<double, 3> at = {values[axis[0]], values[axis[1]], values[axis[2]]};
    if (i == 0) points.origin = mesh::originNear(at);
    for (std::size_t k = 0; k < 3; ++k)
      points.xyz[3 * i + k] = static_cast<float>(at[k] - points.origin[k]);
  }
  return Ok{};
}

Result<Ok> readPixels(const ply::Element& element, ply::Body& body, Points& points) {
  if (element.properties.size() != 1 || !element.properties[0].list)
    return Error{Errc::kMalformed, "a range_grid has one list, the vertex of each pixel"};
  const ply::Property& list = element.properties[0];
  points.of_pixel.assign(element.count, kNoVertex);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    double count = 0, vertex = 0;
    if (!body.next(list.count_type, count)) return endsIn(element, i, body);
    if (count == 0) continue;
    if (count != 1)
      return Error{Errc::kMalformed,
                   fmt::format("pixel {} has {:g} vertices; allowed are 0 and 1", i, count)};
    if (!body.next(list.type, vertex)) return endsIn(element, i, body);
    if (!(vertex >= 0 && vertex < kNoVertex) || vertex != std::floor(vertex))
      return Error{
          Errc::kMalformed,
          fmt::format("pixel {} has vertex {:g}, which is not a vertex's number", i, vertex)};
    points.of_pixel[i] = static_cast<std::uint32_t>(vertex);
  }
  return Ok{};
}

Result<Points> readPoints(const ply::Header& header, std::string_view bytes, const Size& size) {
  Points points;
  ply::Body body(bytes, header.form);
  bool vertices = false, pixels = false;
  for (const ply::Element& element : header.elements) {
    // In ASCII, each word takes two bytes or more, except the last one.
    const std::size_t least = element.leastBytes(header.form);
    if (least > 0 && element.count > (body.left() + 1) / least) return tooMany(element);
    const bool vertex = element.name == "vertex", pixel = element.name == "range_grid";
    if ((vertex && vertices) || (pixel && pixels))
      return Error{Errc::kMalformed, fmt::format("has two elements {}", element.name)};
    if (pixel && element.count != size.width * size.height)
      return Error{Errc::kMalformed,
                   fmt::format("range_grid has {} pixels; num_cols x num_rows is {} x {}",
                               element.count, size.width, size.height)};
    if (vertex && least == 0) return Error{Errc::kMalformed, "the vertices have no property x"};
    const auto read = vertex  ? readVertices(element, body, points)
                      : pixel ? readPixels(element, body, points)
                              : skipElement(element, body);
    if (!read) return read.error();
    vertices |= vertex;
    pixels |= pixel;
  }
  if (!vertices) return Error{Errc::kMalformed, "has no element vertex"};
  const std::size_t count = points.xyz.size() / 3;
  for (std::size_t p = 0; p < points.of_pixel.size(); ++p) {
    if (points.of_pixel[p] != kNoVertex && points.of_pixel[p] >= count)
      return Error{Errc::kMalformed, fmt::format("pixel {} has vertex {}; there are {}", p,
                                                 points.of_pixel[p], count)};
  }
  return points;
}

double medianOfSteps(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Returns how uneven steps are: the median of their distances from their median, divided by that
// median.
double unevenness(std::vector<double> steps) {
  if (steps.empty()) return std::numeric_limits<double>::infinity();
  const double median = medianOfSteps(steps);
  for (double& step : steps) step = std::abs(step - median);
  return median > 0 ? medianOfSteps(steps) / median : std::numeric_limits<double>::infinity();
}

// Returns whether steps between neighbours in a row are more even as angles seen from the origin
// than as lengths seen from far away along z. Samples at most 8192 pairs.
bool isSeenFromTheOrigin(const Points& points, const Size& size) {
  std::vector<double> angles, lengths;
  const std::size_t pixels = size.width * size.height;
  const std::size_t stride = std::max(std::size_t{1}, pixels / 4096) | 1U;
  for (std::size_t p = 0; p + 1 < pixels; p += stride) {
    const std::uint32_t i = points.of_pixel[p], k = points.of_pixel[p + 1];
    if ((p + 1) % size.width == 0 || i == kNoVertex || k == kNoVertex) continue;
    const std::array<double, 3> a = points.at(i), b = points.at(k);
    const double cross =
        std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    const double angle = std::atan2(cross, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    const double length = std::hypot(a[0] - b[0], a[1] - b[1]);
    if (!std::isfinite(angle) || !std::isfinite(length)) continue;
    angles.push_back(angle);
    lengths.push_back(length);
  }
  return unevenness(std::move(angles)) < unevenness(std::move(lengths));
}

// Returns a point above the middle of the points: ten diagonals of their box higher, along z.
std::array<double, 3> distantPoint(const Points& points) {
  const std::vector<float>& xyz = points.xyz;
  const mesh::Origin& o = points.origin;
  std::array<double, 3> low = {1e30, 1e30, 1e30}, high = {-1e30, -1e30, -1e30};
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    if (!(std::abs(xyz[i]) <= kFarthest)) continue;
    low[i % 3] = std::min(low[i % 3], double{xyz[i]});
    high[i % 3] = std::max(high[i % 3], double{xyz[i]});
  }
  if (!(low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2])) return {0, 0, 1};
  const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return {o[0] + (low[0] + high[0]) / 2, o[1] + (low[1] + high[1]) / 2,
          o[2] + high[2] + 10 * diagonal};
}

// Stores the vertices as ranges and rays from `viewpoint`.
void placePoints(const Points& points, const std::array<double, 3>& viewpoint, RangeImage& image) {
  Geometry& g = image.geometry;
  g.scanner = Scanner::kRays;
  for (std::size_t k = 0; k < 3; ++k) g.T_world_scanner[4 * k + 3] = viewpoint[k];
  image.range.assign(image.pixels(), kNoReturn);
  g.rays.assign(3 * image.pixels(), kNoReturn);
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    if (points.of_pixel[p] == kNoVertex) continue;
    const std::array<double, 3> at = points.at(points.of_pixel[p]);
    const std::array<double, 3> d = {at[0] - viewpoint[0], at[1] - viewpoint[1],
                                     at[2] - viewpoint[2]};
    const double r = std::hypot(d[0], d[1], d[2]);
    if (!(r > 0) || !(r <= double{kFarthest})) continue;
    image.range[p] = static_cast<float>(r);
    for (std::size_t k = 0; k < 3; ++k) g.rays[3 * p + k] = static_cast<float>(d[k] / r);
  }
}

Plane ofPixels(const Plane& plane, const std::vector<std::uint32_t>& of_pixel) {
  Plane image{plane.name, plane.dimension, {}, plane.unit, plane.low, plane.high};
  image.values.assign(plane.dimension * of_pixel.size(), 0);
  for (std::size_t p = 0; p < of_pixel.size(); ++p) {
    if (of_pixel[p] == kNoVertex) continue;
    std::copy_n(&plane.values[plane.dimension * of_pixel[p]], plane.dimension,
                &image.values[plane.dimension * p]);
  }
  return image;
}

}  // namespace

bool isRangeGrid(std::string_view bytes) noexcept {
  if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r")) return false;
  std::string_view rest = bytes.substr(0, kMostPlyHeader);
  while (!rest.empty()) {
    std::string_view words = takeLine(rest);
    const std::string_view key = takeWord(words);
    if (key == "end_header") return false;
    if (key == "element" && takeWord(words) == "range_grid") return true;
  }
  return false;
}

Result<RangeGrid> parseRangeGrid(std::string_view bytes) {
  const auto header = ply::parseHeader(bytes);
  if (!header) return Error{header.error().code, oneLine(header.error().what)};
  const auto size = sizeOf(bytes.substr(0, header->size));
  if (!size) return size.error();
  const auto points = readPoints(*header, bytes.substr(header->size), *size);
  if (!points) return points.error();
  if (points->of_pixel.empty()) return Error{Errc::kMalformed, "has no element range_grid"};
  RangeGrid grid;
  grid.image.width = size->width;
  grid.image.height = size->height;
  const bool from_origin = isSeenFromTheOrigin(*points, *size);
  placePoints(*points, from_origin ? std::array<double, 3>{} : distantPoint(*points), grid.image);
  grid.notes.push_back(
      fmt::format("the scanner's place is not in the file; its grid is that of a scanner {}",
                  from_origin ? "at the origin" : "far away in the direction of z"));
  for (const Plane& plane : points->planes)
    grid.image.planes.push_back(ofPixels(plane, points->of_pixel));
  return grid;
}

}  // namespace merlin::render::range
