// Reduction in blocks, for meshes that do not fit into memory: the result is nearly as good as that
// of a reduction in one piece, with a single collapse log and without cracks.
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

// Returns a mesh that is flat on one side and hilly on the other.
mesh::Mesh hills(std::uint32_t size) {
  mesh::Mesh mesh = test::noisyGrid(size, size, 0.05, 3);
  const auto extent = static_cast<float>(size);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[3 * v];
    const float s = p[0] / extent;
    p[2] = s * s * (p[2] + 8 * std::sin(p[0] / 9) * std::cos(p[1] / 7));
  }
  mesh::ensureNormals(mesh);
  return mesh;
}

reduce::Reduction reduced(const mesh::Mesh& mesh, const reduce::ReduceSettings& settings) {
  auto result = reduce::reduce(mesh, settings);
  EXPECT_TRUE(result) << result.error().what;
  return *std::move(result);
}

// Returns settings with three quarters of the memory that a reduction in one piece takes.
reduce::ReduceSettings tight(const mesh::Mesh& mesh, reduce::ReduceSettings settings = {}) {
  settings.memory = reduce::needOf(mesh::sizeOf(mesh), settings).whole / 4 * 3;
  return settings;
}

TEST(Blocks, AreUsedOnlyWhereMemoryIsShort) {
  const mesh::Mesh mesh = hills(60);
  const std::size_t whole = reduce::needOf(mesh::sizeOf(mesh), {}).whole;
  EXPECT_EQ(reduced(mesh, {}).report.blocks, 1u);
  EXPECT_EQ(reduced(mesh, {.memory = whole}).report.blocks, 1u);
  EXPECT_GT(reduced(mesh, {.memory = whole - 1}).report.blocks, 1u);
}

TEST(Blocks, AreRefusedWhereNotEvenTheyFit) {
  const mesh::Mesh mesh = hills(60);
  const auto refused = reduce::reduce(mesh, {.memory = 100'000});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_NE(refused.error().what.find("the limit leaves 100000"), std::string::npos);
  const reduce::ReductionNeed need = reduce::needOf(mesh::sizeOf(mesh), {});
  EXPECT_TRUE(reduce::reduce(mesh, {.memory = need.least}));
  EXPECT_FALSE(reduce::reduce(mesh, {.memory = need.least - 1}));
  // The cost `pattern` cannot work in blocks.
  EXPECT_FALSE(reduce::reduce(mesh, {.cost = "pattern", .memory = need.least}));
}

TEST(JobNeed, IsThatOfTheStepThatTakesMost) {
  const mesh::MeshSize size{1'000'000, 2'000'000, 6};
  const reduce::ReductionNeed reduction = reduce::needOf(size, {});
  const reduce::JobNeed loaded = reduce::needOfJob(size, 0, {});
  EXPECT_EQ(loaded.besides, size.bytes() + (32U << 20));
  EXPECT_EQ(loaded.least, loaded.besides + reduction.least);
  // A file of 10 GB is in memory together with the mesh; normals are computed only after the file
  // has been released.
  EXPECT_EQ(reduce::needOfJob(size, 10'000'000'000, {}).least,
            10'000'000'000 + size.bytes() - 12 * size.vertices + (32U << 20));
}

TEST(Blocks, TheSameBytesForAnyNumberOfThreads) {
  const mesh::Mesh mesh = hills(250);
  const reduce::Reduction one = reduced(mesh, tight(mesh, {.threads = 1}));
  const reduce::Reduction three = reduced(mesh, tight(mesh, {.threads = 3}));
  EXPECT_EQ(one.log.children, three.log.children);
  EXPECT_EQ(one.log.positions, three.log.positions);
  EXPECT_EQ(one.log.features, three.log.features);
  EXPECT_EQ(one.log.error, three.log.error);
}

TEST(Blocks, EveryLevelIsAManifold) {
  const mesh::Mesh mesh = hills(120);
  const reduce::Reduction r = reduced(mesh, tight(mesh));
  EXPECT_LE(r.report.triangles, 2u);
  const lod::Dendrogram d = lod::buildDendrogram(mesh, r.log);
  ASSERT_TRUE(lod::Dendrogram::make(d.arrays(), nullptr));
  EXPECT_EQ(d.trianglesAt(d.levels() - 1), r.report.triangles);
  for (const std::size_t percent : {90U, 50U, 30U, 20U, 15U, 10U, 5U, 1U}) {
    mesh::Mesh coarse = lod::extract(d, d.levelFor(mesh.triangleCount() * percent / 100));
    const std::size_t before = coarse.triangleCount();
    mesh::tidy(coarse);
    EXPECT_EQ(coarse.triangleCount(), before) << percent << " %";
    const mesh::SplitReport split = mesh::splitNonManifold(coarse);
    EXPECT_EQ(split.edges + split.vertices, 0u) << percent << " %";
  }
}

// Block borders are reduced late. In a mesh as small as this one they have an eighth of the
// vertices kept, hence the tolerance.
TEST(Blocks, AreAsGoodAsTheWhole) {
  const mesh::Mesh mesh = hills(250);
  const reduce::Reduction whole = reduced(mesh, {}), blocks = reduced(mesh, tight(mesh));
  compare::CompareSettings settings;
  settings.samples = 5'000;
  settings.max_evaluations = 1;
  const auto rms = [&](const reduce::Reduction& r, std::size_t keep) {
    const lod::Dendrogram d = lod::buildDendrogram(mesh, r.log);
    return compare::compare(mesh, lod::extract(d, d.levelFor(keep)), settings)->symmetric().rms;
  };
  for (const std::size_t percent : {20U, 5U}) {
    const std::size_t keep = mesh.triangleCount() * percent / 100;
    EXPECT_LT(rms(blocks, keep), 1.15 * rms(whole, keep)) << percent << " %";
  }
}

TEST(Blocks, StopWhereTheyAreTold) {
  const mesh::Mesh mesh = hills(120);
  const reduce::Reduction by_count = reduced(mesh, tight(mesh, {.min_triangles = 3000}));
  EXPECT_GT(by_count.report.blocks, 1u);
  EXPECT_STREQ(by_count.report.stopped, "triangles");
  EXPECT_LE(by_count.report.triangles, 3000u);
  EXPECT_GE(by_count.report.triangles, 2999u);
  const reduce::Reduction by_error = reduced(mesh, tight(mesh, {.max_error_percent = 0.01}));
  EXPECT_STREQ(by_error.report.stopped, "error");
  EXPECT_LE(by_error.report.error, 0.0001F * mesh::boundingBox(mesh.positions).diagonal());
  std::size_t calls = 0;
  const auto cancelled = reduce::reduce(mesh, tight(mesh), [&](const reduce::ReduceProgress& p) {
    EXPECT_LE(p.triangles, mesh.triangleCount());
    return ++calls < 2;
  });
  ASSERT_TRUE(cancelled);
  EXPECT_STREQ(cancelled->report.stopped, "cancelled");
}

// A vertex on a border between blocks may move in at most one of the blocks that contain it.
TEST(BlockCutter, LocksWhatHasANeighbourOutside) {
  const mesh::Mesh mesh = hills(40);
  const std::vector<bool> none;
  const reduce::BlockCutter cutter(mesh, none, 2);
  const std::size_t half = (mesh.vertexCount() + 1) / 2;
  std::vector<reduce::Block> blocks = cutter.cut({half, half, 0, 1});
  ASSERT_EQ(blocks.size(), 2u);
  std::vector<int> free(mesh.vertexCount());
  std::size_t triangles = 0;
  for (const reduce::Block& b : blocks) {
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
  EXPECT_EQ(triangles, mesh.triangleCount());  // each triangle is in exactly one block
  EXPECT_LE(*std::max_element(free.begin(), free.end()), 1);
  EXPECT_GT(std::count(free.begin(), free.end(), 1), 1500);
}

}  // namespace
}  // namespace merlin::render
