#include "render/frame/pointer_marker.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3f;

class PointerMarkerTest : public testing::Test {
 protected:
  std::size_t at(int x, int y) const {
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(plan_.frame_width) +
                static_cast<std::size_t>(x));
  }
  // Returns whether the marker covers the pixel; pixels that are not covered are grey (90).
  bool marked(int x, int y) const { return pixels_[at(x, y)] != 90; }
  std::size_t markedPixels() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < pixels_.size(); i += 4) n += pixels_[i] != 90;
    return n;
  }

  void draw(const std::optional<Vector3f>& at_eye_m) {
    marker_.pointAt({at_eye_m});
    marker_.draw(pixels_);
  }
  bool wouldMoveTo(const std::optional<Vector3f>& at_eye_m) {
    marker_.pointAt({at_eye_m});
    return marker_.hasChanged();
  }

  tiles::TilePlan plan_ = *tiles::planTiles({});  // 640 x 480 pixels, 40 degrees each
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(4 * 1280 * 960, 90);
  frame::PointerMarker marker_{plan_};
};

// The centre tile is the upper right quadrant of the frame.
TEST_F(PointerMarkerTest, StraightAheadIsTheMiddleOfTheCentreTile) {
  EXPECT_EQ(marker_.pixelOf({0, 0, -2}), Vector2i(960, 240));
  draw(Vector3f(0, 0, -2));
  EXPECT_EQ(pixels_[at(960, 240)], 255);
  EXPECT_EQ(pixels_[at(960, 240) + 1], 120);
  EXPECT_TRUE(marked(969, 240));
  EXPECT_FALSE(marked(970, 240));
  EXPECT_EQ(pixels_[at(969, 240)], 20) << "a dark rim";
  EXPECT_EQ(pixels_[at(960, 240) + 3], 90) << "alpha stays";
}

// Each of several hands has its own disc. Erasing the discs must restore the picture, also where
// they overlapped.
TEST_F(PointerMarkerTest, SeveralHandsHaveDiscsOfTheirOwn) {
  const std::vector<std::uint8_t> before = pixels_;
  marker_.pointAt({Vector3f(0, 0, -2), Vector3f(0.02F, 0, -2), Vector3f(0.3F, 0, -2)});
  EXPECT_TRUE(marker_.hasChanged());
  marker_.draw(pixels_);
  EXPECT_FALSE(marker_.hasChanged());
  EXPECT_EQ(pixels_[at(960, 240)], 255) << "orange, above the other";
  const Vector2i third = *marker_.pixelOf({0.3F, 0, -2});
  EXPECT_EQ(pixels_[at(third.x(), third.y())], 60) << "green";
  marker_.erase(pixels_);
  EXPECT_EQ(pixels_, before);
}

// The seam between the left tile (upper left in the frame) and the centre tile is 20 degrees to the
// left.
TEST_F(PointerMarkerTest, ADiscOverASeamIsInBothTiles) {
  const float seam = 20 * std::numbers::pi_v<float> / 180 - 0.001F;
  draw(Vector3f(-std::sin(seam), 0, -std::cos(seam)));
  EXPECT_TRUE(marked(641, 240));
  EXPECT_TRUE(marked(638, 240)) << "the left tile's right edge";
  EXPECT_FALSE(marked(700, 240));
}

TEST_F(PointerMarkerTest, EraseBringsThePixelsBack) {
  const auto before = pixels_;
  for (const Vector3f& p : {Vector3f(0, 0, -2), Vector3f(0.1F, 0.5F, -2), Vector3f(-0.7F, 0, -2)}) {
    draw(p);
    EXPECT_NE(pixels_, before);
    marker_.erase(pixels_);
    EXPECT_EQ(pixels_, before);
  }
}

TEST_F(PointerMarkerTest, WhatNoWallTileShowsIsNotDrawn) {
  for (const Vector3f& p : {Vector3f(0, 0, 2), Vector3f(0, 2, -1), Vector3f(5, 0, 0.1F)}) {
    EXPECT_EQ(marker_.pixelOf(p), std::nullopt);
    draw(p);
    EXPECT_EQ(markedPixels(), 0u);
  }
  draw(std::nullopt);
  EXPECT_EQ(markedPixels(), 0u);
}

TEST_F(PointerMarkerTest, MovesByWholePixels) {
  EXPECT_FALSE(wouldMoveTo(std::nullopt));
  EXPECT_TRUE(wouldMoveTo(Vector3f(0, 0, -2)));
  draw(Vector3f(0, 0, -2));
  marker_.erase(pixels_);
  EXPECT_FALSE(wouldMoveTo(Vector3f(0.0001F, 0, -2)));
  EXPECT_TRUE(wouldMoveTo(Vector3f(0.01F, 0, -2)));
  EXPECT_TRUE(wouldMoveTo(std::nullopt)) << "it goes";
}

}  // namespace
}  // namespace merlin::render
