// Computes a ball's axis map and sensitivities from the pushes and twists of a guided calibration.
#include "drivers/spaceball/guided_axes.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace merlin::spaceball {
namespace {

using Raw = std::array<std::int16_t, 6>;

Result<AxisAnswer> answer(GuidedAxes& guided, std::size_t step, std::initializer_list<Raw> all) {
  guided.begin(step);
  for (const Raw& raw : all) {
    BallSample sample{};
    std::copy(raw.begin(), raw.end(), sample.raw);
    // This value depends on the present settings; the calibration uses raw counts only.
    sample.translation[0] = 1;
    guided.add(sample);
  }
  return guided.end();
}

TEST(GuidedAxes, FindsABallThatStandsTurnedByAQuarter) {
  GuidedAxes guided;
  ASSERT_TRUE(answer(guided, 0, {{12, 0, -3, 0, 0, 0}, {1, -11, 0, 0, 0, 5}}));
  const auto right = answer(guided, 1, {{0, 0, 0, 0, 0, 0}, {800, -6400, 0, 0, 0, 300}});
  ASSERT_TRUE(right) << right.error().what;
  EXPECT_EQ(right->axis, -2);
  EXPECT_EQ(right->counts, 6400);
  EXPECT_EQ(right->next_axis, 1);
  EXPECT_EQ(right->next_counts, 800);
  ASSERT_TRUE(answer(guided, 2, {{5600, 0, 0, 0, 0, 0}, {-100, 0, 0, 0, 0, 0}}));
  ASSERT_TRUE(answer(guided, 3, {{0, 0, -7200, 0, 0, 0}}));
  ASSERT_TRUE(answer(guided, 4, {{0, 0, 0, 0, -1280, 0}}));
  ASSERT_TRUE(answer(guided, 5, {{0, 0, 0, 1200, 0, 0}}));
  ASSERT_TRUE(answer(guided, 6, {{0, 0, 0, 0, 0, -1440}}));
  SpaceballSettings before;
  before.null_region = 7;
  const SpaceballSettings solved = guided.solve(before);
  EXPECT_EQ(solved.axis_map, (std::array{-2, 1, -3, -5, 4, -6}));
  EXPECT_EQ(solved.dead_zone, 28);                 // 2 * 12 + 4, with 12 the largest count at rest
  EXPECT_EQ(solved.full_scale_translation, 5040);  // 0.9 of the weakest push, 5600
  EXPECT_EQ(solved.full_scale_rotation, 1080);     // 0.9 of the weakest twist, 1200
  EXPECT_EQ(solved.null_region, 7);
}

TEST(GuidedAxes, ASilentBallIsAtRest) {
  GuidedAxes guided;
  const auto rest = answer(guided, 0, {});
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->counts, 0);
  EXPECT_EQ(guided.solve({}).dead_zone, 4);
}

TEST(GuidedAxes, ATouchedBallIsNotAtRest) {
  GuidedAxes guided;
  EXPECT_TRUE(answer(guided, 0, {{0, 0, 47, 0, 0, 0}}));
  EXPECT_EQ(guided.solve({}).dead_zone, 98) << "99 is the most that a configuration may say";
  EXPECT_EQ(answer(guided, 0, {{0, 0, -48, 0, 0, 0}}).error().what,
            "Z showed 48 counts (47 are taken for noise): was it touched?");
}

TEST(GuidedAxes, WhatIsNoClearPushIsRefused) {
  GuidedAxes guided;
  EXPECT_EQ(answer(guided, 1, {{-399, 0, 0, 0, 0, 0}}).error().what,
            "X answered the most, with 399 counts (400 are needed): push it harder");
  EXPECT_EQ(answer(guided, 4, {{0, 0, 0, 0, 79, 0}}).error().what,
            "B answered the most, with 79 counts (80 are needed): twist it harder");
  EXPECT_EQ(answer(guided, 1, {{4000, -2401, 0, 0, 0, 0}}).error().what,
            "two axes answer alike, X with 4000 counts and Y with 2401 (60 % of the strongest are "
            "allowed): move it one way only");
  EXPECT_TRUE(answer(guided, 1, {{4000, -2400, 0, 0, 0, 0}}));
  EXPECT_EQ(answer(guided, 1, {{4000, 0, 0, 0, 0, 801}}).error().what,
            "C answered the most, with 801 counts, which is a twist: push it only");
  EXPECT_TRUE(answer(guided, 1, {{4000, 0, 0, 0, 0, 799}})) << "off the ball's middle";
  EXPECT_EQ(answer(guided, 5, {{4000, 0, 0, 799, 0, 0}}).error().what,
            "X answered the most, with 4000 counts, which is a push: twist it only");
}

TEST(GuidedAxes, AnAxisAnswersOnce) {
  GuidedAxes guided;
  ASSERT_TRUE(answer(guided, 1, {{4000, 0, 0, 0, 0, 0}}));
  EXPECT_EQ(answer(guided, 2, {{-5000, 0, 0, 0, 0, 0}}).error().what,
            "X answered, as it did to \"right\": move it another way");
  EXPECT_TRUE(answer(guided, 2, {{0, 5000, 0, 0, 0, 0}})) << "the same step again";
  EXPECT_TRUE(answer(guided, 1, {{4000, 0, 0, 0, 0, 0}})) << "an earlier one anew";
}

TEST(GuidedAxes, AFullScaleStaysInItsRange) {
  GuidedAxes guided;
  for (std::size_t i = 0; i < 6; ++i) {
    Raw raw{};
    raw[i] = i < 3 ? std::int16_t{-32768} : std::int16_t{80};
    ASSERT_TRUE(answer(guided, i + 1, {raw}));
  }
  EXPECT_EQ(guided.solve({}).full_scale_translation, 29491);
  EXPECT_EQ(guided.solve({}).full_scale_rotation, 100);
}

TEST(GuidedAxes, ASpaceMousesTwistsCountAsMuchAsItsPushes) {
  const auto twisted = [](const BallResponse& response) {
    GuidedAxes guided(response);
    return answer(guided, 1, {{300, 0, 0, 0, 150, 0}});
  };
  const auto mouse = twisted(kSpaceMouseResponse);
  ASSERT_TRUE(mouse) << mouse.error().what;
  EXPECT_EQ(mouse->axis, 1);
  EXPECT_EQ(mouse->counts, 300);
  EXPECT_FALSE(twisted(kSpaceballResponse)) << "that is a Spaceball's twist";
}

}  // namespace
}  // namespace merlin::spaceball
