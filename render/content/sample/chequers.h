// A sample content to be copied for a new kind of content: a chequered plane. It is compiled and
// tested, but the wall does not show it. It has detail steps with costs and a renderer that draws
// in slices, without the complexity of a model.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/content/content.h"

namespace merlin::render::content {

// Step s has (64 >> s) squares in each direction; the coarsest has two.
class ChequersDetail final : public DetailAxis {
 public:
  std::size_t steps() const noexcept override { return 6; }
  std::size_t costOf(std::size_t step) const noexcept override { return side(step) * side(step); }
  std::size_t stepWithin(std::size_t budget) const noexcept override;
  std::size_t leastUseful() const noexcept override { return 4; }
  std::string_view unit() const noexcept override { return "squares"; }

  static std::size_t side(std::size_t step) noexcept { return std::size_t{64} >> step; }
};

// An upright square, two metres wide and high, with its centre at the origin.
class Chequers final : public Content {
 public:
  const DetailAxis& detail() const noexcept override { return detail_; }
  ContentBounds bounds() const noexcept override;
  Navigation navigation() const noexcept override { return Navigation::kPlane; }
  void choose(std::size_t step, std::span<const ContentView> views) override;
  Result<std::unique_ptr<ContentRenderer>> attach(const gl::GlApi& gl) const override;

  // The squares that the renderers draw.
  struct Chosen {
    // The vertices: x [m], y [m], brightness 0..1. Each square has six: the corners of its two
    // triangles.
    std::vector<std::array<float, 3>> corners;
    std::vector<Eigen::Matrix4f> views;  // clip_from_metres of each view, by tile number
  };

 private:
  ChequersDetail detail_;
  Chosen chosen_;
};

}  // namespace merlin::render::content
