#include "render/range/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/huge_vector.h"

namespace merlin::render::range {
namespace {

constexpr double kPi = std::numbers::pi;

struct Vector {
  double x = 0, y = 0, z = 0;
};

struct SinCos {
  double sin = 0, cos = 1;
};

// The rays of all pixels, computed from tables of the columns and of the rows. A pixel's point is
// its ray multiplied by its range, in the scanner's coordinates.
class RayTable {
 public:
  explicit RayTable(const RangeImage& image) : image_(image) {
    const Geometry& g = image.geometry;
    const bool spinning = g.scanner == Scanner::kSpinning;
    if (g.scanner == Scanner::kElevation || g.scanner == Scanner::kRays) return;
    for (std::size_t c = 0; c < image.width; ++c) columns_.push_back(entry(c, image.width, true));
    for (std::size_t r = 0; r < image.height; ++r) {
      rows_.push_back(spinning ? ofAngle(g.beams[r].altitude_rad) : entry(r, image.height, false));
      if (spinning) offsets_.push_back(ofAngle(g.beams[r].azimuth_rad));
    }
  }

  Vector at(std::size_t row, std::size_t column) const {
    switch (image_.geometry.scanner) {
      case Scanner::kOrthogonal: {  // [GOURLEY98] A.15 to A.17; `sin` holds the tangent
        const double x = columns_[column].sin, y = rows_[row].sin;
        const double d = 1 / std::sqrt(1 + x * x + y * y);
        return {x * d, y * d, -d};
      }
      case Scanner::kPinhole: return {columns_[column].sin, rows_[row].sin, -1};
      case Scanner::kSpinning: {
        const SinCos &a = columns_[column], &o = offsets_[row], &up = rows_[row];
        const double sin = a.sin * o.cos + a.cos * o.sin, cos = a.cos * o.cos - a.sin * o.sin;
        return {up.cos * sin, up.sin, -up.cos * cos};
      }
      case Scanner::kElevation: return {};
      case Scanner::kRays: break;
    }
    const float* ray = &image_.geometry.rays[3 * (row * image_.width + column)];
    return {double{ray[0]}, double{ray[1]}, double{ray[2]}};
  }

 private:
  static SinCos ofAngle(double angle_rad) { return {std::sin(angle_rad), std::cos(angle_rad)}; }

  // Returns the table entry of pixel `i` of `n` along an axis. Rows count downwards, angles
  // upwards.
  SinCos entry(std::size_t i, std::size_t n, bool horizontal) const {
    const Geometry& g = image_.geometry;
    const double angle = horizontal ? g.horizontal_rad : g.vertical_rad;
    const double sign = horizontal ? 1 : -1, count = static_cast<double>(n);
    const double middle = static_cast<double>(i) - (count - 1) / 2;  // pixels from the centre
    if (g.scanner == Scanner::kSpinning) return ofAngle(middle * angle / count);
    if (g.scanner == Scanner::kPinhole) return {sign * middle * 2 * std::tan(angle / 2) / count, 1};
    return {n > 1 ? sign * std::tan(middle * angle / (count - 1)) : 0, 1};
  }

  const RangeImage& image_;
  std::vector<SinCos> columns_{}, rows_{}, offsets_{};
};

double angleBetween(const Vector& a, const Vector& b) {
  const Vector n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  const double cross = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  return std::atan2(cross, a.x * b.x + a.y * b.y + a.z * b.z);
}

// Returns the median of the values; 0 if there are none.
double medianOf(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool isAngle(double angle_rad, double most_rad) {
  return angle_rad > 0 && angle_rad < most_rad;  // false for NaN
}

std::string anglesFault(const Geometry& g) {
  if (g.horizontal_rad == 0 && g.vertical_rad == 0)
    return "the angles of the image are not known; give them with --angles HORIZONTAL VERTICAL "
           "(degrees)";
  if (isAngle(g.horizontal_rad, kPi) && isAngle(g.vertical_rad, kPi)) return {};
  return fmt::format(
      "the angles are {:.6g} and {:.6g} degrees; allowed are more than 0 and less "
      "than 180",
      g.horizontal_rad * 180 / kPi, g.vertical_rad * 180 / kPi);
}

std::string beamsFault(const RangeImage& image) {
  const Geometry& g = image.geometry;
  if (g.beams.empty())
    return "the angles of the rows are not known; give a table of them with --angles FILE";
  if (g.beams.size() != image.height)
    return fmt::format("the table of angles has {} rows, the image has {}", g.beams.size(),
                       image.height);
  for (const Beam& beam : g.beams) {
    if (!(std::abs(beam.altitude_rad) <= kPi / 2) || !(std::abs(beam.azimuth_rad) <= 2 * kPi))
      return fmt::format(
          "a row has altitude {:.6g} and azimuth {:.6g} degrees; allowed are -90 to "
          "90 and -360 to 360",
          beam.altitude_rad * 180 / kPi, beam.azimuth_rad * 180 / kPi);
  }
  if (isAngle(g.horizontal_rad, 2 * kPi + 1e-9)) return {};
  return fmt::format("the columns turn by {:.6g} degrees; allowed are more than 0, at most 360",
                     g.horizontal_rad * 180 / kPi);
}

std::string elevationFault(const Geometry& g) {
  const auto isLength = [](double x) { return x > 0 && x <= 1e9; };
  if (!isLength(g.cell_x) || !isLength(g.cell_y))
    return fmt::format("the cells are {:.6g} x {:.6g}; allowed are more than 0, at most 1e9",
                       g.cell_x, g.cell_y);
  if (std::abs(g.exaggeration) <= 1e6 && g.exaggeration != 0) return {};
  return fmt::format("the exaggeration is {:.6g}; allowed are -1e6 to 1e6, not 0", g.exaggeration);
}

std::string poseFault(const Pose& pose) {
  for (const double x : pose) {
    if (!(std::abs(x) <= 1e9))
      return fmt::format("the camera transform has the number {}; allowed are -1e9 to 1e9", x);
  }
  const auto row = [&](std::size_t r) {
    return Vector{pose[4 * r], pose[4 * r + 1], pose[4 * r + 2]};
  };
  const auto dot = [](const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  };
  const Vector a = row(0), b = row(1), c = row(2);
  const double det =
      a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  const double off =
      std::max({std::abs(dot(a, a) - 1), std::abs(dot(b, b) - 1), std::abs(dot(c, c) - 1),
                std::abs(dot(a, b)), std::abs(dot(b, c)), std::abs(dot(c, a)), std::abs(det - 1)});
  return off < 1e-3 ? "" : "the camera transform is not a rotation and a translation";
}

// Transforms a point to world coordinates and stores it in `out` (3 floats).
void place(const Pose& pose, const Vector& p, float* out) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &pose[4 * k];
    out[k] = static_cast<float>(row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]);
  }
}

}  // namespace

std::string faultOf(const RangeImage& image) {
  const Geometry& g = image.geometry;
  if (image.width < 2 || image.height < 2)
    return fmt::format("the image has {} x {} pixels; triangles need 2 x 2 at least", image.width,
                       image.height);
  if (image.pixels() > kMostPixels)
    return fmt::format("the image has {} pixels; allowed are {}", image.pixels(), kMostPixels);
  if (g.scanner == Scanner::kElevation) return elevationFault(g);
  if (const std::string fault = poseFault(g.T_world_scanner); !fault.empty()) return fault;
  if (g.scanner == Scanner::kRays) return {};
  return g.scanner == Scanner::kSpinning ? beamsFault(image) : anglesFault(g);
}

std::vector<float> pointsOf(const RangeImage& image, const Work& work) {
  std::vector<float> points;
  resizeHuge(points, 3 * image.pixels());
  const Geometry& g = image.geometry;
  const RayTable rays(image);
  forRows(work, image.height, [&](std::size_t row) {
    const double north = static_cast<double>(image.height - 1 - row) * g.cell_y;
    for (std::size_t column = 0; column < image.width; ++column) {
      const std::size_t pixel = row * image.width + column;
      const auto r = double{image.range[pixel]};
      if (g.scanner == Scanner::kElevation) {
        const Vector p{static_cast<double>(column) * g.cell_x, north, r * g.exaggeration};
        place(kIdentity, r == r ? p : Vector{r, r, r}, &points[3 * pixel]);
        continue;
      }
      const Vector ray = rays.at(row, column);
      place(g.T_world_scanner, {ray.x * r, ray.y * r, ray.z * r}, &points[3 * pixel]);
    }
  });
  return points;
}

std::vector<Beam> evenBeams(double vertical_rad, std::size_t rows) {
  std::vector<Beam> beams(rows);
  for (std::size_t r = 0; r < rows && rows > 1; ++r) {
    const double share = static_cast<double>(r) / static_cast<double>(rows - 1);
    beams[r].altitude_rad = vertical_rad * (0.5 - share);
  }
  return beams;
}

double stepOf(const RangeImage& image) {
  constexpr std::size_t kPairs = 4096;
  if (image.geometry.scanner == Scanner::kElevation) return 0;
  const RayTable rays(image);
  const std::size_t stride = std::max(std::size_t{1}, image.pixels() / kPairs) | 1U;
  std::vector<double> across, down;
  const auto add = [](std::vector<double>& angles, const Vector& a, const Vector& b) {
    const double angle = angleBetween(a, b);
    if (angle == angle) angles.push_back(angle);
  };
  for (std::size_t pixel = 0; pixel < image.pixels(); pixel += stride) {
    const std::size_t row = pixel / image.width, column = pixel % image.width;
    const Vector ray = rays.at(row, column);
    if (column + 1 < image.width) add(across, ray, rays.at(row, column + 1));
    if (row + 1 < image.height) add(down, ray, rays.at(row + 1, column));
  }
  return std::max(medianOf(across), medianOf(down));
}

bool isMirrored(const RangeImage& image) {
  if (image.geometry.scanner != Scanner::kRays) return false;
  const RayTable rays(image);
  std::ptrdiff_t right = 0;
  for (std::size_t row = 0; row + 1 < image.height; ++row) {
    for (std::size_t column = 0; column + 1 < image.width; ++column) {
      const Vector a = rays.at(row, column), b = rays.at(row, column + 1),
                   d = rays.at(row + 1, column);
      const double det = a.x * (d.y * b.z - d.z * b.y) + a.y * (d.z * b.x - d.x * b.z) +
                         a.z * (d.x * b.y - d.y * b.x);
      right += (det < 0) - (det > 0);  // a, d, b counter-clockwise as the scanner sees them
    }
  }
  return right < 0;
}

}  // namespace merlin::render::range
