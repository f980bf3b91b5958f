// Surface: where the pixels of a picture lie in space: on a plane, or on a sphere around the
// viewer. Pure.
//
// A picture's pixels are those of its finest level, x to the right and y downwards from its upper
// left corner; a pixel's number may be a fraction.
#pragma once

#include <memory>

#include <Eigen/Geometry>

namespace merlin::render::content {

struct PixelRect {
  double left = 0, top = 0, right = 0, bottom = 0;
};

// One tile's view of a picture.
struct PictureView {
  Eigen::Matrix4d clip_from_metres = Eigen::Matrix4d::Identity();  // content coordinates to clip
  double width_px = 0, height_px = 0;                              // size of the tile [px]
};

// Immutable and reentrant.
class Surface {
 public:
  virtual ~Surface() = default;

  // Returns the position of a pixel, in content coordinates [m].
  virtual Eigen::Vector3d at(double x, double y) const = 0;
  // Returns whether any part of the rectangle may be visible; true in doubt.
  virtual bool maySee(const PictureView& view, const PixelRect& rect) const = 0;
  // Returns the largest size [px of the tile] that a pixel of the picture within the rectangle has
  // in the view. Infinite if the rectangle reaches behind the eye or is too large for an estimate.
  virtual double pixelSize(const PictureView& view, const PixelRect& rect) const = 0;
  // Returns the number of flat pieces, in each direction, into which the rectangle is divided for
  // drawing.
  virtual int pieces(const PixelRect& rect) const = 0;
  // Returns whether the picture's right edge joins its left one, as in a panorama.
  virtual bool joins() const = 0;
};

// A rectangle about the origin that faces +z, of the picture's shape; its half diagonal is
// `radius_m`. REQUIRES: width, height > 0 [px].
std::unique_ptr<const Surface> makePlane(double width, double height, double radius_m);

// A sphere about the origin; its inside shows the picture by its longitude and latitude
// (equirectangular): the middle lies at -z, the upper edge at +y. REQUIRES: width, height > 0 [px].
std::unique_ptr<const Surface> makePanorama(double width, double height, double radius_m);

}  // namespace merlin::render::content
