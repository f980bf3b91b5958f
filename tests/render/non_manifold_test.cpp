#include "render/mesh/non_manifold.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "render/mesh/coincident.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Indices = std::vector<std::uint32_t>;
using Floats = std::vector<float>;

// Returns a mesh with its vertices on a helix, so that no three are collinear and no two coincide.
mesh::Mesh meshOf(std::uint32_t vertices, Indices triangles) {
  mesh::Mesh mesh;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const auto x = static_cast<float>(v);
    mesh.positions.insert(mesh.positions.end(), {std::cos(x), std::sin(x), 0.1F * x});
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

std::string textOf(const mesh::SplitReport& r) {
  return std::to_string(r.edges) + " edges, " + std::to_string(r.vertices) + " vertices, " +
         std::to_string(r.added) + " added";
}

// Checks the definition of a manifold directly: an edge has at most two triangles, in opposite
// directions, and the triangles around a vertex are connected over edges at that vertex.
bool isManifold(const mesh::Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> ways;
  std::vector<std::vector<std::size_t>> stars(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (++ways[{a, b}] > 1) return false;
    stars[a].push_back(i / 3);
  }
  for (std::uint32_t v = 0; v < stars.size(); ++v) {
    const auto others = [&](std::size_t t) {
      std::set<std::uint32_t> o(&mesh.triangles[3 * t], &mesh.triangles[3 * t] + 3);
      o.erase(v);
      return o;
    };
    std::vector<std::size_t> fan, left = stars[v];
    if (left.empty()) continue;
    fan.push_back(left.back());
    left.pop_back();
    for (std::size_t i = 0; i < fan.size(); ++i) {
      for (std::size_t k = left.size(); k-- > 0;) {
        const auto a = others(fan[i]), b = others(left[k]);
        if (std::none_of(a.begin(), a.end(), [&](std::uint32_t o) { return b.count(o); })) continue;
        fan.push_back(left[k]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
    if (!left.empty()) return false;
  }
  return true;
}

TEST(SplitNonManifold, LeavesAManifoldAsItIs) {
  for (const mesh::Mesh& mesh : {test::cube(), test::grid(5, 4), test::sphere(2),
                                 test::together(test::cube(), test::grid(1, 1)), mesh::Mesh{}}) {
    mesh::Mesh split = mesh;
    EXPECT_EQ(textOf(mesh::splitNonManifold(split)), "0 edges, 0 vertices, 0 added");
    EXPECT_EQ(split.triangles, mesh.triangles);
    EXPECT_EQ(split.positions, mesh.positions);
  }
}

TEST(SplitNonManifold, TakesABowTieApart) {
  mesh::Mesh mesh = meshOf(5, {0, 1, 2, 0, 3, 4});
  mesh.features = {{"heat", 1, {7, 1, 2, 3, 4}}, {"flow", 2, {8, 9, 0, 0, 0, 0, 0, 0, 0, 0}}};
  EXPECT_EQ(textOf(mesh::splitNonManifold(mesh)), "0 edges, 1 vertices, 1 added");
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 2, 5, 3, 4}));
  EXPECT_EQ(mesh::coincidentVertices(mesh.positions), (Indices{5, 1, 2, 3, 4, 0}));
  EXPECT_EQ(mesh.features[0].values, (Floats{7, 1, 2, 3, 4, 7}));
  EXPECT_EQ((Floats{mesh.features[1].values.end() - 2, mesh.features[1].values.end()}),
            (Floats{8, 9}));
}

// Two triangles share the edge 0 1, and a third one (a fin) stands on that edge.
TEST(SplitNonManifold, TakesAFinFromASheet) {
  for (const bool fin_first : {false, true}) {
    mesh::Mesh mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0.5F, 1, 0, 0.5F, -1, 0, 0.5F, 0.1F, 1};
    mesh.triangles = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    if (fin_first) mesh.triangles = {0, 1, 4, 0, 1, 2, 1, 0, 3};
    EXPECT_EQ(textOf(mesh::splitNonManifold(mesh)), "1 edges, 2 vertices, 2 added");
    const Indices sheet_first{0, 1, 2, 1, 0, 3, 5, 6, 4}, sheet_last{0, 1, 4, 5, 6, 2, 6, 5, 3};
    EXPECT_EQ(mesh.triangles, fin_first ? sheet_last : sheet_first)
        << "the flat ones stay together";
    EXPECT_TRUE(isManifold(mesh));
  }
}

// A wall stands on the middle line of a floor; the floor must stay in one piece.
TEST(SplitNonManifold, KeepsAFloorWholeUnderAWall) {
  mesh::Mesh mesh = test::grid(6, 2);
  const std::size_t floor = mesh.triangles.size();
  for (std::uint32_t x = 0; x < 6; ++x) {
    const std::uint32_t a = 7 + x, b = a + 1, top = static_cast<std::uint32_t>(mesh.vertexCount());
    mesh.positions.insert(mesh.positions.end(), {static_cast<float>(x) + 0.5F, 1, 1});
    mesh.triangles.insert(mesh.triangles.end(), {a, b, top});
  }
  const mesh::Mesh before = mesh;
  EXPECT_EQ(mesh::splitNonManifold(mesh).edges, 6u);
  EXPECT_TRUE(isManifold(mesh));
  EXPECT_TRUE(std::equal(mesh.triangles.begin(),
                         mesh.triangles.begin() + static_cast<std::ptrdiff_t>(floor),
                         before.triangles.begin()));
}

// A Moebius strip of 5 quads has no consistent orientation.
TEST(SplitNonManifold, CutsAMoebiusStripOnce) {
  mesh::Mesh mesh;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const float a = 2 * 3.14159265F * static_cast<float>(i) / 5;
    for (const float side : {-0.3F, 0.3F}) {
      const float r = 1 + side * std::cos(a / 2);
      mesh.positions.insert(mesh.positions.end(),
                            {r * std::cos(a), r * std::sin(a), side * std::sin(a / 2)});
    }
    const std::uint32_t p = 2 * i, q = p + 1;
    const std::uint32_t r = i == 4 ? 1 : p + 2, s = i == 4 ? 0 : p + 3;
    mesh.triangles.insert(mesh.triangles.end(), {p, r, q, q, r, s});
  }
  EXPECT_EQ(textOf(mesh::splitNonManifold(mesh)), "1 edges, 2 vertices, 2 added");
  EXPECT_TRUE(isManifold(mesh));
}

TEST(SplitNonManifold, CutsBetweenNeighboursThatFaceOppositeWays) {
  mesh::Mesh mesh = test::grid(1, 1);
  std::swap(mesh.triangles[4], mesh.triangles[5]);
  EXPECT_EQ(textOf(mesh::splitNonManifold(mesh)), "1 edges, 2 vertices, 2 added");
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 3, 4, 2, 5}));
}

TEST(SplitNonManifold, TakesTwoCubesThatTouchAtAnEdgeOrACornerApart) {
  mesh::Mesh edge = test::together(test::cube(), test::moved(test::cube(), 2, 2, 0));
  for (std::uint32_t& v : edge.triangles) v = v == 8 ? 3 : v == 12 ? 7 : v;
  mesh::tidy(edge);
  EXPECT_EQ(textOf(mesh::splitNonManifold(edge)), "1 edges, 2 vertices, 2 added");
  EXPECT_TRUE(isManifold(edge));
  mesh::Mesh corner = test::together(test::cube(), test::moved(test::cube(), 2, 2, 2));
  for (std::uint32_t& v : corner.triangles) v = v == 8 ? 7 : v;
  mesh::tidy(corner);
  EXPECT_EQ(textOf(mesh::splitNonManifold(corner)), "0 edges, 1 vertices, 1 added");
  EXPECT_TRUE(isManifold(corner));
}

TEST(SplitNonManifold, MakesAnySoupAManifoldAndMovesNothing) {
  Random random(11);
  std::size_t singular = 0;
  for (int round = 0; round < 20000; ++round) {
    const auto vertices = static_cast<std::uint32_t>(3 + random.below(8));
    mesh::Mesh mesh = meshOf(vertices, {});
    for (std::uint64_t t = 1 + random.below(20); t > 0; --t) {
      for (int k = 0; k < 3; ++k)
        mesh.triangles.push_back(static_cast<std::uint32_t>(random.below(vertices)));
    }
    mesh::tidy(mesh);
    const mesh::Mesh before = mesh;
    const mesh::SplitReport report = mesh::splitNonManifold(mesh);
    singular += report.edges > 0;
    ASSERT_TRUE(isManifold(mesh)) << round;
    ASSERT_EQ(report.added == 0, isManifold(before)) << round;
    ASSERT_EQ(mesh.vertexCount(), before.vertexCount() + report.added);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(mesh.positions[3 * mesh.triangles[i] + k],
                  before.positions[3 * before.triangles[i] + k]);
      }
    }
    EXPECT_EQ(mesh::splitNonManifold(mesh).added, 0u) << "once is enough";
  }
  EXPECT_GT(singular, 10000u);
}

TEST(SplitNonManifold, IsQuickWhereAThousandTrianglesMeetAtOneEdge) {
  const std::uint32_t n = 20000;
  mesh::Mesh mesh = meshOf(n + 2, {});
  for (std::uint32_t t = 0; t < n; ++t)
    mesh.triangles.insert(mesh.triangles.end(), {t % 2, 1 - t % 2, t + 2});
  EXPECT_EQ(textOf(mesh::splitNonManifold(mesh)), "1 edges, 2 vertices, 19998 added");
  EXPECT_EQ(mesh.triangles[5], 3u);
}

TEST(Tidy, DropsTrianglesThatAreThereAlready) {
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.triangles = {0, 1, 3, 3, 0, 1, 0, 3, 2, 1, 0, 3, 1, 3, 0, 2, 3, 0};
  const mesh::TidyReport report = mesh::tidy(mesh);
  EXPECT_EQ(report.duplicate, 2u);
  EXPECT_EQ(report.opposite, 2u);
  EXPECT_EQ(report.degenerate, 0u);
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 3, 0, 3, 2}));
}

TEST(Tidy, KeepsTheFirstOfEachOfManyDuplicates) {
  Random random(5);
  for (int round = 0; round < 500; ++round) {
    mesh::Mesh mesh = meshOf(6, {});
    for (std::uint64_t t = random.below(30); t > 0; --t) {
      for (int k = 0; k < 3; ++k)
        mesh.triangles.push_back(static_cast<std::uint32_t>(random.below(6)));
    }
    Indices expected;
    std::set<std::set<std::uint32_t>> seen;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const std::uint32_t* v = &mesh.triangles[t];
      const std::set<std::uint32_t> corners(v, v + 3);
      if (corners.size() == 3 && seen.insert(corners).second)
        expected.insert(expected.end(), v, v + 3);
    }
    // Adds triangles so that each vertex is used.
    mesh.triangles.insert(mesh.triangles.end(), {0, 1, 2, 3, 4, 5});
    for (const std::set<std::uint32_t>& last : {std::set{0U, 1U, 2U}, std::set{3U, 4U, 5U}}) {
      if (seen.insert(last).second) expected.insert(expected.end(), last.begin(), last.end());
    }
    mesh::tidy(mesh);
    ASSERT_EQ(mesh.triangles, expected);
  }
}

}  // namespace
}  // namespace merlin::render
