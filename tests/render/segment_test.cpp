#include "render/segment/segment.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Labels = std::vector<std::uint32_t>;
using Sizes = std::vector<std::size_t>;

segment::Segmentation segmented(mesh::Mesh mesh, const segment::SegmentSettings& settings) {
  mesh::ensureNormals(mesh);
  const auto result = segment::segment(mesh, settings);
  EXPECT_TRUE(result) << result.error().what;
  return result ? *result : segment::Segmentation{};
}

// Returns a cube of n x n x n cells whose sides share vertices. `side`: for each vertex the number
// of its side, 0..5, or 6 on edges and corners.
mesh::Mesh fineCube(std::uint32_t n, std::vector<int>& side) {
  mesh::Mesh mesh = test::grid(n, n);
  const std::size_t vertices = mesh.vertexCount(), corners = mesh.triangles.size();
  const auto size = static_cast<float>(n);
  mesh.positions.clear();
  std::vector<std::uint32_t> triangles;
  std::map<std::array<float, 3>, std::uint32_t> places;
  const mesh::Mesh flat = test::grid(n, n);
  for (int s = 0; s < 6; ++s) {
    const auto axis = static_cast<std::size_t>(s % 3);
    std::vector<std::uint32_t> number;
    for (std::size_t v = 0; v < vertices; ++v) {
      std::array<float, 3> p{};
      p[axis] = s < 3 ? size : 0;
      p[(axis + 1) % 3] = flat.positions[3 * v];
      p[(axis + 2) % 3] = flat.positions[3 * v + 1];
      const auto [at, fresh] =
          places.try_emplace(p, static_cast<std::uint32_t>(mesh.vertexCount()));
      if (fresh) mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
      if (fresh) side.push_back(s);
      if (!fresh) side[at->second] = 6;
      number.push_back(at->second);
    }
    for (std::size_t i = 0; i < corners; i += 3) {
      const std::size_t last = s < 3 ? 2 : 1;  // so that the side faces outwards
      for (const std::size_t k : {std::size_t{0}, 3 - last, last})
        triangles.push_back(number[flat.triangles[i + k]]);
    }
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

TEST(Segment, FindsTheSixSidesOfACubeByTheirNormals) {
  std::vector<int> side;
  const mesh::Mesh cube = fineCube(12, side);
  const segment::Segmentation s = segmented(cube, {.segments = 6});
  std::set<std::pair<int, std::uint32_t>> pairs;
  for (std::size_t v = 0; v < side.size(); ++v) {
    if (side[v] < 6) pairs.emplace(side[v], s.labels[v]);
  }
  EXPECT_EQ(pairs.size(), 6u) << "each side has one label";
  std::set<std::uint32_t> labels;
  for (const auto& [one, label] : pairs) labels.insert(label);
  EXPECT_EQ(labels, (std::set<std::uint32_t>{0, 1, 2, 3, 4, 5})) << "and no other side has it";
  for (const std::size_t size : s.sizes) EXPECT_GE(size, 121u);
}

// Returns a flat mesh with red and green stripes, which only the colour distinguishes.
mesh::Mesh stripes() {
  mesh::Mesh mesh = test::grid(11, 5);
  mesh::Feature colour{"colour", 3, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const bool red = v % 12 < 4 || v % 12 >= 8;
    colour.values.insert(colour.values.end(), {red ? 1.0F : 0.0F, red ? 0.0F : 1.0F, 0});
  }
  mesh.features = {colour};
  return mesh;
}

TEST(Segment, TellsColoursApartAndStaysConnected) {
  const segment::Segmentation three = segmented(stripes(), {.segments = 3});
  EXPECT_EQ(three.sizes, (Sizes{24, 24, 24}));
  EXPECT_EQ(three.error, 0);
  for (std::size_t v = 0; v < 72; ++v) EXPECT_EQ(three.labels[v], v % 12 / 4) << v;
  const segment::Segmentation two = segmented(stripes(), {.segments = 2});
  EXPECT_EQ(two.sizes, (Sizes{48, 24})) << "the red stripes do not touch: one joins the green";
}

TEST(Segment, GoesByTheWeights) {
  mesh::Mesh mesh = stripes();
  mesh.features.push_back({"heat", 1, Floats(72, 20)});
  // The upper rows are warmer.
  for (std::size_t v = 36; v < 72; ++v) mesh.features[1].values[v] = 90;
  const segment::Segmentation heat = segmented(mesh, {2, {{"heat", 1}}});
  EXPECT_EQ(heat.sizes, (Sizes{36, 36}));
  for (std::size_t v = 0; v < 72; ++v) EXPECT_EQ(heat.labels[v], v / 36) << v;
  const segment::Segmentation geometry = segmented(mesh, {2, {{"geometry", 1}}});
  EXPECT_EQ(geometry.sizes[0] + geometry.sizes[1], 72u);
  EXPECT_LT(geometry.error, 0.25);
}

TEST(Segment, FindsAnEdgeByItsCurvature) {
  std::vector<int> side;
  const mesh::Mesh cube = fineCube(8, side);
  const segment::Segmentation s = segmented(cube, {7, {{"curvature", 1}}});
  for (std::size_t v = 0; v < side.size(); ++v)
    EXPECT_EQ(s.sizes[s.labels[v]], side[v] < 6 ? 49u : 92u) << "a side's inside, or all edges";
}

TEST(Segment, JoinsComponentsThatAreTooMany) {
  mesh::Mesh mesh;
  for (int i = 0; i < 5; ++i)
    mesh =
        test::together(mesh, test::moved(test::grid(i < 2 ? 3 : 1, 1), 0, 0, i < 3 ? 0.0F : 9.0F));
  const segment::Segmentation s = segmented(mesh, {2, {{"geometry", 1}}});
  EXPECT_EQ(s.sizes.size(), 2u);
  EXPECT_EQ(s.sizes[0] + s.sizes[1], 28u);
}

// Coincident vertices on both sides of a seam must belong to one surface.
TEST(Segment, CrossesSeams) {
  const mesh::Mesh mesh = test::together(test::grid(2, 1), test::moved(test::grid(2, 1), 2, 0, 0));
  EXPECT_EQ(segmented(mesh, {.segments = 1}).sizes, (Sizes{12}));
  const segment::Segmentation s = segmented(mesh, {2, {{"geometry", 1}}});
  EXPECT_EQ(s.labels[2], s.labels[6]) << "what is in one place is merged first";
  EXPECT_EQ(s.labels[5], s.labels[9]);
}

TEST(Segment, MayBeAskedForAsManyAsThereAreVerticesOrMore) {
  EXPECT_EQ(segmented(test::grid(1, 1), {.segments = 4}).labels, (Labels{0, 1, 2, 3}));
  EXPECT_EQ(segmented(test::grid(1, 1), {.segments = 400}).sizes, (Sizes{1, 1, 1, 1}));
}

TEST(Segment, RefusesWhatItCannotDo) {
  mesh::Mesh mesh = test::grid(1, 1);
  mesh::ensureNormals(mesh);
  EXPECT_EQ(segment::segment(mesh, {.segments = 0}).error().what,
            "0 segments: at least one is needed");
  EXPECT_EQ(segment::segment(mesh, {2, {{"boundary", 1}}}).error().what,
            "weight boundary: segmentation does not use this weight");
  EXPECT_EQ(segment::segment(mesh, {2, {{"heat", 1}}}).error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace merlin::render
