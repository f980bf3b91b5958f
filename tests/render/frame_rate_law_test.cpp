// The frame rate law of [GOURLEY98] compared with figures computed by hand, at given times.
#include "render/inventor/frame_rate_law.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

using Answer = std::optional<std::int32_t>;

// Reports `frames` + 1 frames at `hz`, the first one at `start_s`; returns the law's last answer.
Answer draw(inventor::FrameRateLaw& law, double start_s, double hz, int frames,
            std::size_t triangles, double desired_hz) {
  Answer answer;
  for (int i = 0; i <= frames; ++i)
    answer = law.frameDrawn(start_s + i / hz, triangles, desired_hz);
  return answer;
}

TEST(FrameRateLaw, IsTrianglesASecondOverTheRate) {
  inventor::FrameRateLaw law;
  // The model of [GOURLEY98] figure 5.37 at 8 Hz is drawn at 306,144 triangles/s, which are 5,102
  // triangles a frame at 60 Hz.
  EXPECT_EQ(draw(law, 100, 8, 8, 38268, 60), 5102);
  // The same model at 223,020 and 72,000 triangles/s, as on the two machines of the dissertation.
  EXPECT_NEAR(draw(law, 200, 223020.0 / 38268, 6, 38268, 60).value_or(0), 3717, 1);
  EXPECT_NEAR(draw(law, 300, 72000.0 / 38268, 2, 38268, 60).value_or(0), 1200, 1);
}

TEST(FrameRateLaw, AnswersOnceASecond) {
  inventor::FrameRateLaw law;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(law.frameDrawn(i / 8.0, 1000, 16), std::nullopt) << i;
  EXPECT_EQ(law.frameDrawn(1, 1000, 16), 500);
  for (int i = 9; i < 16; ++i) EXPECT_EQ(law.frameDrawn(i / 8.0, 1000, 16), std::nullopt) << i;
  EXPECT_EQ(law.frameDrawn(2, 1000, 16), 500);
}

TEST(FrameRateLaw, AFrameLongerThanTheWindowIsAWindow) {
  inventor::FrameRateLaw law;
  EXPECT_EQ(draw(law, 0, 0.25, 1, 1000, 10), 25);  // 250 triangles a second
}

TEST(FrameRateLaw, WithinToleranceItLeavesTheResolution) {
  inventor::FrameRateLaw law;
  EXPECT_EQ(draw(law, 0, 64, 64, 1000, 60), std::nullopt);   // exact: 1066 triangles a frame
  EXPECT_EQ(draw(law, 10, 64, 64, 1000, 70), std::nullopt);  // exact: 914
  EXPECT_EQ(draw(law, 20, 64, 64, 1000, 50), 1280);
  EXPECT_EQ(draw(law, 30, 64, 64, 1000, 80), 800);
}

TEST(FrameRateLaw, APauseIsCountedUnlessItWasARest) {
  inventor::FrameRateLaw law;
  law.frameDrawn(0, 1000, 16);
  EXPECT_EQ(law.frameDrawn(100, 1000, 16), 0);  // 10 triangles a second
  law.rest();
  EXPECT_EQ(draw(law, 200, 8, 8, 1000, 16), 500);
}

TEST(FrameRateLaw, TimesThatGoBackOrAreNoneBeginAnew) {
  inventor::FrameRateLaw law;
  law.frameDrawn(50, 1000, 10);
  EXPECT_EQ(draw(law, 3, 8, 8, 1000, 16), 500);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e308}) {
    EXPECT_EQ(law.frameDrawn(bad, 1000, 10), std::nullopt) << bad;
  }
  law.rest();
  EXPECT_EQ(draw(law, 4, 8, 8, 1000, 16), 500);
}

TEST(FrameRateLaw, StaysWithinWhatAFieldHolds) {
  inventor::FrameRateLaw law;
  EXPECT_EQ(draw(law, 0, 8, 8, 1'000'000'000, 1e-30), 2147483647);
  EXPECT_EQ(draw(law, 10, 8, 8, 1000, 1e30), 0);
  EXPECT_EQ(draw(law, 20, 8, 8, 0, 10), std::nullopt);
}

}  // namespace
}  // namespace merlin::render
