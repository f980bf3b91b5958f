// The daemon's state: alignments with their steps, alignments that are set aside, and the state's
// text.
#include "daemon/state/state.h"

#include <gtest/gtest.h>

namespace merlin::state {
namespace {

const OutputForm kLeft{"left", 640, 480, 3, 3, std::array<double, 8>{4, 8, 0.5}},
    kRight{"right", 800, 600, 0, 0};
const Place kTopLeft = *cornerNamed("top_left"), kBottomRight = *cornerNamed("bottom_right");
constexpr Place kPoint{Place::Of::kMesh, 2, 1};

TEST(Alignment, CornersHaveTheOrderOfACorrection) {
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(cornerAt(i).corner(), i);
    EXPECT_EQ(nameOf(cornerAt(i)), kCornerNames[i]);
    EXPECT_EQ(cornerNamed(kCornerNames[i]), cornerAt(i));
  }
  EXPECT_EQ(kBottomRight, (Place{Place::Of::kPin, 1, 1}));
  EXPECT_FALSE(cornerNamed("upper_left"));
  EXPECT_EQ(nameOf(kPoint), "point 2 1");
}

TEST(Alignment, MovesAddUpWithoutDrift) {
  Alignment a;
  for (int i = 0; i < 10; ++i) a.move(kLeft, kTopLeft, {0.1, -0.3});
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{1, -3}));
  EXPECT_EQ(a.offset("left", kBottomRight), Offset{});
  EXPECT_EQ(a.offset("right", kTopLeft), Offset{});
  for (int i = 0; i < 10; ++i) a.move(kLeft, kTopLeft, {-0.1, 0.3});
  EXPECT_EQ(a.moved(), 0u);
  EXPECT_EQ(a.steps.size(), 20u);
}

TEST(Alignment, UndoAndRedoGoThroughTheSteps) {
  Alignment a;
  a.move(kLeft, kTopLeft, {1, 2});
  a.move(kRight, kBottomRight, {3, 4});
  a.move(kLeft, kPoint, {0, 5});
  EXPECT_EQ(a.undo()->output, "left");
  EXPECT_EQ(a.offset("left", kPoint), Offset{});
  EXPECT_EQ(a.undo()->output, "right");
  EXPECT_EQ(a.offset("right", kBottomRight), Offset{});
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{1, 2}));
  EXPECT_TRUE(a.redo());
  EXPECT_EQ(a.offset("right", kBottomRight), (Offset{3, 4}));
  a.move(kLeft, kTopLeft, {1, 1});
  EXPECT_FALSE(a.redo()) << "a new step takes the place of those that were undone";
  EXPECT_EQ(a.steps.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(a.undo());
  EXPECT_FALSE(a.undo());
  EXPECT_EQ(a.moved(), 0u);
}

TEST(Alignment, AResetIsOneStep) {
  Alignment a;
  EXPECT_FALSE(a.reset("left"));
  a.move(kLeft, kTopLeft, {1, 2});
  a.move(kLeft, kPoint, {3, 4});
  EXPECT_TRUE(a.reset("left"));
  EXPECT_EQ(a.moved(), 0u);
  EXPECT_FALSE(a.reset("left"));
  a.undo();
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{1, 2}));
  EXPECT_EQ(a.offset("left", kPoint), (Offset{3, 4}));
}

TEST(Alignment, APushOfTheBallIsOneStep) {
  Alignment a;
  a.moveOn(kLeft, kTopLeft, {1, 0});
  a.moveOn(kLeft, kTopLeft, {1, 0});
  EXPECT_EQ(a.steps.size(), 1u);
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{2, 0}));
  a.moveOn(kLeft, kBottomRight, {1, 0});
  EXPECT_EQ(a.steps.size(), 2u);
  a.undo();
  a.moveOn(kLeft, kTopLeft, {1, 0});
  EXPECT_EQ(a.steps.size(), 2u) << "not a part of a step before one that was undone";
  a.undo();
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{2, 0}));
}

TEST(Alignment, TheOldestStepsAreForgotten) {
  Alignment a;
  for (int i = 0; i < 130; ++i) a.move(kLeft, kTopLeft, {1, 0});
  EXPECT_EQ(a.steps.size(), kMostSteps);
  while (a.undo()) {
  }
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{30, 0}));
}

TEST(Alignment, AnOutputIsTakenOutWithItsStepsAndPutBack) {
  Alignment a;
  a.move(kLeft, kTopLeft, {1, 2});
  a.move(kRight, kBottomRight, {3, 4});
  a.move(kLeft, kTopLeft, {1, 2});
  a.undo();
  const Alignment left = a.take("left");
  EXPECT_EQ(a.steps.size(), 1u);
  EXPECT_EQ(a.done, 1u);
  EXPECT_FALSE(a.find("left"));
  EXPECT_EQ(left.outputs.size(), 1u);
  EXPECT_EQ(left.steps.size(), 2u);
  EXPECT_EQ(left.done, 1u);
  a.put(left);
  EXPECT_EQ(a.done, 2u);
  EXPECT_EQ(a.redo()->output, "left");
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{2, 4}));
  a.undo();
  EXPECT_EQ(a.undo()->output, "left") << "its steps are the newest ones";
  EXPECT_EQ(a.undo()->output, "right");
  EXPECT_FALSE(a.undo());
}

TEST(Alignment, TheStepsOfBothAreLimitedWhereOneIsPutBack) {
  Alignment a, b;
  for (int i = 0; i < 80; ++i) a.move(kLeft, kTopLeft, {1, 0});
  for (int i = 0; i < 80; ++i) b.move(kRight, kTopLeft, {1, 0});
  a.put(b);
  EXPECT_EQ(a.steps.size(), kMostSteps);
  while (a.undo()) {
  }
  EXPECT_EQ(a.offset("left", kTopLeft), (Offset{60, 0}));
  EXPECT_EQ(a.offset("right", kTopLeft), Offset{});
}

// Outputs are renamed over the years, so the number of remembered outputs is limited.
TEST(Alignment, BeyondTheMostOutputsTheFirstOneIsForgottenAndOneThatIsNotMovedBefore) {
  const auto formOf = [](std::size_t i) { return OutputForm{std::to_string(i), 640, 480, 0, 0}; };
  State state;
  Alignment& a = state.alignment;
  for (std::size_t i = 0; i < kMostAligned; ++i) a.move(formOf(i), kTopLeft, {1, 0});
  a.undo();
  a.move(formOf(1000), kTopLeft, {1, 0});
  EXPECT_FALSE(a.find(std::to_string(kMostAligned - 1))) << "nothing of it was moved";
  EXPECT_TRUE(a.find("0"));
  a.move(formOf(1001), kTopLeft, {1, 0});
  EXPECT_FALSE(a.find("0"));
  EXPECT_TRUE(a.find("1") && a.find("1000") && a.find("1001"));
  const Alignment taken = a.take("1001");
  a.move(formOf(1002), kTopLeft, {1, 0});
  a.put(taken);
  EXPECT_FALSE(a.find("1"));
  EXPECT_EQ(a.outputs.size(), kMostAligned);
  EXPECT_TRUE(parseState(stateText(state), "f"));
}

Alignment alignedAt(int width, const std::string& output = "left") {
  Alignment a;
  a.move({output, width, 480, 0, 0, std::array<double, 8>{}}, kTopLeft, {1, 2});
  return a;
}

std::vector<int> widthsOf(const SetAside& aside) {
  std::vector<int> widths;
  for (const Alignment& a : aside.alignments()) widths.push_back(a.outputs.front().form.width);
  return widths;
}

TEST(SetAside, KeepsTheLastFormsOfEachOutput) {
  SetAside aside;
  aside.add(alignedAt(1, "right"));
  for (const int width : {640, 800, 1024, 640, 1280, 1920}) aside.add(alignedAt(width));
  EXPECT_EQ(widthsOf(aside), (std::vector{1, 1024, 640, 1280, 1920}));
  const auto taken =
      aside.take([](const Alignment& a) { return a.outputs.front().form.width == 640; });
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->offset("left", kTopLeft), (Offset{1, 2}));
  EXPECT_EQ(widthsOf(aside), (std::vector{1, 1024, 1280, 1920}));
  EXPECT_FALSE(aside.take([](const Alignment&) { return false; }));
  aside.add(Alignment{});
  EXPECT_EQ(aside.alignments().size(), 4u) << "nothing is not kept";
}

// One alignment fits the base mesh of one configuration, the other alignment that of another
// configuration.
TEST(SetAside, KeepsTwoOfTheSameForm) {
  SetAside aside;
  aside.add(alignedAt(640));
  Alignment other = alignedAt(640);
  other.move(other.outputs[0].form, kBottomRight, {5, 5});
  aside.add(other);
  const auto fits = [](const Alignment& a) { return a.moved() == 1; };
  EXPECT_TRUE(aside.take(fits));
  EXPECT_EQ(widthsOf(aside), std::vector{640});
}

TEST(SetAside, CountsSteps) {
  SetAside aside;
  for (int i = 0; i < 40; ++i) {
    Alignment one;
    for (int step = 0; step < 100; ++step)
      one.move({std::to_string(i), 640, 480, 0, 0}, kTopLeft, {1, 0});
    aside.add(one);
  }
  EXPECT_EQ(aside.alignments().size(), 19u) << "each has 1 place, 100 steps and as many changes";
}

TEST(SetAside, IsLimitedInAll) {
  SetAside aside;
  for (int i = 0; i < 100; ++i) aside.add(alignedAt(640, std::to_string(i)));
  EXPECT_EQ(aside.alignments().size(), kMostAside);
  EXPECT_EQ(aside.alignments().back().outputs.front().form.output, "99");
}

TEST(OutputForm, OfAnEarlierVersionFitsWhateverTheCorners) {
  OutputForm old = kLeft;
  old.corners.reset();
  EXPECT_TRUE(old.fits(kLeft));
  EXPECT_FALSE(kLeft.fits(old));
  EXPECT_TRUE(kLeft.fits(kLeft));
  OutputForm wider = kLeft;
  wider.width = 800;
  EXPECT_FALSE(old.fits(wider));
}

State someState() {
  State state;
  state.rate_hz = 25;
  state.content = "/models/b \"x\".mrm";
  state.playlist_off = true;
  state.projectors = {false, 29'670'840};
  state.alignment.move(kLeft, kTopLeft, {1.5, -2.001});
  state.alignment.move(kLeft, kPoint, {3, 4});
  state.alignment.move(kRight, kBottomRight, {-7, 0});
  state.alignment.undo();
  state.set_aside.add(alignedAt(800));
  return state;
}

TEST(StateText, IsReadBackAsItWas) {
  const State written = someState();
  const auto read = parseState(stateText(written), "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(stateText(*read), stateText(written));
  EXPECT_EQ(read->rate_hz, 25);
  EXPECT_EQ(read->content, written.content);
  EXPECT_TRUE(read->playlist_off);
  ASSERT_TRUE(read->projectors);
  EXPECT_FALSE(read->projectors->on);
  EXPECT_EQ(read->projectors->local_minute, 29'670'840);
  EXPECT_EQ(read->alignment.offset("left", kTopLeft), (Offset{1.5, -2.001}));
  EXPECT_EQ(read->alignment.offset("left", kPoint), (Offset{3, 4}));
  EXPECT_EQ(read->alignment.find("left")->form, kLeft);
  EXPECT_EQ(read->alignment.done, 2u);
  ASSERT_EQ(widthsOf(read->set_aside), std::vector{800});
  EXPECT_EQ(read->set_aside.alignments()[0].steps.size(), 1u);
  Alignment again = read->alignment;
  EXPECT_EQ(again.redo()->output, "right");
  EXPECT_EQ(again.offset("right", kBottomRight), (Offset{-7, 0}));
}

// Otherwise the state would be set aside as damaged, and with it the alignment.
TEST(StateText, OfProjectorsSwitchedWhileTheClockWasWrongIsReadBack) {
  for (const auto& [minute, kept] :
       {std::pair<std::int64_t, std::int64_t>{-300, 0}, {9'000'000'000, 5'000'000'000}}) {
    State written = someState();
    written.projectors = {true, minute};
    const auto read = parseState(stateText(written), "f");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(read->projectors->local_minute, kept);
    EXPECT_EQ(read->alignment.done, 2u);
  }
}

TEST(StateText, OfNothingIsReadBack) {
  const auto read = parseState(stateText({}), "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_FALSE(read->rate_hz || read->playlist_off || read->projectors);
  EXPECT_EQ(read->alignment.steps.size(), 0u);
}

// This is the text of an older merlind, which did not yet store the playlist and the projectors.
TEST(StateText, OfVersion1IsRead) {
  const auto read = parseState(R"({"merlin_state": 1,
"rate_hz": 25.0,
"content": "/models/b.mrm",
"alignment": {"outputs": [
{"output":"left","size":[640,480],"mesh":[3,3],"moved":[{"place":"top_left","by":[1.5,-2.001]}]}],
"steps": [
],
"done": 0}}
)",
                               "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->rate_hz, 25);
  EXPECT_EQ(read->alignment.offset("left", kTopLeft), (Offset{1.5, -2.001}));
  EXPECT_FALSE(read->playlist_off || read->projectors);
}

// This is the text of an older merlind, which did not yet set alignments aside.
TEST(StateText, OfVersion2IsRead) {
  const auto read = parseState(
      R"({"merlin_state": 2, "playlist": "off",
          "alignment": {"outputs": [], "steps": [], "done": 0}})",
      "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->playlist_off);
  EXPECT_TRUE(read->set_aside.alignments().empty());
}

TEST(State, HasTheAlignmentThatFitsAnOutput) {
  State state = someState();
  EXPECT_EQ(alignmentFor(state, kLeft), state.alignment.find("left"));
  const OutputForm wide{"left", 800, 480, 0, 0, std::array<double, 8>{}};
  const OutputAlignment* const aside = alignmentFor(state, wide);
  ASSERT_TRUE(aside);
  EXPECT_EQ(aside->form, wide);
  EXPECT_FALSE(alignmentFor(state, {"left", 801, 480, 0, 0, std::array<double, 8>{}}));
}

// A file that is cut or has one wrong byte gives either an error, or a state within the limits.
TEST(StateText, EveryCutAndEveryDamagedByteIsSeenOrHarmless) {
  const std::string text = stateText(someState());
  for (std::size_t size = 0; size + 1 < text.size(); ++size)  // the last byte is the line end
    EXPECT_FALSE(parseState(text.substr(0, size), "f")) << size;
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char c : {'\0', ' ', '9', '-', '"', '}', '\xff'}) {
      std::string damaged = text;
      damaged[i] = c;
      const auto read = parseState(damaged, "f");
      if (!read) continue;
      EXPECT_TRUE(parseState(stateText(*read), "f")) << i << ": " << c;
    }
  }
}

// Numbers and names of maximum length.
constexpr Offset kLong{-999999.999, -999999.999};
OutputForm longForm(std::size_t i) {
  std::string name = std::to_string(i);
  name.resize(64, 'a');
  std::array<double, 8> corners{};
  corners.fill(-999999.999);
  return {name, 8192, 8192, 64, 64, corners};
}
Place pointAt(std::size_t i) {
  return {Place::Of::kMesh, static_cast<int>(i % 64), static_cast<int>(i / 64)};
}

// Returns an alignment with this many steps of this many changes each, and this many moved places.
Alignment longAlignment(std::size_t number, std::size_t moved, std::size_t steps,
                        std::size_t changes) {
  Alignment a;
  a.outputs = {{longForm(number), {}}};
  for (std::size_t i = 0; i < moved; ++i) a.outputs[0].moved[pointAt(i)] = kLong;
  a.steps.assign(steps, {a.outputs[0].form.output, {}});
  for (Step& step : a.steps) step.changes.assign(changes, {pointAt(4000), kLong, kLong});
  a.done = steps;
  return a;
}

TEST(StateText, OfTheLargestStateIsReadBack) {
  State few, many;  // the entries that are set aside
  for (State* state : {&few, &many}) {
    Alignment& a = state->alignment;
    a = longAlignment(0, kMostMoved, kMostSteps, kMostChanges / kMostSteps);
    for (std::size_t i = 1; i < kMostAligned; ++i) a.outputs.push_back({longForm(i), {}});
  }
  few.set_aside.add(longAlignment(0, 0, kMostSteps, kMostChanges / kMostSteps));
  for (std::size_t i = 0; i < kMostAside; ++i) many.set_aside.add(longAlignment(i, 1, 100, 1));
  EXPECT_EQ(few.set_aside.alignments().at(0).changes(), kMostChanges);
  for (const State* state : {&few, &many}) {
    const auto read = parseState(stateText(*state), "f");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(stateText(*read), stateText(*state));
  }
}

std::string errorOf(const std::string& text) {
  const auto read = parseState(text, "f");
  return read ? "none" : read.error().what;
}

TEST(StateText, WrongFiguresAreNamedWithTheirPlace) {
  const auto with = [](const std::string& alignment) {
    return R"({"merlin_state": 1, "alignment": )" + alignment + "}";
  };
  EXPECT_NE(errorOf("[]").find("f: /merlin_state"), std::string::npos) << errorOf("[]");
  EXPECT_NE(errorOf(R"({"merlin_state": 1, "rate_hz": 1e9})").find("/rate_hz: found"),
            std::string::npos);
  EXPECT_NE(errorOf(with(R"({"outputs": [], "steps": [], "done": 1})")).find("/alignment/done"),
            std::string::npos);
  EXPECT_NE(
      errorOf(with(R"({"outputs": [], "steps": [{"output": "a", "changes": []}], "done": 0})"))
          .find("allowed: one of the outputs above"),
      std::string::npos);
  EXPECT_NE(errorOf(with(R"({"outputs": [{"output": "a", "size": [9, 9], "mesh": [2, 2], "moved":
                            [{"place": [2, 0], "by": [1, 1]}]}], "steps": [], "done": 0})"))
                .find("allowed: a point of the mesh"),
            std::string::npos);
  EXPECT_NE(errorOf(R"({"merlin_state": 2, "playlist": "next"})").find("allowed: on or off"),
            std::string::npos);
  EXPECT_NE(errorOf(R"({"merlin_state": 2, "projectors": {"switched": "off", "local_minute": -1}})")
                .find("/projectors/local_minute"),
            std::string::npos);
  EXPECT_NE(errorOf(R"({"merlin_state": 3, "alignment": {"outputs": [], "steps": [], "done": 0},
                        "set_aside": [{"outputs": [], "steps": [], "done": 0}]})")
                .find("allowed: the alignment of one output"),
            std::string::npos);
  const auto newer = parseState(R"({"merlin_state": 4, "anything": [1]})", "f");
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().code, Errc::kUnsupported);
}

}  // namespace
}  // namespace merlin::state
