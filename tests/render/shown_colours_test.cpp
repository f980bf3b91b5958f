// Which colours show a feature.
#include "render/content/shown_colours.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"

namespace merlin::render {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

// A fan of five vertices, not reduced: nodes are numbered by their death, so values tell them.
Dendrogram fan(std::vector<Feature> features) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  mesh.triangles = {0, 1, 2, 0, 2, 3, 0, 3, 4};
  mesh.features = std::move(features);
  CollapseLog nothing;
  nothing.features.resize(mesh.features.size());
  return buildDendrogram(mesh, nothing);
}

Rgb colourAt(const Dendrogram& model, const ShownColours& shown, const char* feature, float value) {
  const FeatureView* f = model.find(feature);
  for (std::size_t n = 0; n < model.nodeCount(); ++n) {
    if (f->values[n * f->dimension] == value) return shown.rgb[n];
  }
  return {};
}

TEST(ShownColours, OneValueIsOnAScaleOverWhatThereIs) {
  const Dendrogram model = fan({{"thermal", 1, {20, 30, 40, 50, 60}}});
  const auto shown = coloursOf(model, {.feature = "thermal"});
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->low, 20);
  EXPECT_EQ(shown->high, 50) << "the 99th percentile of five is the fourth";
  EXPECT_EQ(colourAt(model, *shown, "thermal", 20), (Rgb{68, 1, 84}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 50), (Rgb{253, 231, 37}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 60), (Rgb{253, 231, 37})) << "held at the end";
}

TEST(ShownColours, TheScaleIsAsItIsTold) {
  const Dendrogram model = fan({{"thermal", 1, {20, 30, 40, 50, -3e38F}}});
  const auto shown = coloursOf(model, {.feature = "thermal", .range = {30, 50}});
  EXPECT_EQ(colourAt(model, *shown, "thermal", 30), (Rgb{68, 1, 84}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", 40), (Rgb{33, 145, 141}));
  EXPECT_EQ(colourAt(model, *shown, "thermal", -3e38F), (Rgb{68, 1, 84}));
}

TEST(ShownColours, ThreeAreRedGreenBlue) {
  const Dendrogram model = fan({{"colour", 3, {1, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -3, 2, NAN}},
                                {"normal", 3, {-1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}}});
  for (const char* name : {"", "colour"}) {
    const auto shown = coloursOf(model, {.feature = name});
    EXPECT_EQ(colourAt(model, *shown, "colour", 1), (Rgb{255, 128, 0}));
    EXPECT_EQ(colourAt(model, *shown, "colour", -3), (Rgb{0, 255, 0}));
  }
  EXPECT_EQ(colourAt(model, *coloursOf(model, {.feature = "normal"}), "normal", -1),
            (Rgb{0, 128, 255}));
}

TEST(ShownColours, LabelsDiffer) {
  const Dendrogram model = fan({{"label", 1, {0, 1, 2, 10'000'001, 10'000'002}}});
  const auto shown = coloursOf(model, {.feature = "label"});
  std::set<Rgb> colours(shown->rgb.begin(), shown->rgb.end());
  EXPECT_EQ(colours.size(), 5u);
}

TEST(ShownColours, WithoutColoursThereAreNone) {
  EXPECT_TRUE(coloursOf(fan({{"thermal", 1, {1, 2, 3, 4, 5}}}), {.feature = ""})->rgb.empty());
}

TEST(ShownColours, OneValueEverywhereIsTheMiddle) {
  const Dendrogram model = fan({{"thermal", 1, {7, 7, 7, 7, 7}}});
  EXPECT_EQ(coloursOf(model, {.feature = "thermal"})->rgb[0], (Rgb{33, 145, 141}));
}

TEST(ShownColours, WhatIsNotThereIsNamed) {
  const Dendrogram model =
      fan({{"thermal", 1, {1, 2, 3, 4, 5}}, {"texcoord", 2, {0, 0, 1, 0, 0, 1, 1, 1, 0, 0}}});
  for (const char* name : {"termal", "texcoord"}) {
    EXPECT_EQ(coloursOf(model, {.feature = name}).error().what,
              std::string("no feature \"") + name + "\" to show; there are thermal");
  }
  EXPECT_EQ(coloursOf(fan({}), {.feature = "thermal"}).error().what,
            "no feature \"thermal\" to show; the model has none");
}

}  // namespace
}  // namespace merlin::render
