// Which alignments are set aside when an output changes, and which of them are used again later.
#include "daemon/wall/alignment_fit.h"

#include <string>

#include <gtest/gtest.h>

namespace merlin::wall {
namespace {

class AlignmentFit : public testing::Test {
 protected:
  AlignmentFit() {
    wall_.outputs.resize(2);
    for (render::out::OutputSettings& output : wall_.outputs) {
      output.kind = render::out::OutputKind::kPng;
      output.tiles = {{wall_.tiles.tiles[0].name}};
    }
    wall_.outputs[0].name = "left";
    wall_.outputs[1].name = "right";
    size_ = *render::out::pictureSize(wall_.outputs[0], wall_.tiles);
  }
  state::OutputForm form(const std::string& output, int width) const {
    return {output, width, size_.height, 0, 0, std::array<double, 8>{}};
  }

  WallSettings wall_;
  render::out::PictureSize size_;
};

// A reload has to announce this before it is carried out.
TEST_F(AlignmentFit, NamesTheOutputsWhoseAlignmentsDoNotFitOrFitAgain) {
  state::Alignment alignment, earlier;
  alignment.move(form("left", size_.width), state::cornerAt(0), {1, 1});
  alignment.move(form("right", 64), state::cornerAt(0), {1, 1});
  alignment.move(form("gone", 64), state::cornerAt(0), {1, 1});
  auto fitted = fittedOutputs(wall_, alignment, {});
  ASSERT_EQ(fitted.size(), 1u);
  EXPECT_EQ(fitted[0].output, "right");
  EXPECT_TRUE(fitted[0].fitted.aside_why.starts_with("it was made for 64 x "))
      << fitted[0].fitted.aside_why;
  EXPECT_FALSE(fitted[0].fitted.is_back);
  earlier.move(form("right", size_.width), state::cornerAt(0), {1, 1});
  state::SetAside aside;
  aside.add(earlier);
  fitted = fittedOutputs(wall_, alignment, aside);
  ASSERT_EQ(fitted.size(), 1u);
  EXPECT_EQ(fitted[0].output, "right");
  EXPECT_TRUE(fitted[0].fitted.is_back && !fitted[0].fitted.aside_why.empty());
}

TEST_F(AlignmentFit, OfAnOutputWithNothingMovedAndNoStepsNothingIsSetAside) {
  state::Alignment alignment;
  alignment.move(form("right", 64), state::cornerAt(0), {1, 1});
  alignment.undo();
  alignment.move(form("left", size_.width), state::cornerAt(0), {1, 1});
  for (const FittedOutput& output : fittedOutputs(wall_, alignment, {}))
    EXPECT_EQ(output.fitted.aside_why, "") << output.output;
}

}  // namespace
}  // namespace merlin::wall
