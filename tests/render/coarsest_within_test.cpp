// The coarsest resolution within a given distance: it keeps the distance, and hardly any coarser
// one does. Also the curve of the error over the number of triangles.
#include "render/compare/coarsest_within.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/compare/compare.h"
#include "render/compare/error_curve.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

TEST(CoarsestWithin, KeepsItsPromiseAndIsNearlyTheCoarsest) {
  mesh::Mesh mesh = test::sphere(4);
  mesh::ensureNormals(mesh);
  const lod::Dendrogram model = lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
  double last_share = 0;
  std::size_t compared = 0;
  for (const double percent : {5.0, 1.0}) {
    last_share = 0;
    const auto found =
        compare::coarsestWithin(model, percent, [&](double share, std::size_t levels) {
          EXPECT_GE(share, last_share);
          last_share = share;
          compared = levels;
        });
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_EQ(last_share, 1);
    EXPECT_GT(compared, 3u);
    EXPECT_LE(found->percent, percent);
    const mesh::Mesh finest = lod::extract(model, 0);
    const auto distance = [&](std::size_t level) {
      const auto c = compare::compare(finest, lod::extract(model, level),
                                      {.samples = 1, .width_percent = 0.01});
      return 100 * c->symmetric().max.low / c->diagonal;
    };
    EXPECT_LE(distance(found->level), percent);
    const auto coarser =
        static_cast<std::size_t>(0.9 * static_cast<double>(model.trianglesAt(found->level)));
    EXPECT_GT(distance(model.levelFor(coarser)), 0.8 * percent) << "a tenth fewer would not do";
  }
}

TEST(ErrorCurve, HasThatManyLevelsPerHalvingAndTheCoarsestAndItsErrorsGrow) {
  mesh::Mesh mesh = test::sphere(4);
  mesh::ensureNormals(mesh);
  const lod::Dendrogram model = lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
  double last_share = 0;
  const auto curve = compare::errorCurve(model, 2, {.samples = 1000, .width_percent = 0.1},
                                         [&](double share, std::size_t) {
                                           EXPECT_GE(share, last_share);
                                           last_share = share;
                                         });
  ASSERT_TRUE(curve) << curve.error().what;
  EXPECT_DOUBLE_EQ(last_share, 1);
  ASSERT_GT(curve->points.size(), 8U);
  const auto all = static_cast<double>(model.triangleCount());
  EXPECT_NEAR(static_cast<double>(curve->points[0].triangles), all / std::sqrt(2), 4);
  EXPECT_NEAR(static_cast<double>(curve->points[1].triangles), all / 2, 4);
  EXPECT_EQ(curve->points.back().level, model.levels() - 1);
  for (std::size_t i = 1; i < curve->points.size(); ++i) {
    EXPECT_LT(curve->points[i].triangles, curve->points[i - 1].triangles);
    EXPECT_GE(curve->points[i].estimate, curve->points[i - 1].estimate);
  }
  EXPECT_GT(curve->points.back().error.rms, 10 * curve->points[0].error.rms);
  EXPECT_NEAR(curve->diagonal, 2 * std::sqrt(3), 0.01);
}

}  // namespace
}  // namespace merlin::render
