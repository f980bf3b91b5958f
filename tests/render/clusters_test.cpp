// Clusters: each cut, uniform or not, is compared with the cut that follows from the dendrogram
// alone.
#include "render/lod/clusters.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "render/mesh/coincident.h"
#include "render/reduce/reduce.h"
#include "tests/render/mrm_files.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Indices = std::vector<std::uint32_t>;

lod::Dendrogram dendrogramOf(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  auto reduction = reduce::reduce(mesh, {.threads = 1});
  EXPECT_TRUE(reduction);
  return lod::buildDendrogram(mesh, reduction->log);
}

// Sorts triangles; each begins with its smallest index and keeps its orientation.
std::vector<Triangle> sorted(std::span<const std::uint32_t> indices) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    Triangle t{indices[i], indices[i + 1], indices[i + 2]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Indices evenCut(const lod::Clusters& clusters, const lod::Dendrogram& d, std::size_t level) {
  Indices out(3 * d.triangleCount());
  out.resize(3 * clusters.cutEvenly(level, out));
  return out;
}

Indices unevenCut(const lod::Clusters& clusters, const lod::Dendrogram& d, const Indices& levels) {
  Indices out(3 * d.triangleCount()), ends(clusters.size() + 1);
  out.resize(3 * clusters.cut(levels, out, ends));
  return out;
}

Indices randomLevels(const lod::Clusters& clusters, unsigned seed) {
  std::mt19937 random(seed);
  Indices levels(clusters.size());
  for (auto& l : levels) {
    const auto range = clusters.coarsestLevel() - clusters.finestLevel();
    l = static_cast<std::uint32_t>(clusters.finestLevel() + random() % (range + 1));
  }
  return levels;
}

TEST(Clusters, AnEvenCutIsTheDendrograms) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  for (const std::size_t memory : {std::size_t{40} << 20, std::size_t{300'000}}) {
    const lod::Clusters clusters(d, {.clusters = 40, .memory = memory});
    Indices expected(3 * d.triangleCount());
    for (std::size_t level = 0; level < d.levels(); level += 97) {
      const std::size_t n = d.cut(level, expected);
      EXPECT_EQ(sorted(evenCut(clusters, d, level)), sorted(std::span(expected).first(3 * n)))
          << level;
    }
  }
}

TEST(Clusters, LittleMemoryMeansACoarserFinestLevel) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  const lod::Clusters all(d, {.clusters = 40}), few(d, {.clusters = 40, .memory = 300'000});
  EXPECT_EQ(all.finestLevel(), 0u);
  EXPECT_GT(few.finestLevel(), 0u);
  EXPECT_LT(few.memoryBytes(), 330'000u);
}

// Above 300,000 triangles the precomputed steps are further apart, so that a million triangles fit
// into 41 MB.
TEST(Clusters, LargeCutsAreTheDendrogramsToo) {
  const lod::Dendrogram d = dendrogramOf(test::noisyGrid(410, 410, 0.4, 3));
  const lod::Clusters clusters(d, {});
  ASSERT_GT(d.triangleCount(), 330'000u);
  EXPECT_EQ(clusters.finestLevel(), 0u);
  EXPECT_LT(clusters.memoryBytes(), 41'000'000u);
  Indices expected(3 * d.triangleCount());
  for (const unsigned triangles : {330'000u, 200'000u, 160'000u, 40'000u}) {
    const std::size_t level = d.levelFor(triangles), n = d.cut(level, expected);
    EXPECT_EQ(sorted(evenCut(clusters, d, level)), sorted(std::span(expected).first(3 * n)))
        << triangles;
  }
}

TEST(Clusters, EverythingIsEachLeafTriangleByCluster) {
  const lod::Dendrogram d = dendrogramOf(test::noisyGrid(40, 40, 0.4, 3));
  const lod::Clusters clusters(d, {.clusters = 30, .memory = 100'000});
  ASSERT_GT(clusters.finestLevel(), 0u);
  Indices corners, ends;
  clusters.everything(corners, ends);
  EXPECT_EQ(sorted(corners), sorted(d.arrays().triangles));
  ASSERT_EQ(ends.size(), clusters.size() + 1);
  EXPECT_EQ(ends.back(), d.triangleCount());
  const auto finest = static_cast<std::uint32_t>(d.nodeCount() - 2 * clusters.finestLevel());
  for (std::size_t t = 0, cluster = 0; t < d.triangleCount(); ++t) {
    while (t >= ends[cluster]) ++cluster;
    std::uint32_t node = corners[3 * t];
    while (node >= finest) node = d.parentOf(node);
    EXPECT_EQ(clusters.clusterOf(node), cluster) << t;
  }
}

// Every cluster gets a random level. The cut then consists of the mesh's triangles whose corners,
// each replaced by its ancestor alive at the level of its cluster, are still three different nodes.
TEST(Clusters, AnUnevenCutIsWhatChasingEveryCornerGives) {
  const lod::Dendrogram d = dendrogramOf(test::noisyGrid(40, 40, 0.4, 3));
  const lod::Clusters clusters(d, {.clusters = 30});
  ASSERT_EQ(clusters.finestLevel(), 0u);
  const auto nodes = static_cast<std::uint32_t>(d.nodeCount());
  const auto coarse = nodes - static_cast<std::uint32_t>(2 * clusters.coarsestLevel());
  const auto parent = [&](std::uint32_t n) { return d.arrays().parents[(nodes - 1 - n) / 2]; };
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Indices levels = randomLevels(clusters, seed);
    // A leaf belongs to the cluster of its root. Cuts that refine a single cluster show which
    // cluster that is.
    static std::map<std::uint32_t, std::size_t> cluster_of_root;
    if (cluster_of_root.empty()) {
      for (std::size_t c = 0; c < clusters.size(); ++c) {
        Indices one(clusters.size(), static_cast<std::uint32_t>(clusters.coarsestLevel()));
        one[c] = 0;
        for (std::uint32_t n : unevenCut(clusters, d, one)) {
          if (n < coarse) continue;
          while (n >= coarse) n = parent(n);
          cluster_of_root[n] = c;
        }
      }
    }
    Indices expected;
    for (std::size_t i = 0; i < d.arrays().triangles.size(); i += 3) {
      Triangle t{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t leaf = d.arrays().triangles[i + k];
        std::uint32_t root = leaf;
        while (root >= coarse) root = parent(root);
        t[k] = leaf;
        // the root is a leaf itself, so it belongs to no cluster
        if (!cluster_of_root.count(root)) continue;
        while (t[k] >= nodes - 2 * levels[cluster_of_root[root]]) t[k] = parent(t[k]);
      }
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        expected.insert(expected.end(), t.begin(), t.end());
    }
    EXPECT_EQ(sorted(unevenCut(clusters, d, levels)), sorted(expected)) << seed;
  }
}

// In a closed surface each edge occurs equally often in both directions, whatever the clusters'
// levels.
TEST(Clusters, NeighboursOfAnyLevelsLeaveNoCrack) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  for (const std::size_t memory : {std::size_t{40} << 20, std::size_t{300'000}}) {
    const lod::Clusters clusters(d, {.clusters = 60, .memory = memory});
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      const Indices cut = unevenCut(clusters, d, randomLevels(clusters, seed));
      for (std::size_t i = 0; i < cut.size(); ++i) {
        const std::uint32_t a = cut[i], b = cut[i % 3 == 2 ? i - 2 : i + 1];
        a < b ? ++edges[{a, b}] : --edges[{b, a}];
      }
      for (const auto& [edge, sum] : edges) ASSERT_EQ(sum, 0) << edge.first << ' ' << edge.second;
    }
  }
}

TEST(Clusters, CountsAndEndsSayWhatACutHolds) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  const lod::Clusters clusters(d, {.clusters = 50});
  const Indices levels = randomLevels(clusters, 7);
  Indices out(3 * d.triangleCount()), ends(clusters.size() + 1);
  const std::size_t n = clusters.cut(levels, out, ends);
  std::size_t end = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    end += clusters.trianglesAt(c, levels[c]);
    EXPECT_EQ(ends[c], end);
  }
  EXPECT_EQ(n, end + clusters.alwaysThere());
}

TEST(Clusters, BoundsHoldWhatIsCut) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(5));
  const lod::Clusters clusters(d, {.clusters = 50});
  const auto positions = d.arrays().positions;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Indices levels = randomLevels(clusters, seed);
    Indices out(3 * d.triangleCount()), ends(clusters.size() + 1);
    clusters.cut(levels, out, ends);
    std::size_t i = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const lod::ClusterBounds& b = clusters.bounds(c);
      for (; i < 3 * std::size_t{ends[c]}; ++i) {
        const float* p = &positions[3 * std::size_t{out[i]}];
        EXPECT_LE(std::hypot(p[0] - b.centre[0], p[1] - b.centre[1], p[2] - b.centre[2]),
                  b.radius * 1.0001F);
      }
      // A sphere's normals point away from its centre, so a cluster's cone axis must too.
      EXPECT_GT(b.axis[0] * b.centre[0] + b.axis[1] * b.centre[1] + b.axis[2] * b.centre[2], 0);
      EXPECT_GT(b.cone_cos, 0.3F);
    }
  }
}

// A frame at full detail draws the clusters of everything() and leaves out those whose bounding
// sphere no tile sees. Each sphere must therefore contain its triangles, also a triangle with
// corners in three clusters.
TEST(Clusters, BoundsHoldEverything) {
  const lod::Dendrogram d = dendrogramOf(test::noisyGrid(40, 40, 0.4, 3));
  const auto positions = d.arrays().positions;
  for (const std::size_t memory : {std::size_t{100'000}, lod::ClusterSettings{}.memory}) {
    const lod::Clusters clusters(d, {.clusters = 30, .memory = memory});
    Indices corners, ends;
    clusters.everything(corners, ends);
    std::size_t i = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const lod::ClusterBounds& b = clusters.bounds(c);
      for (; i < 3 * std::size_t{ends[c]}; ++i) {
        const float* p = &positions[3 * std::size_t{corners[i]}];
        ASSERT_LE(std::hypot(p[0] - b.centre[0], p[1] - b.centre[1], p[2] - b.centre[2]),
                  b.radius * 1.0001F)
            << "finest level " << clusters.finestLevel();
      }
    }
  }
}

TEST(Clusters, EightAtATimeIsAsOneAtATime) {
  const lod::Dendrogram d = dendrogramOf(test::sphere(4));
  const lod::CollapseForest forest{d.arrays().parents, static_cast<std::uint32_t>(d.nodeCount())};
  const auto leaves = d.arrays().triangles;
  Indices one(leaves.size()), eight(leaves.size());
  for (std::uint32_t alive = forest.nodes; alive > 20; alive -= 14) {
    for (const std::size_t n : {leaves.size(), std::size_t{13}, std::size_t{0}}) {
      lod::portableAliveAncestorFinder()(forest, alive, leaves.data(), n, one.data());
      lod::aliveAncestorFinder(forest.nodes)(forest, alive, leaves.data(), n, eight.data());
      ASSERT_EQ(one, eight) << alive;
    }
  }
}

TEST(Clusters, TheSmallestModelsAreCutToo) {
  for (const mesh::Mesh& mesh : {test::cube(), test::grid(1, 1), test::grid(2, 2)}) {
    const lod::Dendrogram d = dendrogramOf(mesh);
    const lod::Clusters clusters(d, {});
    Indices expected(3 * d.triangleCount());
    for (std::size_t level = 0; level < d.levels(); ++level) {
      const std::size_t n = d.cut(level, expected);
      EXPECT_EQ(sorted(evenCut(clusters, d, level)), sorted(std::span(expected).first(3 * n)));
    }
  }
}

// Reductions usually stop before no triangle is left; this log is written by hand.
TEST(Clusters, AModelThatEndsWithoutTrianglesIsCutToo) {
  const lod::Dendrogram d = test::goldenCube();
  ASSERT_EQ(d.trianglesAt(d.levels() - 1), 0u);
  const lod::Clusters clusters(d, {});
  EXPECT_EQ(evenCut(clusters, d, 0).size(), 3 * d.triangleCount());
}

// If the two sides of a seam were in different clusters, the clusters' levels could differ and a
// crack could open.
TEST(Clusters, BothSidesOfASeamAreInOne) {
  const lod::Dendrogram d = dendrogramOf(test::tube(60, 40, true));
  const lod::Clusters clusters(d, {.clusters = 100});
  ASSERT_GT(clusters.size(), 40U);
  const std::vector<std::uint32_t> next = mesh::coincidentVertices(d.arrays().positions);
  std::size_t pairs = 0;
  for (std::uint32_t n = 0; n < next.size(); ++n) {
    const std::size_t one = clusters.clusterOf(n), other = clusters.clusterOf(next[n]);
    if (next[n] == n || one >= clusters.size() || other >= clusters.size()) continue;
    ++pairs;  // both nodes are fine enough to belong to a cluster
    EXPECT_EQ(one, other);
  }
  EXPECT_GE(pairs, 2U * 41);
}

}  // namespace
}  // namespace merlin::render
