#include "render/reduce/pattern_space.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;

// Returns a grid of 3 x 4 units, so that the diagonal of its bounding box is 5.
mesh::Mesh richGrid() {
  mesh::Mesh mesh = test::grid(3, 4);
  const std::size_t n = mesh.vertexCount();
  mesh.features = {{"normal", 3, mesh::vertexNormals(mesh)},
                   {"colour", 3, Floats(3 * n, 0.5F)},
                   {"heat", 1, Floats(n, 300)},
                   {"flow", 2, Floats(2 * n, 0)},
                   {"label", 1, Floats(n, 7)}};
  mesh.features[1].values[0] = 0;  // range 0.5; colours are not normalised
  mesh.features[2].values[3] = 280;
  mesh.features[2].values[9] = 330;  // range 50
  mesh.features[3].values[4] = 4;    // ranges 4 and 1: the larger one counts for both components
  mesh.features[3].values[7] = -1;
  return mesh;
}

float scaleOf(const char* name, float weight) {
  const auto space = reduce::PatternSpace::make(richGrid(), {{name, weight}});
  EXPECT_TRUE(space);
  return space ? space->find(name)->scale : 0;
}

std::string faultOf(const reduce::Weights& weights) {
  const auto space = reduce::PatternSpace::make(richGrid(), weights);
  if (space) return "none";
  EXPECT_EQ(space.error().code, Errc::kInvalidArgument);
  return space.error().what;
}

TEST(Curvature, IsTheSpreadOfTheFaceNormals) {  // equation 4.2
  const float up[] = {0, 0, 1};
  EXPECT_FLOAT_EQ(reduce::curvature(Floats{0, 0, 1, 0, 0, 1}, up), 0);
  // Each |F - N|^2 is 2, so their mean is 2.
  EXPECT_FLOAT_EQ(reduce::curvature(Floats{1, 0, 0, 0, 1, 0, -1, 0, 0}, up), 1.41421356F);
  // Squared distances 0, 0, 2 and 4 over four faces: the root of 1.5.
  EXPECT_FLOAT_EQ(reduce::curvature(Floats{0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, -1}, up), 1.22474487F);
}

TEST(Curvature, IsZeroWithoutFaces) {
  const float up[] = {0, 0, 1};
  EXPECT_EQ(reduce::curvature({}, up), 0);
}

TEST(PatternSpace, DividesGeometryByTheDiagonalOfTheBox) {
  EXPECT_FLOAT_EQ(scaleOf("geometry", 2), 0.4F);
}

TEST(PatternSpace, TakesNormalsCurvatureBoundaryAndColourAsTheyAre) {
  for (const char* name : {"normal", "curvature", "boundary", "colour"}) {
    EXPECT_EQ(scaleOf(name, 2), 2) << name;
  }
}

TEST(PatternSpace, DividesAnyOtherFeatureByItsLargestExtent) {
  EXPECT_FLOAT_EQ(scaleOf("heat", 2), 2.0F / 50);
  EXPECT_FLOAT_EQ(scaleOf("flow", 2), 2.0F / 4);
  EXPECT_FLOAT_EQ(scaleOf("label", 2), 2);  // has the same value everywhere
}

TEST(PatternSpace, LaysItsFeaturesSideBySide) {
  const auto space = reduce::PatternSpace::make(richGrid(), {{"boundary", 1},
                                                             {"colour", 0},
                                                             {"curvature", 1},
                                                             {"flow", 1},
                                                             {"geometry", 1},
                                                             {"heat", 1},
                                                             {"normal", 1}});
  ASSERT_TRUE(space);
  EXPECT_EQ(space->dimension(), 11u);
  std::string table;
  for (const reduce::PatternFeature& f : space->features()) {
    table += f.name + " " + std::to_string(f.offset) + "+" + std::to_string(f.dimension) + ", ";
  }
  EXPECT_EQ(table, "boundary 0+1, curvature 1+1, flow 2+2, geometry 4+3, heat 7+1, normal 8+3, ");
  EXPECT_EQ(space->find("colour"), nullptr);  // has no weight
  EXPECT_EQ(space->find("label"), nullptr);
}

TEST(PatternSpace, NamesTheFeaturesThatThereAre) {
  EXPECT_EQ(faultOf({{"geometry", 1}, {"temperature", 1}}),
            "weight temperature: the mesh has no such feature; it has geometry, normal, curvature, "
            "boundary, colour, heat, flow, label");
}

TEST(PatternSpace, NamesTheWeightThatIsNone) {
  EXPECT_EQ(faultOf({{"heat", -1.0F}}), "weight heat: -1 is not from 0 to 1000000");
  EXPECT_EQ(faultOf({{"heat", std::numeric_limits<float>::quiet_NaN()}}),
            "weight heat: nan is not from 0 to 1000000");
  EXPECT_EQ(faultOf({{"heat", std::numeric_limits<float>::infinity()}}),
            "weight heat: inf is not from 0 to 1000000");
  EXPECT_EQ(faultOf({{"heat", 0}, {"geometry", 0}}), "no weight is more than 0");
  EXPECT_EQ(faultOf({}), "no weight is more than 0");
}

TEST(Weights, OfNineteenNinetyEight) {  // figure 5.2
  const reduce::Weights expected{
      {"geometry", 1.0F}, {"normal", 0.5F}, {"boundary", 2.0F}, {"curvature", 1.5F}};
  EXPECT_EQ(reduce::presetWeights(reduce::presets()[0], test::cube()), expected);
  reduce::Weights coloured = expected;
  coloured["colour"] = 1;
  EXPECT_EQ(reduce::presetWeights(reduce::presets()[0], richGrid()), coloured);
  const auto segmented = std::ranges::find(
      reduce::presets(), std::string_view("perceptron-segmented1998"), &reduce::Preset::name);
  ASSERT_NE(segmented, reduce::presets().end());
  EXPECT_EQ(reduce::presetWeights(*segmented, richGrid()), (reduce::Weights{{"geometry", 50.0F},
                                                                            {"normal", 1.0F},
                                                                            {"label", 10.0F},
                                                                            {"boundary", 15.0F},
                                                                            {"curvature", 1.0F}}));
}

// The weights are those of geometry, normal, the data's own feature, boundary and curvature
// ([GOURLEY98] 5.2); for a mesh without the feature, that weight is omitted.
TEST(Weights, OfEachDataSetOfNineteenNinetyEight) {
  const struct {
    const char* name;
    float geometry, normal;
    const char* feature;
    float of_feature, boundary, curvature;
  } kExpected[] = {{"typical1998", 1, 0.5F, "colour", 1, 2, 1.5F},
                   {"plane1998", 5, 0.5F, "", 0, 6, 3},
                   {"perceptron-segmented1998", 50, 1, "label", 10, 15, 1},
                   {"perceptron-colour1998", 50, 1, "colour", 50, 25, 1},
                   {"coleman1998", 20, 0.1F, "confidence", 2, 10, 0.25F},
                   {"elevation1998", 15, 0.1F, "", 0, 10, 2},
                   {"mug1998", 4, 1, "", 0, 0, 3}};
  mesh::Mesh all = richGrid();
  all.features.push_back({"confidence", 1, Floats(all.vertexCount(), 1)});
  ASSERT_EQ(reduce::presets().size(), std::size(kExpected));
  for (std::size_t i = 0; i < std::size(kExpected); ++i) {
    const auto& e = kExpected[i];
    const reduce::Preset& preset = reduce::presets()[i];
    EXPECT_STREQ(preset.name, e.name);
    reduce::Weights weights{{"geometry", e.geometry},
                            {"normal", e.normal},
                            {"boundary", e.boundary},
                            {"curvature", e.curvature}};
    EXPECT_EQ(reduce::presetWeights(preset, test::cube()), weights) << e.name;
    if (*e.feature != '\0') weights[e.feature] = e.of_feature;
    EXPECT_EQ(reduce::presetWeights(preset, all), weights) << e.name;
  }
}

TEST(Weights, WhereNobodySaysOtherwise) {
  const reduce::Weights expected{{"geometry", 1.0F}, {"normal", 0.05F}, {"boundary", 0.5F}};
  EXPECT_EQ(reduce::defaultWeights(test::cube()), expected);
  reduce::Weights coloured = expected;
  coloured["colour"] = 0.03F;
  coloured["label"] = 1000;
  EXPECT_EQ(reduce::defaultWeights(richGrid()), coloured);
}

}  // namespace
}  // namespace merlin::render
