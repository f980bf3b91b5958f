// Projection: the inverse of a scanner's geometry; finds a point's position in the range image.
// Private to render/fuse.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render/range/range_image.h"

namespace merlin::render::fuse {

using Point = std::array<double, 3>;

inline double dot(const Point& a, const Point& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Point minus(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// A position in the image, in pixels from the centre of the first pixel.
struct Place {
  double column = 0, row = 0;
};

class Projection {
 public:
  // REQUIRES: faultOf(image) and inverseFaultOf(image) are empty.
  explicit Projection(const range::RangeImage& image);

  // Returns the position in the image of the ray through a point (in the scanner's coordinates);
  // nothing if the position is in no cell of 2 x 2 pixels. If the image covers a full turn, the
  // column may be between the last pixel and the width.
  std::optional<Place> at(const Point& point) const;

 private:
  std::optional<Place> inside(double column, double row) const;
  std::optional<Place> onSpinning(const Point& point) const;

  range::Scanner scanner_;
  double width_, height_;
  bool wraps_;
  // Columns and rows per radian, for kPinhole per unit of tangent.
  double per_column_ = 1, per_row_ = 1;
  std::vector<range::Beam> beams_{};  // one per row; only for kSpinning
};

// Returns why points cannot be projected into an image for which range::faultOf() finds no fault,
// as the end of a message. Empty if they can, i.e. if the scanner is orthogonal, pinhole, or
// spinning with rows from top to bottom. O(rows).
std::string inverseFaultOf(const range::RangeImage& image);

}  // namespace merlin::render::fuse
