#include "render/content/sample/chequers.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::content {

std::size_t ChequersDetail::stepWithin(std::size_t budget) const noexcept {
  std::size_t step = 0;
  while (step + 1 < steps() && costOf(step) > budget) ++step;
  return step;
}

ContentBounds Chequers::bounds() const noexcept {
  ContentBounds bounds{std::sqrt(2.0F), Eigen::Matrix4f::Identity()};
  bounds.T_content_box(2, 2) = 0;  // flat
  return bounds;
}

void Chequers::choose(std::size_t step, std::span<const ContentView> views) {
  const std::size_t side = ChequersDetail::side(step);
  const float size = 2.0F / static_cast<float>(side);
  chosen_.corners.clear();
  for (std::size_t i = 0; i < side * side; ++i) {
    const float x = size * static_cast<float>(i % side) - 1;
    const float y = size * static_cast<float>(i / side) - 1;
    const float bright = (i % side + i / side) % 2 == 0 ? 1.0F : 0.25F;
    for (const auto& [right, up] :
         {std::array{0.F, 0.F}, {1.F, 0.F}, {1.F, 1.F}, {0.F, 0.F}, {1.F, 1.F}, {0.F, 1.F}})
      chosen_.corners.push_back({x + size * right, y + size * up, bright});
  }
  for (const ContentView& view : views) {
    chosen_.views.resize(std::max(chosen_.views.size(), view.tile + 1));
    chosen_.views[view.tile] = view.clip_from_metres;
  }
}

}  // namespace merlin::render::content
