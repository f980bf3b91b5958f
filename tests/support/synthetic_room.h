// A synthetic room: projectors with known pose, lens, gamma, colour and black level project signals
// onto plane panels, and a camera with known pose photographs them. All data are computed; none is
// measured.
//
// Coordinates are those of render/room: x to the right, y up, z towards the viewer [m].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace merlin::test {

using Light = Eigen::Array3d;  // red, green, blue; 1 is the full brightness of a perfect projector

// A rectangle in the room, seen from its front.
struct Panel {
  Eigen::Vector3d upper_left, right, down;  // `right` and `down` are unit vectors
  double width = 0, height = 0;             // [m]

  Eigen::Vector3d at(double x, double y) const { return upper_left + x * right + y * down; }
};

// A pinhole with radial distortion, for projectors and cameras. Pixel coordinates count from the
// upper left.
struct Lens {
  Eigen::Vector3d place;
  Eigen::Matrix3d R_lens_room;   // the lens looks along +z, x to the right, y down
  double focal = 1;              // [px]
  Eigen::Vector2d centre{0, 0};  // [px]; lens shift moves it away from the middle of the raster
  double distortion = 0;         // factor of r^2, with r in focal lengths

  Eigen::Vector2d normalised(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = R_lens_room * (point - place);
    const Eigen::Vector2d n = p.head<2>() / p.z();
    return n * (1 + distortion * n.squaredNorm());
  }
  Eigen::Vector2d pixelOf(const Eigen::Vector3d& point) const {
    return focal * normalised(point) + centre;
  }
  // Returns the direction of the ray through a pixel, in room coordinates. REQUIRES: no distortion.
  Eigen::Vector3d rayOf(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d n = (pixel - centre) / focal;
    return R_lens_room.transpose() * Eigen::Vector3d(n.x(), n.y(), 1);
  }
};

// Returns a lens at `place` that is aimed at `target` and turned by `roll_deg` about the line of
// sight.
Lens lensAt(const Eigen::Vector3d& place, const Eigen::Vector3d& target, double roll_deg);

// A projector, and the part of a panel that its picture has to cover.
struct Projector {
  Lens lens;
  int width = 0, height = 0;  // [px]
  Panel panel;
  std::array<double, 4> part{};        // left, top, width, height on the panel [m]
  Light gamma{2.2, 2.2, 2.2};          // light = signal ^ gamma
  Light full{1, 1, 1};                 // light of a white signal
  double black = 0;                    // light of a black signal, as a share of `full`
  std::vector<std::uint8_t> signal{};  // RGB, width * height pixels

  // Returns the place in the room of a point [px] of the uncorrected picture.
  Eigen::Vector3d placeOf(double x, double y) const {
    return panel.at(part[0] + part[2] * x / width, part[1] + part[3] * y / height);
  }
  Eigen::Vector2d pixelSize() const { return {part[2] / width, part[3] / height}; }  // [m]

  // Sets focal length and lens shift so that the raster covers its part of the panel, with `margin`
  // pixels to spare.
  void zoom(double margin);

  // The point in the room onto which a point of the raster [px] falls.
  Eigen::Vector3d target(const Eigen::Vector2d& pixel) const;

  Light lightOf(int x, int y) const;
  // Returns the light at a point of the projector's panel. The pixels are evenly bright and
  // slightly out of focus.
  Light lightAt(const Eigen::Vector3d& point) const;
};

// A photograph of the room, taken with a linear sensor.
class Photograph {
 public:
  // Only projectors whose entry in `lit` is true throw light; the others are covered.
  Photograph(const Lens& camera, int width, int height, const std::vector<Panel>& panels,
             const std::vector<Projector>& projectors, const std::vector<bool>& lit);

  // Returns the light at a point of the room, interpolated between the four nearest pixels.
  Light at(const Eigen::Vector3d& point) const;

  // Returns the photograph for display on a screen (RGBA, gamma 2.2).
  std::vector<std::uint8_t> pixels() const;

 private:
  const Light& pixel_(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y * width_ + x)];
  }
  Light seen(const Eigen::Vector2d& pixel, const std::vector<Panel>& panels,
             const std::vector<Projector>& projectors, const std::vector<bool>& lit) const;

  Lens camera_;
  int width_, height_;
  std::vector<Light> pixels_;
};

// Finds a bright line that crosses the segment from `place` - reach to `place` + reach. Returns its
// offset along the segment, as a share of `reach`; nothing if there is no line.
std::optional<double> findLine(const Photograph& photograph, const Eigen::Vector3d& place,
                               const Eigen::Vector3d& reach);

}  // namespace merlin::test
