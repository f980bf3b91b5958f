// View: evaluates one range image at points in space. Private to render/fuse.
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

// The information that a scan gives about a point.
struct Sight {
  enum class Kind : std::uint8_t {
    kNothing,  // outside the image, behind a surface, or beside a surface's edge
    kFree,     // the scanner saw through the point
    kNear      // within the truncation distance of a surface
  };
  Kind kind = Kind::kNothing;
  // Only for kNear: the distance from the surface, positive on the scanner's side [units].
  double distance = 0;
  // For kNear: confidence times the squared cosine of the angle of incidence; behind the surface it
  // falls to 0 at the truncation distance. For kFree: 1 if the ray meets a surface farther away,
  // less at a surface's edges.
  double weight = 0;
  // Only for kNear: the pixels of the triangle that the ray meets, and the barycentric coordinates
  // of the point where it meets the triangle.
  std::array<std::uint32_t, 3> pixels{};
  std::array<double, 3> shares{};
};

struct ViewSettings {
  range::Threshold max_edge{};       // longest edge of the scan's surface
  double truncation = 0;             // truncation distance [units]
  bool background_is_empty = false;  // true: a ray without a return is assumed to have met nothing
};

// Thread-safe after construction. Keeps a reference to the image, which must outlive it.
class View {
 public:
  // O(pixels); takes 14 bytes per pixel, 15 with background_is_empty, and about 100 during
  // construction. REQUIRES: faultOf(image) and inverseFaultOf(image) are empty.
  View(const range::RangeImage& image, const ViewSettings& settings, const range::Work& work);

  // Returns the information that the scan gives about `point` (world coordinates). O(1), for
  // kSpinning O(log rows).
  Sight at(const Point& point) const;

  const range::RangeImage& image() const noexcept { return image_; }
  // Calls each(point) for the points of the scan's surface, in world coordinates.
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
  std::vector<float> points_{};  // pixels x 3, in the scanner's coordinates
  // By top left pixel of a cell; bit k: the triangle without corner k exists.
  std::vector<std::uint8_t> cells_{};
  std::vector<std::uint8_t> on_surface_{};  // by pixel: 1 if it is in a triangle
  // By pixel: 1 if the pixel's ray met nothing; empty unless background_is_empty.
  std::vector<std::uint8_t> background_{};
  const range::Plane* confidence_ = nullptr;
  double most_confidence_ = 1;
};

}  // namespace merlin::render::fuse
