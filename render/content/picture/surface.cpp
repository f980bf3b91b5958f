#include "render/content/picture/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace merlin::render::content {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

// Size in the view of a vector `step` (metres) that begins at `place`; infinite behind the eye. It
// is the derivative of the projection, so the length of `step` does not matter.
double sizeInView(const PictureView& view, const Eigen::Vector3d& place,
                  const Eigen::Vector3d& step) {
  const Eigen::Vector4d p = view.clip_from_metres * place.homogeneous();
  const Eigen::Vector4d d = view.clip_from_metres.leftCols<3>() * step;
  if (!(p.w() > 0)) return kInfinite;
  const double x = (d.x() * p.w() - p.x() * d.w()) / (p.w() * p.w()) * view.width_px / 2;
  const double y = (d.y() * p.w() - p.y() * d.w()) / (p.w() * p.w()) * view.height_px / 2;
  return std::hypot(x, y);
}

class Plane final : public Surface {
 public:
  Plane(double width, double height, double radius_m)
      : width_(width), height_(height), pixel_m_(2 * radius_m / std::hypot(width, height)) {}

  Eigen::Vector3d at(double x, double y) const override {
    return {(x - width_ / 2) * pixel_m_, (height_ / 2 - y) * pixel_m_, 0};
  }

  // False if all corners lie beyond one of the view's edges, or behind the eye.
  bool maySee(const PictureView& view, const PixelRect& rect) const override {
    std::array<int, 5> beyond{};
    for (const Eigen::Vector3d& corner : corners(rect)) {
      const Eigen::Vector4d p = view.clip_from_metres * corner.homogeneous();
      beyond[0] += p.x() < -p.w();
      beyond[1] += p.x() > p.w();
      beyond[2] += p.y() < -p.w();
      beyond[3] += p.y() > p.w();
      beyond[4] += !(p.w() > 0);
    }
    return std::ranges::none_of(beyond, [](int n) { return n == 4; });
  }

  double pixelSize(const PictureView& view, const PixelRect& rect) const override {
    const Eigen::Vector3d right(pixel_m_, 0, 0), down(0, -pixel_m_, 0);
    double size = 0;
    for (const Eigen::Vector3d& corner : corners(rect))
      size = std::max({size, sizeInView(view, corner, right), sizeInView(view, corner, down)});
    return size;
  }

  int pieces(const PixelRect& /*rect*/) const override { return 1; }
  bool joins() const override { return false; }

 private:
  std::array<Eigen::Vector3d, 4> corners(const PixelRect& r) const {
    return {at(r.left, r.top), at(r.right, r.top), at(r.left, r.bottom), at(r.right, r.bottom)};
  }

  double width_, height_, pixel_m_;
};

class Panorama final : public Surface {
 public:
  Panorama(double width, double height, double radius_m)
      : width_(width), height_(height), radius_m_(radius_m) {}

  Eigen::Vector3d at(double x, double y) const override {
    const double longitude = (x / width_ - 0.5) * 2 * kPi, latitude = (0.5 - y / height_) * kPi;
    const double level_m = radius_m_ * std::cos(latitude);
    return {level_m * std::sin(longitude), radius_m_ * std::sin(latitude),
            -level_m * std::cos(longitude)};
  }

  // Tests a sphere that encloses the rectangle against each edge of the view.
  bool maySee(const PictureView& view, const PixelRect& rect) const override {
    const Eigen::Vector3d middle = at((rect.left + rect.right) / 2, (rect.top + rect.bottom) / 2);
    const double half_angle = std::min((angleAcross(rect) + angleDown(rect)) / 2, kPi);
    const double reach_m = 2 * radius_m_ * std::sin(half_angle / 2);
    const Eigen::Matrix4d& m = view.clip_from_metres;
    for (const int axis : {0, 1, 3}) {
      for (const double side : {-1.0, 1.0}) {
        if (axis == 3 && side < 0) continue;
        Eigen::RowVector4d edge = m.row(3);  // w > 0
        if (axis < 3) edge += side * m.row(axis);
        const double away_m = edge * middle.homogeneous();
        if (away_m < -reach_m * edge.head<3>().norm()) return false;
      }
    }
    return true;
  }

  // Uses the height of the pixels, since their width shrinks towards the poles.
  double pixelSize(const PictureView& view, const PixelRect& rect) const override {
    constexpr double kTooLarge = kPi / 4;
    if (std::max(angleAcross(rect), angleDown(rect)) > kTooLarge) return kInfinite;
    double size = 0;
    for (const double x : {rect.left, (rect.left + rect.right) / 2, rect.right}) {
      for (const double y : {rect.top, (rect.top + rect.bottom) / 2, rect.bottom}) {
        const Eigen::Vector3d place = at(x, y);
        const Eigen::Vector3d down = at(x, y + 0.5) - at(x, y - 0.5);
        const Eigen::Vector3d across = place.cross(down).normalized() * down.norm();
        const double here =
            std::max(sizeInView(view, place, down), sizeInView(view, place, across));
        if (std::isfinite(here)) size = std::max(size, here);
      }
    }
    return size > 0 ? size : kInfinite;
  }

  // Each piece spans about 1.5 degrees, so that flat pieces are off by less than 1e-4 radians.
  int pieces(const PixelRect& rect) const override {
    constexpr double kPiece = 1.5 * kPi / 180;
    const double angle = std::max(angleAcross(rect), angleDown(rect));
    return std::clamp(static_cast<int>(std::ceil(angle / kPiece)), 1, 120);
  }
  bool joins() const override { return true; }

 private:
  double angleAcross(const PixelRect& r) const { return (r.right - r.left) / width_ * 2 * kPi; }
  double angleDown(const PixelRect& r) const { return (r.bottom - r.top) / height_ * kPi; }

  double width_, height_, radius_m_;
};

}  // namespace

std::unique_ptr<const Surface> makePlane(double width, double height, double radius_m) {
  return std::make_unique<Plane>(width, height, radius_m);
}

std::unique_ptr<const Surface> makePanorama(double width, double height, double radius_m) {
  return std::make_unique<Panorama>(width, height, radius_m);
}

}  // namespace merlin::render::content
