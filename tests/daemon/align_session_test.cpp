// merlin wall align with keys: what each key means, what the session asks the wall for, and what
// the screen shows.
#include "daemon/cli/wall/align_session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace merlin::cli {
namespace {

using What = AlignKey::What;

std::vector<AlignKey> keysOf(std::string_view bytes) { return AlignKeyReader().feed(bytes); }

TEST(AlignKeys, ArrowsAndLettersMove) {
  EXPECT_EQ(keysOf("hjkl"),
            (std::vector<AlignKey>{{What::kLeft}, {What::kDown}, {What::kUp}, {What::kRight}}));
  EXPECT_EQ(keysOf("\x1b[A\x1b[B\x1bOC\x1b[D"),
            (std::vector<AlignKey>{{What::kUp}, {What::kDown}, {What::kRight}, {What::kLeft}}));
  EXPECT_EQ(
      keysOf("\x1b[1;2A\x1b[1;2DJL"),
      (std::vector<AlignKey>{
          {What::kUp, true}, {What::kLeft, true}, {What::kDown, true}, {What::kRight, true}}));
}

TEST(AlignKeys, ASequenceMayComeInPieces) {
  AlignKeyReader reader;
  EXPECT_TRUE(reader.feed("\x1b").empty());
  EXPECT_TRUE(reader.feed("[1;").empty());
  EXPECT_EQ(reader.feed("2Cq"), (std::vector<AlignKey>{{What::kRight, true}, {What::kQuit}}));
}

TEST(AlignKeys, OtherKeysAreLeftOut) {
  EXPECT_TRUE(keysOf("\x1b[5~\x1b[1;5A\x1b[99;99;99;99Z\x1bx\xc3\xa4 \n9").empty());
  EXPECT_EQ(keysOf("\x1b[5~u"), (std::vector<AlignKey>{{What::kUndo}}));
  std::string hostile = "\x1b[";
  hostile.append(1000, '1');
  EXPECT_EQ(keysOf(hostile + "q").back(), (AlignKey{What::kQuit})) << "after twelve bytes";
}

class SessionTest : public testing::Test {
 protected:
  AlignSession session(const std::string& output = "") {
    return AlignSession({[this](const state::AlignRequest& request) -> Result<AlignAnswer> {
                           asked_.push_back(state::textOf(request));
                           if (!fault_.empty()) return Error{Errc::kInvalidArgument, fault_};
                           return answer_;
                         },
                         [this](const std::string& card) -> Result<Ok> {
                           cards_.push_back(card);
                           return Ok{};
                         }},
                        output);
  }
  std::string pressed(AlignSession& s, const std::string& bytes) {
    asked_.clear();
    for (const AlignKey& key : keysOf(bytes)) open_ = s.press(key) && open_;
    return fmt::format("{}", fmt::join(asked_, "; "));
  }

  AlignAnswer answer_{
      {{"left", 640, 480, false, {}}, {"right", 800, 600, false, {}}}, 3, 1, "", ""};
  std::vector<std::string> asked_, cards_;
  std::string fault_;
  bool open_ = true;
};

// One projector hangs upside down, the other one throws from behind the screen.
TEST_F(SessionTest, KeysMoveWhatIsSeenWhereTheSignalIsTurned) {
  answer_.outputs[0].axes = {{-1, 0}, {0, -1}};
  answer_.outputs[0].corners[3].moved = {4, 7};
  answer_.outputs[1].axes = {{-1, 0}, {0, 1}};
  AlignSession s = session();
  ASSERT_TRUE(s.begin());
  EXPECT_EQ(asked_.back(), "select bottom_right left") << "it is seen at the top left";
  EXPECT_EQ(pressed(s, "l"), "move bottom_right -1 0 left");
  EXPECT_EQ(pressed(s, "k"), "move bottom_right 0 1 left");
  const auto lines = s.screen();
  EXPECT_EQ(lines[2], "> 1 top_left           -4.0      -7.0   moved      -4.0      -7.0");
  EXPECT_EQ(lines[6], "corners and directions are as seen on the wall; the signal is turned");
  EXPECT_EQ(pressed(s, "n"), "select top_right right");
  EXPECT_EQ(pressed(s, "l"), "move top_right -1 0 right");
  EXPECT_EQ(pressed(s, "j"), "move top_right 0 1 right");
}

TEST(SeenAxes, AQuarterTurnGoesThereAndBack) {
  // Turned clockwise: what is to the right on the wall is below in the signal.
  const state::SeenAxes axes{{0, 1}, {-1, 0}};
  EXPECT_EQ(axes.onSignal({3, 5}), (state::Offset{-5, 3}));
  EXPECT_EQ(axes.seen({-5, 3}), (state::Offset{3, 5}));
  EXPECT_EQ(axes.cornerOnSignal(0), 1u) << "the upper left is the signal's upper right";
  EXPECT_EQ(axes.cornerOnSignal(1), 3u);
  EXPECT_EQ(axes.cornerOnSignal(3), 2u);
}

TEST_F(SessionTest, KeysBecomeRequests) {
  AlignSession s = session();
  ASSERT_TRUE(s.begin());
  EXPECT_EQ(asked_, (std::vector<std::string>{"list", "select top_left left"}));
  EXPECT_EQ(pressed(s, "l"), "move top_left 1 0 left");
  EXPECT_EQ(pressed(s, "\x1b[1;2A"), "move top_left 0 -10 left");
  EXPECT_EQ(pressed(s, "sjH"), "move top_left 0 0.1 left; move top_left -1 0 left");
  EXPECT_EQ(pressed(s, "\t3"), "select top_right left; select bottom_left left");
  EXPECT_EQ(pressed(s, "nn"), "select bottom_left right; select bottom_left left");
  EXPECT_EQ(pressed(s, "p"), "select bottom_left right");
  EXPECT_EQ(pressed(s, "ur"), "undo; redo");
  EXPECT_TRUE(open_);
  pressed(s, "q");
  EXPECT_FALSE(open_);
}

TEST_F(SessionTest, TheCardThatItPutOnIsTakenOff) {
  {
    AlignSession s = session();
    ASSERT_TRUE(s.begin());
    pressed(s, "t");
  }
  EXPECT_EQ(cards_, (std::vector<std::string>{"grid", "off"}));
  cards_.clear();
  { AlignSession s = session(); }
  EXPECT_TRUE(cards_.empty()) << "another's card stays";
}

TEST_F(SessionTest, TheScreenShowsOutputCornerAndOffsetsAndWhatWasRefused) {
  answer_.outputs[1].corners[1] = {{4, 0}, {1.5, -2}};
  AlignSession s = session("right");
  ASSERT_TRUE(s.begin());
  EXPECT_EQ(asked_[0], "select top_left right");
  pressed(s, "2");
  const auto lines = s.screen();
  EXPECT_EQ(lines[0], "Output right (2 of 2), 800 x 600 pixels");
  EXPECT_EQ(lines[3], "> 2 top_right          +5.5      -2.0   moved      +1.5      -2.0");
  EXPECT_EQ(lines[7], "step 1 px; 3 to undo, 1 to redo");
  fault_ = "stays where it is";
  pressed(s, "l");
  EXPECT_EQ(s.screen()[8], "stays where it is");
  fault_.clear();
  s.refresh();
  EXPECT_EQ(s.screen()[8], "stays where it is") << "until the next key";
}

TEST_F(SessionTest, AWallWithoutOutputsIsSaid) {
  answer_.outputs.clear();
  AlignSession s = session();
  EXPECT_NE(s.begin().error().what.find("no output that can be aligned"), std::string::npos);
}

}  // namespace
}  // namespace merlin::cli
