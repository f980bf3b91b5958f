// The colours by which MERLIN shows a feature of a mesh.
#include "render/content/shown_colours.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "render/lod/finest_level.h"
#include "render/reduce/reduce.h"

namespace merlin::render {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

// Returns a fan of five vertices without collapses. The dendrogram renumbers its nodes, so the
// tests find a node by its value.
lod::Dendrogram fan(std::vector<mesh::Feature> features) {
  mesh::Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  mesh.triangles = {0, 1, 2, 0, 2, 3, 0, 3, 4};
  mesh.features = std::move(features);
  return lod::oneLevel(mesh);
}

Rgb colourAt(const lod::Dendrogram& model, const content::ShownColours& shown, const char* feature,
             float value) {
  const lod::FeatureView* f = model.find(feature);
  for (std::size_t n = 0; n < model.nodeCount(); ++n) {
    if (f->values[n * f->dimension] == value) return shown.rgb[n];
  }
  return {};
}

TEST(ShownColours, OneValueIsOnAScaleOverWhatThereIs) {
  const lod::Dendrogram model = fan({{"thermal", 1, {20, 30, 40, 50, 60}}});
  const auto shown = content::coloursOf(model, {.feature = "thermal"});
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->low, 20);
  EXPECT_EQ(shown->high, 50) << "the 99th percentile of five is the fourth";
  EXPECT_EQ(colourAt(model, *shown, "thermal", 20), (Rgb{68, 1, 84}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 50), (Rgb{253, 231, 37}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 60), (Rgb{253, 231, 37})) << "held at the end";
}

TEST(ShownColours, TheScaleIsAsItIsTold) {
  const lod::Dendrogram model = fan({{"thermal", 1, {20, 30, 40, 50, -3e38F}}});
  const auto shown = content::coloursOf(model, {.feature = "thermal", .range = {30, 50}});
  EXPECT_EQ(colourAt(model, *shown, "thermal", 30), (Rgb{68, 1, 84}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 40), (Rgb{33, 145, 141}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", -3e38F), (Rgb{68, 1, 84}));
}

TEST(ShownColours, ThreeAreRedGreenBlue) {
  const lod::Dendrogram model =
      fan({{"colour", 3, {1, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -3, 2, NAN}},
           {"normal", 3, {-1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}}});
  for (const char* name : {"", "colour"}) {
    const auto shown = content::coloursOf(model, {.feature = name});
    EXPECT_EQ(colourAt(model, *shown, "colour", 1), (Rgb{255, 128, 0}));
    EXPECT_EQ(colourAt(model, *shown, "colour", -3), (Rgb{0, 255, 0}));
  }
  EXPECT_EQ(colourAt(model, *content::coloursOf(model, {.feature = "normal"}), "normal", -1),
            (Rgb{0, 128, 255}));
}

TEST(ShownColours, LabelsDiffer) {
  const lod::Dendrogram model = fan({{"label", 1, {0, 1, 2, 10'000'001, 10'000'002}}});
  const auto shown = content::coloursOf(model, {.feature = "label"});
  std::set<Rgb> colours(shown->rgb.begin(), shown->rgb.end());
  EXPECT_EQ(colours.size(), 5u);
}

TEST(ShownColours, WithoutColoursThereAreNone) {
  EXPECT_TRUE(
      content::coloursOf(fan({{"thermal", 1, {1, 2, 3, 4, 5}}}), {.feature = ""})->rgb.empty());
}

TEST(ShownColours, OneValueEverywhereIsTheMiddle) {
  const lod::Dendrogram model = fan({{"thermal", 1, {7, 7, 7, 7, 7}}});
  EXPECT_EQ(content::coloursOf(model, {.feature = "thermal"})->rgb[0], (Rgb{33, 145, 141}));
}

TEST(ShownColours, WhatIsNotThereIsNamed) {
  const lod::Dendrogram model =
      fan({{"thermal", 1, {1, 2, 3, 4, 5}}, {"texcoord", 2, {0, 0, 1, 0, 0, 1, 1, 1, 0, 0}}});
  for (const char* name : {"termal", "texcoord"}) {
    EXPECT_EQ(
        content::coloursOf(model, {.feature = name}).error().what,
        std::string("the model has no feature \"") + name + "\" that can be shown; it has thermal");
  }
  EXPECT_EQ(
      content::coloursOf(fan({}), {.feature = "thermal"}).error().what,
      "the model has no feature \"thermal\" that can be shown; it has none of dimension 1 or 3");
}

}  // namespace
}  // namespace merlin::render
