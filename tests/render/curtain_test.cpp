#include "render/frame/curtain.h"

#include <gtest/gtest.h>

namespace merlin::render::frame {
namespace {

using Canvas = std::vector<std::uint8_t>;

const Canvas kCanvas = {200, 100, 50, 255, 0, 255, 1, 7};

Canvas drawn(Curtain& curtain, float light) {
  Canvas canvas = kCanvas;
  curtain.setLight(light);
  curtain.draw(canvas);
  return canvas;
}

TEST(Curtain, BlackIsBlackAndAlphaStays) {
  Curtain curtain;
  EXPECT_EQ(drawn(curtain, 0), (Canvas{0, 0, 0, 255, 0, 0, 0, 7}));
}

TEST(Curtain, AShareOfTheLightIsOneOfTheSignalToThePower2Point2) {
  Curtain curtain;
  // 0.2176 ^ (1 / 2.2) = 0.5
  EXPECT_EQ(drawn(curtain, 0.2176F), (Canvas{100, 50, 25, 255, 0, 127, 0, 7}));
}

TEST(Curtain, AtFullLightNothingChanges) {
  Curtain curtain;
  EXPECT_FALSE(curtain.hasChanged());
  EXPECT_EQ(drawn(curtain, 1), kCanvas);
  EXPECT_EQ(drawn(curtain, 5), kCanvas) << "no more than all";
  EXPECT_FALSE(curtain.hasChanged());
}

TEST(Curtain, ErasingItRestoresTheCanvas) {
  Curtain curtain;
  for (const float light : {0.5F, 0.0F, 1.0F}) {
    Canvas canvas = drawn(curtain, light);
    curtain.erase(canvas);
    EXPECT_EQ(canvas, kCanvas) << light;
  }
}

TEST(Curtain, ItHasChangedUntilItIsDrawnAnew) {
  Curtain curtain;
  curtain.setLight(0);
  EXPECT_TRUE(curtain.hasChanged());
  drawn(curtain, 0);
  EXPECT_FALSE(curtain.hasChanged());
  curtain.setLight(1);
  EXPECT_TRUE(curtain.hasChanged());
}

}  // namespace
}  // namespace merlin::render::frame
