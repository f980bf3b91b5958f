// A sample of a content, compiled and tested, to be copied: a chequered plane. It has detail steps,
// a cost, a renderer that draws in slices, and nothing of a model. The wall does not show it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/content/content.h"

namespace merlin::render {

// Step s has (64 >> s) squares each way; the coarsest has two.
class ChequersDetail final : public DetailAxis {
 public:
  std::size_t steps() const noexcept override { return 6; }
  std::size_t costOf(std::size_t step) const noexcept override { return side(step) * side(step); }
  std::size_t stepWithin(std::size_t budget) const noexcept override;
  std::size_t leastUseful() const noexcept override { return 4; }
  std::string_view unit() const noexcept override { return "squares"; }

  static std::size_t side(std::size_t step) noexcept { return std::size_t{64} >> step; }
};

// Two metres wide and high, upright, its middle at the origin.
class Chequers final : public Content {
 public:
  const DetailAxis& detail() const noexcept override { return detail_; }
  ContentBounds bounds() const noexcept override;
  Navigation navigation() const noexcept override { return Navigation::kPlane; }
  void choose(std::size_t step, std::span<const ContentView> views) override;
  Result<std::unique_ptr<ContentRenderer>> attach(const GlApi& gl) const override;

  // The squares that the renderers draw.
  struct Chosen {
    std::vector<std::array<float, 3>> corners;  // x, y, brightness; six of each square
    std::vector<Eigen::Matrix4f> views;         // clip from metres, by number of the tile
  };

 private:
  ChequersDetail detail_;
  Chosen chosen_;
};

}  // namespace merlin::render
