// merlin wall align --list: the wall's answer as lines for people.
#include "daemon/cli/wall/aligned_wall.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace merlin::cli {
namespace {

TEST(AlignedWall, EachMovedPointIsNamedWithWhatToAddInTheConfiguration) {
  const auto answer = readAlignAnswer(
      R"({"undo": 2, "redo": 0, "done": "", "outputs": [{"name": "right", "width": 640,
          "height": 480, "mesh": [3, 3], "pending": false,
          "seen": {"right": [1, 0], "down": [0, 1]},
          "corners": {"top_left": {"configured": [40, 0], "moved": [-1, 0]},
                      "top_right": {"configured": [0, 0], "moved": [0, 0]},
                      "bottom_right": {"configured": [0, 0], "moved": [0, 0]},
                      "bottom_left": {"configured": [0, 0], "moved": [0, 0]}},
          "points": [{"column": 1, "row": 2, "moved": [-3.2, 2.4]}]}]})");
  ASSERT_TRUE(answer) << answer.error().what;
  EXPECT_EQ(alignmentLines(*answer),
            (std::vector<std::string>{
                "right (640 x 480)", "  top_left      +39 +0  (configured +40 +0, moved -1 +0)",
                "  top_right     +0 +0", "  bottom_left   +0 +0", "  bottom_right  +0 +0",
                "  point 1 2     moved -3.2 +2.4  (add -0.005000 +0.005000 to the point in the "
                "configuration)",
                "steps that can be undone: 2, redone: 0"}));
}

TEST(AlignedWall, ARefusalIsTheReasonAlone) {
  const auto reason = [](Errc code, const char* what, const char* command = "align") {
    return wallsReason({code, what}, command).what;
  };
  EXPECT_EQ(reason(Errc::kInvalidArgument,
                   "ipc:///run/merlin/wall-wall.command: align: there is nothing to undo"),
            "there is nothing to undo");
  EXPECT_EQ(reason(Errc::kInvalidArgument, "ipc:///x: testcard: there is no test card", "testcard"),
            "there is no test card");
  EXPECT_EQ(reason(Errc::kTimeout, "ipc:///x: align: no answer"), "ipc:///x: align: no answer");
  EXPECT_EQ(reason(Errc::kInvalidArgument, "there is no output"), "there is no output");
}

}  // namespace
}  // namespace merlin::cli
