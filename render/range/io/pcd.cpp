#include "render/range/io/pcd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/origin.h"
#include "render/range/io/pcd_body.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

constexpr const char* kLeftOut[] = {"_", "x", "y", "z", "normal_x", "normal_y", "normal_z"};

void addPlanes(const PcdHeader& header, const std::vector<PcdValues>& values, PcdImage& pcd) {
  for (std::size_t f = 0; f < values.size(); ++f) {
    const PcdField& field = header.fields[f];
    const bool left_out =
        std::find(std::begin(kLeftOut), std::end(kLeftOut), field.name) != std::end(kLeftOut);
    const std::string name = isPackedColour(field) ? "colour" : field.name;
    if (left_out) continue;
    if (pcd.image.find(name)) {
      pcd.notes.push_back(fmt::format("the second field {} is left out", oneLine(name)));
      continue;
    }
    if (name == "colour" && isPackedColour(field))
      pcd.image.planes.push_back({"colour", 3, unpackedColour(values[f]), "", 0, 1});
    else
      pcd.image.planes.push_back({name, field.count, {values[f].begin(), values[f].end()}});
  }
}

using Place = std::array<double, 3>;

// The box around all finite points; low > high if there are none.
struct PointBox {
  Place low = {1e300, 1e300, 1e300}, high = {-1e300, -1e300, -1e300};

  Place middle() const {
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
  }
  double diagonal() const {
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  }
};

PointBox boxOf(const PcdValues& x, const PcdValues& y, const PcdValues& z) {
  PointBox box;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const Place at = {x[p], y[p], z[p]};
    if (!std::ranges::all_of(at, [](double v) { return std::isfinite(v); })) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], at[k]);
      box.high[k] = std::max(box.high[k], at[k]);
    }
  }
  return box;
}

// Returns the point from which ranges are measured. This is the file's viewpoint, unless that
// cannot be the scanner's position because only the points have map coordinates. In that case it is
// a point above the others, since ranges from 0 0 0 would have fewer digits than the points.
Place viewpointFor(const PointBox& box, const PcdHeader& header, std::vector<std::string>& notes) {
  constexpr double kFar = 100, kAbove = 10;  // in diagonals of the box
  const auto& v = header.viewpoint;
  const Place middle = box.middle();
  const Place away = {middle[0] - v[0], middle[1] - v[1], middle[2] - v[2]};
  const bool known = mesh::originNear(away) == mesh::Origin{} ||
                     std::hypot(away[0], away[1], away[2]) <= kFar * box.diagonal();
  if (known || !(box.low[0] <= box.high[0])) return {v[0], v[1], v[2]};
  notes.push_back(
      fmt::format("the viewpoint {}, {}, {} is too far away to be the scanner's place; the points "
                  "are taken as seen from above",
                  v[0], v[1], v[2]));
  return {middle[0], middle[1], box.high[2] + kAbove * box.diagonal()};
}

// Converts points to rays and ranges as seen from the viewpoint.
void addPoints(const PcdValues& x, const PcdValues& y, const PcdValues& z, const Place& viewpoint,
               RangeImage& image) {
  Geometry& g = image.geometry;
  g.scanner = Scanner::kRays;
  for (std::size_t k = 0; k < 3; ++k) g.T_world_scanner[4 * k + 3] = viewpoint[k];
  g.rays.assign(3 * x.size(), kNoReturn);
  image.range.assign(x.size(), kNoReturn);
  for (std::size_t p = 0; p < x.size(); ++p) {
    const Place d = {x[p] - viewpoint[0], y[p] - viewpoint[1], z[p] - viewpoint[2]};
    const double r = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(r > 0) || !(r <= double{kFarthest})) continue;
    image.range[p] = static_cast<float>(r);
    for (std::size_t k = 0; k < 3; ++k) g.rays[3 * p + k] = static_cast<float>(d[k] / r);
  }
}

}  // namespace

bool isPcd(std::string_view bytes) noexcept {
  return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION ");
}

Result<PcdImage> parsePcd(std::string_view bytes) {
  const auto header = parsePcdHeader(bytes);
  if (!header) return header.error();
  if (header->height == 1)
    return Error{Errc::kUnsupported,
                 fmt::format("its {} points are not organised in rows and columns (HEIGHT 1), as a "
                             "range image is; merlin mesh import makes a surface of such points",
                             header->points)};
  const auto values = readPcdBody(bytes, *header);
  if (!values) return values.error();
  const PcdValues* x = findField(*header, *values, "x");
  const PcdValues* y = findField(*header, *values, "y");
  const PcdValues* z = findField(*header, *values, "z");
  if (!x || !y || !z) return Error{Errc::kMalformed, "has no fields x, y and z"};
  PcdImage pcd;
  pcd.image.width = header->width;
  pcd.image.height = header->height;
  addPoints(*x, *y, *z, viewpointFor(boxOf(*x, *y, *z), *header, pcd.notes), pcd.image);
  addPlanes(*header, *values, pcd);
  return pcd;
}

}  // namespace merlin::render::range
