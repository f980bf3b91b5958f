// Finds how a touch surface is mounted from the corners that a person touched.
#include "drivers/port/guided_corners.h"

#include <gtest/gtest.h>

#include "tests/support/recording_sink.h"

namespace merlin {
namespace {

TouchSample finger(float x, float y, std::uint32_t fingers = 1) {
  TouchSample sample{};
  sample.fingers = fingers;
  sample.position[0][0] = x;
  sample.position[0][1] = y;
  return sample;
}

Result<SurfacePlace> touched(GuidedCorners& guided, std::size_t step, float x, float y) {
  guided.begin(step);
  guided.add(finger(x + 0.01F, y));
  guided.add(TouchSample{});  // the finger was lifted meanwhile
  guided.add(finger(x - 0.01F, y));
  return guided.end();
}

// There are eight ways to mount a surface. With the resulting settings, MERLIN must have each touch
// where the person sees the finger.
TEST(GuidedCorners, FindEachWayToMountASurface) {
  for (int way = 0; way < 8; ++way) {
    const TouchOrientation mounted{(way & 1) != 0, (way & 2) != 0, (way & 4) != 0};
    // Returns the device's coordinates of a finger that the person sees at (x, y).
    const auto device = [&](float x, float y) {
      if (mounted.invert_x) x = 1 - x;
      if (mounted.invert_y) y = 1 - y;
      return mounted.swap_axes ? std::array{y, x} : std::array{x, y};
    };
    GuidedCorners guided;
    const std::array<std::array<float, 2>, 3> corners = {
        {{0.1F, 0.2F}, {0.9F, 0.2F}, {0.1F, 0.8F}}};
    for (std::size_t step = 0; step < corners.size(); ++step) {
      const auto at = device(corners[step][0], corners[step][1]);
      ASSERT_TRUE(touched(guided, step, at[0], at[1])) << way;
    }
    test::RecordingSink sink;
    TouchFrames frames(sink, guided.solve());
    const auto at = device(0.3F, 0.6F);
    frames.begin();
    frames.add(1, at[0], at[1]);
    frames.publish({});
    ASSERT_EQ(sink.touch.size(), 1U);
    EXPECT_NEAR(sink.touch[0].position[0][0], 0.3F, 1e-6) << way;
    EXPECT_NEAR(sink.touch[0].position[0][1], 0.6F, 1e-6) << way;
  }
}

TEST(GuidedCorners, SayWhatCannotBeUsed) {
  GuidedCorners guided;
  guided.begin(0);
  EXPECT_EQ(guided.end().error().what, "nothing touched the surface");
  guided.add(finger(0, 0, 2));
  EXPECT_EQ(guided.end().error().what, "several fingers touched it: use one");
  ASSERT_TRUE(touched(guided, 0, 0.5F, 0.5F));
  EXPECT_EQ(touched(guided, 1, 0.6F, 0.5F).error().what,
            "it lies only 0.10 of the surface away from the top left corner (0.3 are needed); a "
            "mouse, which has no corners, needs --mouse-counts");
  ASSERT_TRUE(touched(guided, 1, 0.9F, 0.5F));
  EXPECT_EQ(touched(guided, 2, 0.1F, 0.6F).error().what,
            "it lies in the same direction as the top right corner");
}

}  // namespace
}  // namespace merlin
