// Modalities: decides which features of a scanned mesh become planes of the range image, and
// computes their values. Private to render/scan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "render/scan/scan.h"

namespace merlin::render::scan {

// The point of the surface that a pixel of the range image shows.
struct Place {
  std::uint32_t triangle = 0;
  std::array<double, 3> barycentric{};  // weights of the triangle's corners
  double cosine = 0;                    // cosine of the angle of incidence, 0..1
};

class Modalities {
 public:
  // Adds the planes to the image, with all values 0. Keeps references to both arguments, which must
  // outlive it.
  Modalities(const Scene& scene, range::RangeImage& image);

  // Sets the values of one pixel in each plane. Several threads may call it at the same time for
  // different pixels.
  void set(std::size_t pixel, const Place& place);

  const std::vector<std::string>& leftOut() const noexcept { return left_out_; }

 private:
  enum class From { kInterpolated, kNearestCorner, kTexture, kIncidence };
  struct Source {
    From from;
    const mesh::Feature* feature;  // nullptr for kIncidence
  };

  void add(const mesh::Feature& feature);
  void addPlane(const std::string& name, std::size_t dimension, float high, const Source& source);
  // Returns component `k` of the feature, interpolated at the place.
  double at(const mesh::Feature& feature, const Place& place, std::size_t k) const;

  const Scene& scene_;
  range::RangeImage& image_;
  std::vector<Source> sources_;  // one per plane of the image
  std::vector<std::string> left_out_;
};

}  // namespace merlin::render::scan
