// Parts that form one surface are joined into one (render/mesh/weld_parts.h).
#include "render/mesh/weld_parts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "render/mesh/inspect.h"
#include "render/mesh/non_manifold.h"
#include "tests/support/meshes.h"

namespace merlin::render::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

// Adds a part: a grid of columns x rows cells whose lower left corner is (x, y).
void addGrid(Mesh& mesh, std::uint32_t columns, std::uint32_t rows, float x, float y, float label) {
  Mesh part = test::grid(columns, rows);
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t v = 0; v < part.vertexCount(); ++v) {
    mesh.positions.insert(mesh.positions.end(),
                          {part.positions[3 * v] + x, part.positions[3 * v + 1] + y, 0});
    mesh.features[0].values.push_back(label);
  }
  for (const std::uint32_t v : part.triangles) mesh.triangles.push_back(first + v);
}

Mesh twoGrids() {
  Mesh mesh{{}, {{"label", 1, {}}}, {}};
  addGrid(mesh, 3, 3, 0, 0, 0);
  addGrid(mesh, 3, 3, 3, 0, 1);
  return mesh;
}

std::size_t componentsOf(const Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertexCount());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = v;
  const auto rootOf = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    root[rootOf(mesh.triangles[i])] = rootOf(mesh.triangles[i / 3 * 3]);
  std::size_t n = 0;
  for (std::uint32_t v = 0; v < root.size(); ++v) n += root[v] == v;
  return n;
}

// Returns the part of each triangle, found from the labels of its welded corners.
Floats partsOf(const Mesh& mesh) {
  Floats parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    float part = 0;
    for (std::size_t k = 0; k < 3; ++k)
      part = std::max(part, mesh.find("label")->values[mesh.triangles[t + k]]);
    parts.push_back(part);
  }
  return parts;
}

TEST(WeldParts, JoinsTheBordersOfOneSurface) {
  Mesh mesh = twoGrids();
  const Floats parts = partsOf(mesh);
  EXPECT_EQ(componentsOf(mesh), 2u);
  const WeldReport report = weldParts(mesh);
  EXPECT_EQ(report.edges, 3u);
  EXPECT_EQ(report.vertices, 4u);
  EXPECT_EQ(mesh.vertexCount(), 28u);
  EXPECT_EQ(mesh.triangleCount(), 36u);
  EXPECT_EQ(componentsOf(mesh), 1u);
  EXPECT_EQ(partsOf(mesh), parts) << "each triangle still tells its part";
  EXPECT_TRUE(validate(mesh));
  EXPECT_EQ(splitNonManifold(mesh).added, 0u);
}

TEST(WeldParts, KeepsThePartOfEachTriangleAlsoOfSmallOnes) {
  Mesh mesh{{}, {{"label", 1, {}}}, {}};
  float label = 0;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x)
      addGrid(mesh, 1, 1, static_cast<float>(x), static_cast<float>(y), label++);
  }
  const Floats parts = partsOf(mesh);
  const WeldReport report = weldParts(mesh);
  EXPECT_EQ(partsOf(mesh), parts);
  EXPECT_GT(report.edges, 12u) << "of 24";
  EXPECT_EQ(componentsOf(mesh), 1u);
}

TEST(WeldParts, LeavesASeamABorderOfColoursAndACrease) {
  for (const char* name : {"texcoord", "colour"}) {
    Mesh mesh = twoGrids();
    const std::size_t dimension = std::string(name) == "colour" ? 3 : 2;
    Feature feature{name, dimension, Floats(mesh.vertexCount() * dimension, 0.25F)};
    for (std::size_t i = feature.values.size() / 2; i < feature.values.size(); ++i)
      feature.values[i] = 0.5F;
    mesh.features.push_back(feature);
    EXPECT_EQ(weldParts(mesh).vertices, 0u) << name;
    std::ranges::fill(mesh.features.back().values, 0.25F);
    EXPECT_EQ(weldParts(mesh).vertices, 4u) << name << ", the same on both sides";
  }
  for (const float z : {-6.0F, -2.0F, 2.0F, 6.0F}) {  // z at x = 6: slopes of 63 and 34 degrees
    Mesh mesh = twoGrids();
    for (std::size_t v = 16; v < 32; ++v)
      mesh.positions[3 * v + 2] = z * (mesh.positions[3 * v] - 3) / 3;
    EXPECT_EQ(weldParts(mesh).vertices, std::abs(z) > 3 ? 0u : 4u) << z;
  }
}

TEST(WeldParts, LeavesWhatIsNotOneSurface) {
  Mesh turned = twoGrids();
  for (std::size_t i = turned.triangles.size() / 2; i < turned.triangles.size(); i += 3)
    std::swap(turned.triangles[i], turned.triangles[i + 1]);
  EXPECT_EQ(weldParts(turned).vertices, 0u) << "faces the other way";
  Mesh three = twoGrids();
  addGrid(three, 3, 3, 3, 0, 2);
  EXPECT_EQ(weldParts(three).edges, 0u) << "three borders at each edge";
  Mesh same = twoGrids();
  std::ranges::fill(same.features[0].values, 0.0F);
  EXPECT_EQ(weldParts(same).vertices, 0u) << "borders of one part, such as a cut";
  Mesh apart = twoGrids();
  for (std::size_t v = 16; v < 32; ++v) apart.positions[3 * v] += 1e-6F * 3;
  EXPECT_EQ(weldParts(apart).vertices, 0u) << "bit by bit";
  Mesh unlabelled = twoGrids();
  unlabelled.features.clear();
  EXPECT_EQ(weldParts(unlabelled).vertices, 0u);
}

// A mesh that is made to be hard: first all triangles meet at one vertex position, finally all
// vertices are at one position.
TEST(WeldParts, BearsAMeshThatIsMadeForIt) {
  Mesh mesh{{}, {{"label", 1, {}}}, {}};
  for (std::uint32_t p = 0; p < 3000; ++p) {
    const float angle = 0.002F * static_cast<float>(p);
    for (int k = 0; k < 3; ++k) {
      mesh.positions.insert(mesh.positions.end(),
                            {k == 0 ? 0.0F : 1.0F, k == 1 ? std::sin(angle) : 0.0F,
                             k == 2 ? std::sin(angle + 0.002F) : 0.0F});
      mesh.features[0].values.push_back(static_cast<float>(p));
      mesh.triangles.push_back(3 * p + static_cast<std::uint32_t>(k));
    }
  }
  const Floats parts = partsOf(mesh);
  weldParts(mesh);
  EXPECT_EQ(partsOf(mesh), parts);
  std::ranges::fill(mesh.positions, 0.0F);
  weldParts(mesh);
  EXPECT_TRUE(validate(mesh));
}

}  // namespace
}  // namespace merlin::render::mesh
