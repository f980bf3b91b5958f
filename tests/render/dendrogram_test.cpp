// Every level of a dendrogram is compared with an oracle that performs the collapses one by one on
// plain triangles.
#include "render/lod/dendrogram.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/reduce/reduce.h"
#include "tests/support/count_allocations.h"
#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Node = std::uint32_t;
using Triangle = std::array<Node, 3>;
// Triangles of node numbers in the log, each beginning with its smallest number.
using Triangles = std::multiset<Triangle>;

struct Reduced {
  mesh::Mesh mesh;
  lod::CollapseLog log;
};

Triangle turned(Node a, Node b, Node c) {
  Triangle t{a, b, c};
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// Adds the feature "id": each node's number in the log. The feature shows which node is which after
// the dendrogram has renumbered the nodes.
Reduced withIds(mesh::Mesh mesh, lod::CollapseLog log) {
  std::vector<float> vertices(mesh.vertexCount()), made(log.children.size());
  std::iota(vertices.begin(), vertices.end(), 0.0F);
  std::iota(made.begin(), made.end(), static_cast<float>(vertices.size()));
  mesh.features.push_back({"id", 1, std::move(vertices)});
  log.features.push_back(std::move(made));
  return {std::move(mesh), std::move(log)};
}

Reduced reduced(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  auto r = reduce::reduce(mesh, {});
  EXPECT_TRUE(r);
  return withIds(std::move(mesh), std::move(r->log));
}

// Merges arbitrary nodes; the dendrogram does not require that merged nodes are neighbours.
Reduced mergedAtRandom(mesh::Mesh mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<Node> alive(mesh.vertexCount());
  std::iota(alive.begin(), alive.end(), 0U);
  lod::CollapseLog log;
  const auto take = [&] {
    const auto at = alive.begin() + static_cast<std::ptrdiff_t>(random.below(alive.size()));
    const Node node = *at;
    alive.erase(at);
    return node;
  };
  for (auto fresh = static_cast<Node>(mesh.vertexCount()); alive.size() > 3; ++fresh) {
    const Node a = take(), b = take();
    log.children.push_back({a, b});
    alive.push_back(fresh);
    log.error.push_back(static_cast<float>(random.uniform()));
    for (int k = 0; k < 3; ++k) log.positions.push_back(static_cast<float>(random.normal()));
  }
  return withIds(std::move(mesh), std::move(log));
}

// The oracle: a plain list of triangles, on which collapses are performed one by one.
class PlainMesh {
 public:
  explicit PlainMesh(const mesh::Mesh& mesh) : corners_(mesh.triangles) {}

  void collapse(std::array<Node, 2> children, Node made) {
    std::vector<Node> left;
    for (std::size_t i = 0; i < corners_.size(); i += 3) {
      Triangle t{corners_[i], corners_[i + 1], corners_[i + 2]};
      for (Node& c : t) c = c == children[0] || c == children[1] ? made : c;
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      left.insert(left.end(), t.begin(), t.end());
    }
    corners_ = std::move(left);
  }

  Triangles triangles() const {
    Triangles all;
    for (std::size_t i = 0; i < corners_.size(); i += 3) {
      all.insert(turned(corners_[i], corners_[i + 1], corners_[i + 2]));
    }
    return all;
  }

 private:
  std::vector<Node> corners_;
};

Node idOf(const lod::Dendrogram& d, std::size_t node) {
  return static_cast<Node>(d.find("id")->values[node]);
}

Triangles cutOf(const lod::Dendrogram& d, std::size_t level) {
  std::vector<Node> corners(3 * d.trianglesAt(level));
  EXPECT_EQ(d.cut(level, corners), d.trianglesAt(level));
  Triangles all;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    all.insert(turned(idOf(d, corners[i]), idOf(d, corners[i + 1]), idOf(d, corners[i + 2])));
  }
  return all;
}

void expectEachLevelIsTheOracles(const Reduced& r) {
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  ASSERT_EQ(d.levels(), r.log.children.size() + 1);
  PlainMesh plain(r.mesh);
  for (std::size_t level = 0;; ++level) {
    ASSERT_EQ(cutOf(d, level), plain.triangles()) << "level " << level;
    if (level == r.log.children.size()) return;
    plain.collapse(r.log.children[level], static_cast<Node>(r.mesh.vertexCount() + level));
  }
}

mesh::Mesh hills() { return test::noisyGrid(12, 9, 0.3, 1); }

// Returns three components: a closed one, one with a border, and another closed one.
mesh::Mesh components() {
  return test::together(test::together(test::sphere(2), test::moved(hills(), 3, 0, 0)),
                        test::moved(test::cube(), -5, 0, 0));
}

TEST(Dendrogram, EveryLevelIsTheMeshAfterAsManyCollapses) {
  expectEachLevelIsTheOracles(reduced(test::cube()));
  expectEachLevelIsTheOracles(reduced(test::sphere(3)));
  expectEachLevelIsTheOracles(reduced(hills()));
  expectEachLevelIsTheOracles(reduced(components()));
}

TEST(Dendrogram, EveryLevelIsRightWhateverIsMerged) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    expectEachLevelIsTheOracles(mergedAtRandom(seed % 2 == 0 ? hills() : test::sphere(2), seed));
  }
}

TEST(Dendrogram, OfAMeshThatWasNotReducedHasOneLevel) {
  const lod::Dendrogram d = lod::buildDendrogram(test::cube(), {});
  EXPECT_EQ(d.levels(), 1u);
  EXPECT_EQ(d.nodeCount(), 8u);
  EXPECT_EQ(d.trianglesAt(0), 12u);
  std::vector<Node> corners(36);
  d.cut(0, corners);
  EXPECT_EQ(corners, test::cube().triangles);
}

TEST(Dendrogram, NumbersNodesByTheirRemovalLastFirst) {
  const Reduced r = reduced(components());
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  const std::size_t n = d.nodeCount(), vertices = r.mesh.vertexCount();
  ASSERT_EQ(n, vertices + r.log.children.size());
  EXPECT_EQ(d.vertexCount(), vertices);
  for (std::size_t k = 0; k < r.log.children.size(); ++k) {
    const std::set<Node> merged(r.log.children[k].begin(), r.log.children[k].end());
    ASSERT_EQ((std::set<Node>{idOf(d, n - 2 * k - 1), idOf(d, n - 2 * k - 2)}), merged) << k;
    ASSERT_EQ(idOf(d, d.arrays().parents[k]), vertices + k);
  }
}

TEST(Dendrogram, EachNodeKeepsItsPositionAndFeatures) {
  const Reduced r = reduced(hills());
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  const std::size_t vertices = r.mesh.vertexCount();
  for (std::size_t node = 0; node < d.nodeCount(); ++node) {
    const std::size_t id = idOf(d, node);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t leaf = 3 * id + k, made = leaf - 3 * vertices;
      ASSERT_EQ(d.arrays().positions[3 * node + k],
                id < vertices ? r.mesh.positions[leaf] : r.log.positions[made]);
      ASSERT_EQ(d.find("normal")->values[3 * node + k],
                id < vertices ? r.mesh.features[0].values[leaf] : r.log.features[0][made]);
    }
  }
  EXPECT_EQ(d.find("normal")->dimension, 3u);
  EXPECT_EQ(d.find("colour"), nullptr);
}

TEST(Dendrogram, TheErrorOfALevelIsTheLargestUpToIt) {
  lod::CollapseLog log;
  log.children = {{0, 1}, {2, 3}, {4, 5}};
  log.positions.resize(9);
  log.error = {1, 0.5F, 2};
  log.about = "cost=test\n";
  const lod::Dendrogram d = lod::buildDendrogram(test::cube(), log);
  const std::vector<float> error(d.arrays().error.begin(), d.arrays().error.end());
  EXPECT_EQ(error, (std::vector<float>{0, 1, 1, 2}));
  EXPECT_EQ(d.errorAt(3), 2);
  EXPECT_EQ(d.arrays().about, "cost=test\n");
}

TEST(Dendrogram, ExtractsALevelAsAMeshOfItsOwn) {
  const Reduced r = reduced(components());
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  for (std::size_t level = 0; level < d.levels(); ++level) {
    const mesh::Mesh mesh = lod::extract(d, level);
    ASSERT_TRUE(validate(mesh));
    mesh::Mesh tidied = mesh;
    const mesh::TidyReport report = mesh::tidy(tidied);
    ASSERT_EQ(report.degenerate + report.unused, 0u) << level;
    ASSERT_EQ(mesh.features.size(), 2u);
    ASSERT_EQ(mesh.find("normal")->values.size(), 3 * mesh.vertexCount());
    const std::vector<float>& ids = mesh.find("id")->values;
    ASSERT_EQ(std::set<float>(ids.begin(), ids.end()).size(), mesh.vertexCount()) << "none twice";
    Triangles all;
    const auto id = [&](std::size_t i) { return static_cast<Node>(ids[mesh.triangles[i]]); };
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      all.insert(turned(id(i), id(i + 1), id(i + 2)));
    }
    ASSERT_EQ(all, cutOf(d, level)) << level;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const auto at = static_cast<std::size_t>(ids[v]);
      const std::vector<float>& from =
          at < r.mesh.vertexCount() ? r.mesh.positions : r.log.positions;
      const std::size_t row = at < r.mesh.vertexCount() ? at : at - r.mesh.vertexCount();
      ASSERT_TRUE(std::equal(&from[3 * row], &from[3 * row] + 3, &mesh.positions[3 * v]));
    }
  }
}

TEST(Dendrogram, ABudgetGetsTheFinestLevelThatFits) {
  const Reduced r = reduced(test::sphere(3));
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  ASSERT_GT(d.trianglesAt(d.levels() - 1), 0u);
  for (std::size_t budget = 0; budget <= d.triangleCount() + 2; ++budget) {
    std::size_t level = 0;
    while (level + 1 < d.levels() && d.trianglesAt(level) > budget) ++level;
    ASSERT_EQ(d.levelFor(budget), level) << budget;
  }
}

TEST(Dendrogram, AnErrorGetsTheCoarsestLevelWithinIt) {
  const Reduced r = mergedAtRandom(test::sphere(2), 3);
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  std::vector<float> asked = {-1, 0, std::numeric_limits<float>::infinity()};
  for (const float e : d.arrays().error) {
    asked.insert(asked.end(), {e, std::nextafter(e, -1.0F), std::nextafter(e, 9.0F)});
  }
  for (const float error : asked) {
    std::size_t level = d.levels() - 1;
    while (level > 0 && d.errorAt(level) > error) --level;
    ASSERT_EQ(d.levelForError(error), level) << error;
  }
}

TEST(Dendrogram, ACutAllocatesNothingAndWritesNoFurther) {
  const Reduced r = reduced(test::sphere(3));
  const lod::Dendrogram d = lod::buildDendrogram(r.mesh, r.log);
  constexpr Node kUntouched = 0xDEADBEEF;
  std::vector<Node> corners(3 * d.triangleCount(), kUntouched);
  for (std::size_t level = d.levels(); level-- > 0;) {  // from coarse to fine
    const long before = test::allocations;
    const std::size_t triangles = d.cut(level, corners);
    const std::size_t again = d.levelFor(triangles) + d.levelForError(d.errorAt(level));
    ASSERT_EQ(test::allocations, before) << level << " " << again;
    ASSERT_EQ(std::count(corners.begin(), corners.end(), kUntouched),
              static_cast<std::ptrdiff_t>(corners.size() - 3 * triangles));
  }
}

TEST(Dendrogram, KeepsItsMemoryAliveThroughEachCopy) {
  const auto owner = std::make_shared<const std::vector<float>>(std::vector<float>{1, 2, 3});
  static constexpr std::uint32_t kAlive[] = {0};
  static constexpr float kError[] = {0};
  {
    auto first = lod::Dendrogram::make({*owner, {}, {}, {}, kAlive, kError, ""}, owner);
    ASSERT_TRUE(first) << first.error().what;
    const auto copy = std::make_unique<const lod::Dendrogram>(*first);
    EXPECT_EQ(owner.use_count(), 3);
  }
  EXPECT_EQ(owner.use_count(), 1);
}

}  // namespace
}  // namespace merlin::render
