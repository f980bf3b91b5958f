// View: what one range image says about points in space. Private to render/fuse.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/fuse/projection.h"
#include "render/range/range_image.h"
#include "render/range/threshold.h"
#include "render/range/work.h"

namespace merlin::render::fuse {

// What a scan says about a point.
struct Sight {
  enum class Kind : std::uint8_t {
    kNothing,  // outside the image, behind a surface, or beside a surface's edge
    kFree,     // the scanner saw through it
    kNear      // within the truncation of a surface
  };
  Kind kind = Kind::kNothing;
  // kNear: the distance from the surface, positive on the scanner's side [units].
  double distance = 0;
  // kNear: confidence x the squared cosine of the angle of incidence; behind the surface it falls
  // to 0 at the truncation. kFree: 1 if the ray meets a surface farther away, less at a surface's
  // edges.
  double weight = 0;
  // kNear: the pixels of the triangle that the ray meets, and the barycentric coordinates of the
  // point where it does.
  std::array<std::uint32_t, 3> pixels{};
  std::array<double, 3> shares{};
};

struct ViewSettings {
  range::Threshold max_edge{};       // of the scan's surface
  double truncation = 0;             // [units]
  bool background_is_empty = false;  // a ray without a return met nothing
};

// Thread-safe after construction. Keeps a reference to the image.
class View {
 public:
  // O(pixels); 14 bytes per pixel, and 100 during construction. REQUIRES: faultOf(image) and
  // inverseFaultOf(image) are empty.
  View(const range::RangeImage& image, const ViewSettings& settings, const range::Work& work);

  // `point`: in world coordinates. O(1).
  Sight at(const Point& point) const;

  const range::RangeImage& image() const noexcept { return image_; }
  // The points of the scan's surface, in world coordinates.
  template <typename Each>
  void forSurfacePoints(const Each& each) const {
    for (std::size_t pixel = 0; pixel < on_surface_.size(); ++pixel) {
      if (on_surface_[pixel]) each(toWorld(pointAt(pixel)));
    }
  }

 private:
  Point pointAt(std::size_t pixel) const {
    const float* p = &points_[3 * pixel];
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  }
  Point toScanner(const Point& world) const;
  Point toWorld(const Point& scanner) const;
  void findSurface(const range::Work& work);
  void findBackground();
  std::array<std::uint32_t, 4> cornersAt(std::size_t row, std::size_t column) const;
  Sight onTriangles(const std::array<std::uint32_t, 4>& corners, std::uint8_t lacking,
                    const Point& p) const;
  Sight fromPlane(const std::array<Point, 3>& corner, const Point& p, Sight sight) const;
  Sight besides(const std::array<std::uint32_t, 4>& corners, const Place& in_cell,
                const Point& p) const;
  double confidenceAt(const Sight& sight) const;

  const range::RangeImage& image_;
  ViewSettings settings_;
  Projection projection_;
  std::vector<float> points_{};        // pixels x 3, in the scanner's coordinates
  std::vector<std::uint8_t> cells_{};  // by pixel at the top left: bit k: a triangle lacks corner k
  std::vector<std::uint8_t> on_surface_{};  // by pixel
  std::vector<std::uint8_t> background_{};  // by pixel: 1 if its ray met nothing
  const range::Plane* confidence_ = nullptr;
  double most_confidence_ = 1;
};

}  // namespace merlin::render::fuse
