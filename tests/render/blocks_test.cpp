// Reduction in blocks, for want of memory: as good as of the whole, one log, nothing torn.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "render/compare/compare.h"
#include "render/lod/dendrogram.h"
#include "render/mesh/non_manifold.h"
#include "render/reduce/memory.h"
#include "render/reduce/out_of_core/block_cutter.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

// Flat on one side, hilly on the other.
Mesh hills(std::uint32_t size) {
  Mesh mesh = test::noisyGrid(size, size, 0.05, 3);
  const auto extent = static_cast<float>(size);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[3 * v];
    const float s = p[0] / extent;
    p[2] = s * s * (p[2] + 8 * std::sin(p[0] / 9) * std::cos(p[1] / 7));
  }
  ensureNormals(mesh);
  return mesh;
}

Reduction reduced(const Mesh& mesh, const ReduceSettings& settings) {
  auto result = reduce(mesh, settings);
  EXPECT_TRUE(result) << result.error().what;
  return *std::move(result);
}

// Settings that leave three quarters of what the whole takes.
ReduceSettings tight(const Mesh& mesh, ReduceSettings settings = {}) {
  settings.memory = needOf(sizeOf(mesh), settings).whole / 4 * 3;
  return settings;
}

TEST(Blocks, AreUsedOnlyWhereMemoryIsShort) {
  const Mesh mesh = hills(60);
  const std::size_t whole = needOf(sizeOf(mesh), {}).whole;
  EXPECT_EQ(reduced(mesh, {}).report.blocks, 1u);
  EXPECT_EQ(reduced(mesh, {.memory = whole}).report.blocks, 1u);
  EXPECT_GT(reduced(mesh, {.memory = whole - 1}).report.blocks, 1u);
}

TEST(Blocks, AreRefusedWhereNotEvenTheyFit) {
  const Mesh mesh = hills(60);
  const auto refused = reduce(mesh, {.memory = 100'000});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_NE(refused.error().what.find("the limit leaves 100000"), std::string::npos);
  const ReductionNeed need = needOf(sizeOf(mesh), {});
  EXPECT_TRUE(reduce(mesh, {.memory = need.least}));
  EXPECT_FALSE(reduce(mesh, {.memory = need.least - 1}));
  EXPECT_FALSE(reduce(mesh, {.cost = "pattern", .memory = need.least}));  // has no blocks
}

TEST(Blocks, TheSameBytesForAnyNumberOfThreads) {
  const Mesh mesh = hills(250);
  const Reduction one = reduced(mesh, tight(mesh, {.threads = 1}));
  const Reduction three = reduced(mesh, tight(mesh, {.threads = 3}));
  EXPECT_EQ(one.log.children, three.log.children);
  EXPECT_EQ(one.log.positions, three.log.positions);
  EXPECT_EQ(one.log.features, three.log.features);
  EXPECT_EQ(one.log.error, three.log.error);
}

TEST(Blocks, EveryLevelIsAManifold) {
  const Mesh mesh = hills(120);
  const Reduction r = reduced(mesh, tight(mesh));
  EXPECT_LE(r.report.triangles, 2u);
  const Dendrogram d = buildDendrogram(mesh, r.log);
  ASSERT_TRUE(Dendrogram::make(d.arrays(), nullptr));
  EXPECT_EQ(d.trianglesAt(d.levels() - 1), r.report.triangles);
  for (const std::size_t percent : {90U, 50U, 30U, 20U, 15U, 10U, 5U, 1U}) {
    Mesh coarse = extract(d, d.levelFor(mesh.triangleCount() * percent / 100));
    const std::size_t before = coarse.triangleCount();
    tidy(coarse);
    EXPECT_EQ(coarse.triangleCount(), before) << percent << " %";
    const SplitReport split = splitNonManifold(coarse);
    EXPECT_EQ(split.edges + split.vertices, 0u) << percent << " %";
  }
}

// Borders stay as fine as they were for a while: in so small a mesh an eighth of what is kept.
TEST(Blocks, AreAsGoodAsTheWhole) {
  const Mesh mesh = hills(250);
  const Reduction whole = reduced(mesh, {}), blocks = reduced(mesh, tight(mesh));
  CompareSettings settings;
  settings.samples = 5'000;
  settings.max_evaluations = 1;
  const auto rms = [&](const Reduction& r, std::size_t keep) {
    const Dendrogram d = buildDendrogram(mesh, r.log);
    return compare(mesh, extract(d, d.levelFor(keep)), settings)->symmetric().rms;
  };
  for (const std::size_t percent : {20U, 5U}) {
    const std::size_t keep = mesh.triangleCount() * percent / 100;
    EXPECT_LT(rms(blocks, keep), 1.15 * rms(whole, keep)) << percent << " %";
  }
}

TEST(Blocks, StopWhereTheyAreTold) {
  const Mesh mesh = hills(120);
  const Reduction by_count = reduced(mesh, tight(mesh, {.min_triangles = 3000}));
  EXPECT_GT(by_count.report.blocks, 1u);
  EXPECT_STREQ(by_count.report.stopped, "triangles");
  EXPECT_LE(by_count.report.triangles, 3000u);
  EXPECT_GE(by_count.report.triangles, 2999u);
  const Reduction by_error = reduced(mesh, tight(mesh, {.max_error_percent = 0.01}));
  EXPECT_STREQ(by_error.report.stopped, "error");
  EXPECT_LE(by_error.report.error, 0.0001F * boundingBox(mesh.positions).diagonal());
  std::size_t calls = 0;
  const auto cancelled = reduce(mesh, tight(mesh), [&](const ReduceProgress& p) {
    EXPECT_LE(p.triangles, mesh.triangleCount());
    return ++calls < 2;
  });
  ASSERT_TRUE(cancelled);
  EXPECT_STREQ(cancelled->report.stopped, "cancelled");
}

// A block's border is a vertex wide, and moves no more than where it is fixed.
TEST(BlockCutter, LocksWhatHasANeighbourOutside) {
  const Mesh mesh = hills(40);
  const std::vector<bool> none;
  const BlockCutter cutter(mesh, none, 2);
  const std::size_t half = (mesh.vertexCount() + 1) / 2;
  std::vector<Block> blocks = cutter.cut({half, half, 0, 1});
  ASSERT_EQ(blocks.size(), 2u);
  std::vector<int> free(mesh.vertexCount());
  std::size_t triangles = 0;
  for (const Block& b : blocks) {
    triangles += b.mesh.triangleCount();
    EXPECT_TRUE(validate(b.mesh));
    std::vector<std::size_t> whole(mesh.vertexCount()), here(mesh.vertexCount());
    for (const std::uint32_t v : mesh.triangles) ++whole[v];
    for (const std::uint32_t v : b.mesh.triangles) ++here[b.vertices[v]];
    for (std::size_t i = 0; i < b.vertices.size(); ++i) {
      if (b.locked[i]) continue;
      ++free[b.vertices[i]];
      EXPECT_EQ(here[b.vertices[i]], whole[b.vertices[i]]);
    }
  }
  EXPECT_EQ(triangles, mesh.triangleCount());  // each has two corners in one half
  EXPECT_LE(*std::max_element(free.begin(), free.end()), 1);
  EXPECT_GT(std::count(free.begin(), free.end(), 1), 1500);
}

}  // namespace
}  // namespace merlin::render
