// Dendrogram::make refuses arrays with which a cut would read out of bounds or give wrong results.
// The message names the array.
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/lod/dendrogram.h"

namespace merlin::render {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Five vertices 0, 3, 4, 5, 6 and two triangles. Collapse 0 merges 6 and 5 into 2, collapse 1
// merges 4 and 3 into 1; vertex 0 is never merged.
struct Arrays {
  std::vector<float> positions = std::vector<float>(21, 1.0F);
  std::vector<float> heat = std::vector<float>(14, 1.0F);  // dimension 2
  std::size_t heat_dimension = 2;
  std::vector<std::uint32_t> parents = {2, 1};
  std::vector<std::uint32_t> triangles = {0, 4, 6, 0, 6, 5};
  std::vector<std::uint32_t> alive = {2, 1, 1};
  std::vector<float> error = {0, 0.5F, 0.5F};

  Result<lod::Dendrogram> make() const {
    return lod::Dendrogram::make(
        {positions, {{"heat", heat_dimension, heat}}, parents, triangles, alive, error, ""},
        nullptr);
  }
};

struct Fault {
  const char* name;
  std::function<void(Arrays&)> damage;
  const char* message;
};

class BrokenArrays : public testing::TestWithParam<Fault> {};

TEST(DendrogramArrays, AreFineAsTheyStand) {
  const Arrays arrays;
  const auto made = arrays.make();
  ASSERT_TRUE(made) << made.error().what;
  std::vector<std::uint32_t> corners(6);
  EXPECT_EQ(made->cut(2, corners), 1u);
  corners.resize(3);
  EXPECT_EQ(corners, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_P(BrokenArrays, AreRefused) {
  Arrays arrays;
  GetParam().damage(arrays);
  const auto made = arrays.make();
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kMalformed);
  EXPECT_NE(made.error().what.find(GetParam().message), std::string::npos) << made.error().what;
}

const Fault kSizes[] = {
    {"HalfAPosition", [](Arrays& a) { a.positions.pop_back(); }, "positions are not triples"},
    {"HalfATriangle", [](Arrays& a) { a.triangles.pop_back(); },
     "triangles are not triples of nodes"},
    {"FewerNodesThanMerges",
     [](Arrays& a) {
       a.positions.resize(12);
       a.heat.resize(8);
     },
     "2 collapses need more than 4 nodes"},
    {"ALevelWithoutACount", [](Arrays& a) { a.alive.pop_back(); }, "2 counts and 3 errors"},
    {"ALevelTooMany", [](Arrays& a) { a.alive.push_back(1); }, "4 counts and 3 errors"},
    {"ALevelWithoutAnError", [](Arrays& a) { a.error.pop_back(); }, "3 counts and 2 errors"},
    {"NoLevelAtAll",
     [](Arrays& a) {
       a.parents.clear();
       a.alive.clear();
       a.error.clear();
     },
     "0 collapses need 1 levels"},
    {"HalfAFeature", [](Arrays& a) { a.heat.pop_back(); },
     "feature heat: 13 values for 7 nodes x 2"},
    {"AFeatureTooLong", [](Arrays& a) { a.heat.push_back(1); }, "feature heat: 15 values"},
    {"AFeatureWithoutDimension",
     [](Arrays& a) {
       a.heat_dimension = 0;
       a.heat.clear();
     },
     "feature heat: 0 values"},
};

const Fault kValues[] = {
    {"AParentBeyondTheNodes", [](Arrays& a) { a.parents[0] = 7; },
     "collapse 0: the number of the parent, 7,"},
    {"AParentThatIsItsChild", [](Arrays& a) { a.parents[0] = 6; },
     "collapse 0: the number of the parent, 6,"},
    {"AParentThatIsItsOtherChild", [](Arrays& a) { a.parents[0] = 5; },
     "collapse 0: the number of the parent, 5,"},
    {"AParentThatDiedBefore", [](Arrays& a) { a.parents[1] = 5; },
     "collapse 1: the number of the parent, 5,"},
    {"ALastParentThatIsItsChild", [](Arrays& a) { a.parents[1] = 3; },
     "collapse 1: the number of the parent, 3,"},
    {"ANodeMadeTwice", [](Arrays& a) { a.parents[1] = 2; }, "collapse 1: node 2 is made twice"},
    {"ACornerBeyondTheNodes", [](Arrays& a) { a.triangles[5] = 7; },
     "triangle 1: there is no node 7, the model has 7"},
    {"ACornerThatIsNoLeaf", [](Arrays& a) { a.triangles[4] = 2; },
     "triangle 1: node 2 is not a vertex of the mesh"},
    {"ACountBeyondTheTriangles", [](Arrays& a) { a.alive[0] = 3; },
     "level 0: 3 triangles, at most 2 are possible"},
    {"ACountThatRises", [](Arrays& a) { a.alive[2] = 2; },
     "level 2: 2 triangles, at most 1 are possible"},
    {"AnErrorThatFalls", [](Arrays& a) { a.error[2] = 0.4F; },
     "level 2: its error is not finite, or is less than the error of the level before it"},
    {"AnErrorThatIsNoNumber", [](Arrays& a) { a.error[2] = kNan; },
     "level 2: its error is not finite"},
    {"AFirstErrorThatIsNoNumber", [](Arrays& a) { a.error[0] = kNan; },
     "level 0: its error is not finite"},
    {"AnErrorWithoutEnd", [](Arrays& a) { a.error[2] = kInfinity; },
     "level 2: its error is not finite"},
    {"APositionThatIsNoNumber", [](Arrays& a) { a.positions[20] = kNan; },
     "a position is not finite"},
    {"APositionWithoutEnd", [](Arrays& a) { a.positions[0] = -kInfinity; },
     "a position is not finite"},
};

std::string nameOf(const testing::TestParamInfo<Fault>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Sizes, BrokenArrays, testing::ValuesIn(kSizes), nameOf);
INSTANTIATE_TEST_SUITE_P(Values, BrokenArrays, testing::ValuesIn(kValues), nameOf);

}  // namespace
}  // namespace merlin::render
