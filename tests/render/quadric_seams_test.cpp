// Seams under the cost `quadric`: both sides are reduced together, so no crack opens at any level.
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "render/compare/compare.h"
#include "render/lod/dendrogram.h"
#include "render/mesh/mesh.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

// Enough vertices for a reduction in two parts.
constexpr std::uint32_t kAround = 200, kHigh = 120;

mesh::Mesh tube(bool cut) {
  mesh::Mesh mesh = test::tube(kAround, kHigh, cut);
  mesh::ensureNormals(mesh);
  return mesh;
}

struct Levels {
  explicit Levels(const mesh::Mesh& mesh, const reduce::ReduceSettings& settings = {})
      : made(lod::buildDendrogram(mesh, reduce::reduce(mesh, settings)->log)),
        all(mesh.triangleCount()) {}
  mesh::Mesh at(double share) const {
    return lod::extract(made,
                        made.levelFor(static_cast<std::size_t>(share * static_cast<double>(all))));
  }
  lod::Dendrogram made;
  std::size_t all;
};

using Place = std::array<float, 3>;

// Returns, for each border vertex except for those at the tube's two ends, how many vertices
// coincide at its position.
std::map<Place, int> seamOf(const mesh::Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t + k], b = mesh.triangles[t + (k + 1) % 3];
      ++sides[std::minmax(a, b)];
    }
  }
  std::set<std::uint32_t> border;
  for (const auto& [edge, n] : sides) {
    if (n == 1) border.insert({edge.first, edge.second});
  }
  std::map<Place, int> places;
  for (const std::uint32_t v : border) {
    const float* p = &mesh.positions[3 * std::size_t{v}];
    if (p[2] > 0.25F && p[2] < 5.75F) ++places[{p[0], p[1], p[2]}];
  }
  return places;
}

TEST(QuadricSeams, ShrinkAndNeverGape) {
  const Levels levels(tube(true));
  std::size_t before = kHigh;
  for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02}) {
    const std::map<Place, int> seam = seamOf(levels.at(share));
    std::size_t alone = 0;
    for (const auto& [place, n] : seam) alone += n != 2;
    EXPECT_LE(alone, 1U) << "but for a pair of which one side has gone, at " << share;
    EXPECT_LT(seam.size(), before) << share;
    before = seam.size();
  }
  EXPECT_LT(before, kHigh / 3);
}

// Returns the smallest cosine between the normals of coincident vertices; -1 if no vertices
// coincide.
float leastCosine(const mesh::Mesh& mesh) {
  std::map<Place, const float*> first;
  float least = 1;
  bool any = false;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float *p = &mesh.positions[3 * v], *n = &mesh.find("normal")->values[3 * v];
    const auto [other_at, alone] = first.emplace(Place{p[0], p[1], p[2]}, n);
    const float* other = other_at->second;
    any |= !alone;
    least = std::min(least, n[0] * other[0] + n[1] * other[1] + n[2] * other[2]);
  }
  return any ? least : -1;
}

TEST(QuadricSeams, AreNotSeenInTheLight) {
  const Levels levels(tube(true));
  EXPECT_GT(leastCosine(levels.at(1)), 0.99999F);
  for (const double share : {0.5, 0.2, 0.1})
    EXPECT_GT(leastCosine(levels.at(share)), 0.999F) << share;
}

TEST(QuadricSeams, CostLittle) {
  const mesh::Mesh whole = tube(false), cut = tube(true);
  compare::CompareSettings settings;
  settings.samples = 20'000;
  const auto of_whole = compare::compare(whole, Levels(whole).at(0.01), settings);
  const auto of_cut = compare::compare(whole, Levels(cut).at(0.01), settings);
  ASSERT_TRUE(of_whole && of_cut);
  EXPECT_LT(of_cut->symmetric().rms, 1.25 * of_whole->symmetric().rms);
}

TEST(QuadricSeams, AreTheSameForAnyNumberOfThreads) {
  const mesh::Mesh mesh = tube(true);
  const auto one = reduce::reduce(mesh, {.threads = 1}), two = reduce::reduce(mesh, {.threads = 2});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->log.children, two->log.children);
  EXPECT_EQ(one->log.positions, two->log.positions);
  EXPECT_EQ(one->log.features, two->log.features);
}

// If a user locks vertices, both sides of a seam may be meant, so seams must not move.
TEST(QuadricSeams, StayWhereVerticesAreLocked) {
  const mesh::Mesh mesh = tube(true);
  std::vector<bool> locked(mesh.vertexCount());
  locked[0] = true;
  const std::map<Place, int> seam = seamOf(Levels(mesh, {.locked = locked}).at(0.05));
  EXPECT_EQ(seam.size(), kHigh - 2 * 5 - 1);
  for (const auto& [place, n] : seam) EXPECT_EQ(n, 2);
}

}  // namespace
}  // namespace merlin::render
