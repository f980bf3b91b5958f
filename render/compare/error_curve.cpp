#include "render/compare/error_curve.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::compare {
namespace {

// Selects the levels to compare with the finest one: `steps_an_octave` levels per halving of the
// number of triangles, and the coarsest level.
std::vector<std::size_t> levelsOf(const lod::Dendrogram& model, std::size_t steps_an_octave) {
  std::vector<std::size_t> levels;
  const auto all = static_cast<double>(model.triangleCount());
  const auto least = static_cast<double>(model.trianglesAt(model.levels() - 1));
  for (double step = 1;; ++step) {
    const double triangles = all * std::exp2(-step / static_cast<double>(steps_an_octave));
    if (triangles < std::max(least, 1.0)) break;
    const std::size_t level = model.levelFor(static_cast<std::size_t>(triangles));
    if (levels.empty() || levels.back() != level) levels.push_back(level);
  }
  const std::size_t coarsest = model.levels() - 1;
  if (levels.empty() || levels.back() != coarsest) levels.push_back(coarsest);
  return levels;
}

}  // namespace

Result<ErrorCurve> errorCurve(const lod::Dendrogram& model, std::size_t steps_an_octave,
                              const CompareSettings& settings,
                              const std::function<void(double, std::size_t)>& progress) {
  const std::vector<std::size_t> levels = levelsOf(model, steps_an_octave);
  const mesh::Mesh finest = lod::extract(model, 0);
  ErrorCurve curve;
  for (const std::size_t level : levels) {
    const auto done = static_cast<double>(curve.points.size());
    const auto compared =
        compare(finest, lod::extract(model, level), settings, [&](const CompareProgress& p) {
          progress((done + p.share) / static_cast<double>(levels.size()), curve.points.size());
          return true;
        });
    if (!compared) return compared.error();
    curve.diagonal = compared->diagonal;
    curve.points.push_back({level, model.trianglesAt(level),
                            static_cast<double>(model.errorAt(level)), compared->symmetric()});
  }
  progress(1, curve.points.size());
  return curve;
}

}  // namespace merlin::render::compare
