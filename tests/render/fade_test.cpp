// Fade: equal steps from one image to the next; the last frame is exactly the new image.
#include "render/frame/fade.h"

#include <gtest/gtest.h>

namespace merlin::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes taken(std::span<const std::uint8_t> pixels) { return {pixels.begin(), pixels.end()}; }

TEST(Fade, GoesInEqualStepsAndEndsWithThePictureItself) {
  const Bytes from = {0, 255, 90, 10}, to = {90, 0, 90, 11};
  frame::Fade fade;
  fade.keep(from);
  fade.begin(3);
  EXPECT_EQ(taken(fade.next(to)), (Bytes{29, 171, 90, 10}));
  EXPECT_EQ(taken(fade.next(to)), (Bytes{59, 86, 90, 10}));
  EXPECT_TRUE(fade.isOn());
  EXPECT_EQ(taken(fade.next(to)), to);
  EXPECT_FALSE(fade.isOn());
}

TEST(Fade, TurnsOnItsWayToAnotherPicture) {
  frame::Fade fade;
  fade.keep(Bytes{0});
  fade.begin(2);
  EXPECT_EQ(taken(fade.next(Bytes{200})), Bytes{100});
  fade.begin(2);
  EXPECT_EQ(taken(fade.next(Bytes{50})), Bytes{75});
  EXPECT_EQ(taken(fade.next(Bytes{50})), Bytes{50});
}

TEST(Fade, OfOneFrameOrOfAnotherSizeIsThereAtOnce) {
  frame::Fade fade;
  fade.keep(Bytes{0});
  fade.begin(1);
  EXPECT_EQ(taken(fade.next(Bytes{200})), Bytes{200});
  fade.begin(5);
  EXPECT_EQ(taken(fade.next(Bytes{1, 2})), (Bytes{1, 2}));
  EXPECT_FALSE(fade.isOn());
}

}  // namespace
}  // namespace merlin::render
