#include "render/compare/coarsest_within.h"

#include <cmath>

#include "render/compare/compare.h"

namespace merlin::render::compare {

Result<LevelWithError> coarsestWithin(const lod::Dendrogram& model, double percent,
                                      const std::function<void(double, std::size_t)>& progress) {
  constexpr double kNearEnough = 1.02;
  std::size_t compared_so_far = 0;
  const mesh::Mesh finest = lod::extract(model, 0);
  const CompareSettings settings{.samples = 1, .width_percent = percent / 20};
  LevelWithError best;
  auto too_few = static_cast<double>(model.trianglesAt(model.levels() - 1)) / kNearEnough;
  auto enough = static_cast<double>(model.triangleCount());
  const double span = std::log(enough / too_few);
  while (enough > kNearEnough * too_few) {
    const double triangles = std::sqrt(too_few * enough);
    const std::size_t level = model.levelFor(static_cast<std::size_t>(triangles));
    const auto compared = compare(finest, lod::extract(model, level), settings, [&](const auto&) {
      progress(1 - std::log(enough / too_few) / span, compared_so_far);
      return true;
    });
    if (!compared) return compared.error();
    ++compared_so_far;
    const double at_most = compared->symmetric().max.high;
    if (const double reached = 100 * at_most / compared->diagonal; reached <= percent) {
      best = {level, at_most, reached};
      enough = triangles;
    } else {
      too_few = triangles;
    }
  }
  progress(1, compared_so_far);
  return best;
}

}  // namespace merlin::render::compare
