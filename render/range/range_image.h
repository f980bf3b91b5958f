// RangeImage: distances, depths or heights on a grid of pixels, with registered images of other
// modalities, and the geometry that converts them to points.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::render::range {

// The type of a scanner, which determines how pixels become rays; README.md defines the
// coordinates.
enum class Scanner {
  kOrthogonal,  // two mirrors: [GOURLEY98] A.15 to A.17
  kSpinning,    // a head that turns about the vertical, with a table of beams
  kPinhole,     // a camera; the range is the depth along its axis
  kElevation,   // a map seen from above; the range is the height
  kRays         // a ray for each pixel
};

// The angles of one row of a spinning scanner.
struct Beam {
  double altitude_rad = 0;  // angle above the horizon
  double azimuth_rad = 0;   // angle added to the azimuth of each column
};

// A rigid transform, stored as three rows of four numbers: world = rotation x scanner +
// translation.
using Pose = std::array<double, 12>;
inline constexpr Pose kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct Geometry {
  Scanner scanner = Scanner::kOrthogonal;
  // kOrthogonal: angle from the first to the last pixel. kPinhole: field of view, from edge to
  // edge. kSpinning: only `horizontal_rad`, the angle over which all columns are spread.
  double horizontal_rad = 0, vertical_rad = 0;
  std::vector<Beam> beams{};      // kSpinning: one per row, the top one first
  double cell_x = 1, cell_y = 1;  // kElevation: distances of columns and of rows [units]
  double exaggeration = 1;        // kElevation: factor of the heights
  std::vector<float> rays{};      // kRays: pixels x 3, unit vectors, NaN where there is no return
  Pose T_world_scanner = kIdentity;  // kElevation: unused
  // kElevation: the projection as text (WKT; empty: unknown); and the origin, i.e. the coordinates,
  // in units of the projection, of the middle of the lower left pixel, which is the point (0, 0) of
  // the mesh.
  std::string projection{};
  std::optional<std::array<double, 2>> origin{};
};

// A registered image: `dimension` floats per pixel of the range image.
struct Plane {
  std::string name;  // name of the feature that the plane becomes
  std::size_t dimension = 1;
  std::vector<float> values{};
  std::string unit{};       // empty: unknown
  float low = 0, high = 0;  // range of possible values; if equal, the range is unknown
};

struct RangeImage {
  std::size_t width = 0, height = 0;
  std::vector<float> range{};  // one per pixel, rows from top to bottom [units]; NaN: no return
  Geometry geometry{};
  std::vector<Plane> planes{};

  std::size_t pixels() const noexcept { return width * height; }
  // Returns the memory of the ranges, the planes and the rays [bytes].
  std::size_t bytes() const noexcept {
    std::size_t numbers = range.size() + geometry.rays.size();
    for (const Plane& plane : planes) numbers += plane.values.size();
    return sizeof(float) * numbers;
  }
  bool join_ends = true;  // false: a full turn has a seam, which a texture needs
  std::string unit{};     // unit of the ranges, such as "m"; empty: unknown

  // Returns whether the last and the first column are neighbours, as in a full turn of a spinning
  // scanner.
  bool wraps() const noexcept {
    return join_ends && geometry.scanner == Scanner::kSpinning && width > 2 &&
           std::abs(geometry.horizontal_rad - 2 * std::numbers::pi) < 1e-6;
  }
  const Plane* find(std::string_view name) const noexcept {
    for (const Plane& plane : planes) {
      if (plane.name == name) return &plane;
    }
    return nullptr;
  }
};

inline constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();
// Ranges and heights whose magnitude is above this count as no return [units].
inline constexpr float kFarthest = 1e9F;
// Maximum number of pixels of an image, so that 32-bit indices suffice for four vertices per pixel.
inline constexpr std::size_t kMostPixels = std::size_t{1} << 28;

inline bool isReturn(float range) noexcept { return range == range; }  // not NaN

}  // namespace merlin::render::range
