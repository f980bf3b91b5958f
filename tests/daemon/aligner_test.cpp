// Aligner: which corrections it builds, what it refuses, and what it keeps over a restart.
#include "daemon/wall/aligner.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.h"

namespace merlin::wall {
namespace {

using nlohmann::json;

// A correction that keeps the settings from which it was built, so that a test can read them.
struct FakeCorrection final : render::frame::Correction {
  explicit FakeCorrection(const render::correct::CorrectionSettings& s) : settings(s) {}
  render::out::Signal apply(const render::out::Signal&) override {
    return {static_cast<int>(settings.corners[0]), static_cast<int>(settings.corners[1]), {}};
  }
  render::correct::CorrectionSettings settings;
};

class AlignerTest : public testing::Test {
 protected:
  AlignerTest() {
    base_.corners = {4, 8, 0, 0, 0, 0, 0, 0};
    start();
  }
  // Restarts the aligner with the state that the previous one kept.
  void start() {
    aligner_.reset();
    std::vector<AlignedOutput> outputs;
    outputs.push_back(output("left", width_, base_, left_));
    outputs.push_back(output("right", 640, meshed(), right_));
    aligner_ = std::make_unique<Aligner>(
        std::move(outputs), std::vector<std::string>{"shared_memory"}, cards_, keeper_, watch_);
  }
  AlignedOutput output(const std::string& name, int width,
                       const render::correct::CorrectionSettings& base,
                       std::unique_ptr<render::frame::ReplaceableCorrection>& correction) {
    correction = std::make_unique<render::frame::ReplaceableCorrection>();
    const auto make = [this](const render::correct::CorrectionSettings& s) {
      {
        const std::lock_guard lock(mutex_);
        built_.push_back(s);
      }
      return std::unique_ptr<render::frame::Correction>(std::make_unique<FakeCorrection>(s));
    };
    AlignedOutput made{name, width, 480, base, make, correction.get()};
    made.fixed = fixed_;
    made.axes = axes_;
    return made;
  }
  static render::correct::CorrectionSettings meshed() {
    render::correct::CorrectionSettings s;
    s.mesh = {2, 2, {{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
    return s;
  }
  json ask(const std::string& argument) {
    const auto answer = aligner_->run(argument);
    if (!answer) return answer.error().what;
    return json::parse(*answer);
  }
  json moved(const std::string& corner, std::size_t output = 0) {
    return ask("list")["outputs"][output]["corners"][corner]["moved"];
  }
  // Returns the present place of the first corner of the left output, once no correction is
  // pending.
  std::pair<int, int> shown() {
    EXPECT_TRUE(test::eventually([&] { return ask("list")["outputs"][0]["pending"] == false; }));
    const render::out::Signal signal = left_->apply({});
    return {signal.width, signal.height};
  }

  ThreadWatch watch_;
  state::StateKeeper keeper_{nullptr, watch_};
  render::testcard::CardOverlay cards_{8, 8, {{"left", 0, 0, 8, 8}}};
  int width_ = 640;
  render::correct::CorrectionSettings base_;
  std::mutex mutex_;
  std::vector<render::correct::CorrectionSettings> built_;
  std::unique_ptr<render::frame::ReplaceableCorrection> left_, right_;
  std::string fixed_;
  state::SeenAxes axes_;
  std::unique_ptr<Aligner> aligner_;
};

TEST_F(AlignerTest, ShowsTheConfigurationAtFirst) {
  EXPECT_EQ(shown(), std::pair(4, 8));
  EXPECT_FALSE(left_->hasChanged());
  const json list = ask("list");
  EXPECT_EQ(list["outputs"][0]["corners"]["top_left"]["configured"], json({4, 8}));
  EXPECT_EQ(list["undo"], 0);
}

TEST_F(AlignerTest, AMoveIsShownAndKept) {
  ask("move top_left 3 -2.5 left");
  EXPECT_EQ(shown(), std::pair(7, 5));
  EXPECT_EQ(moved("top_left"), json({3, -2.5}));
  EXPECT_EQ(keeper_.state().alignment.offset("left", state::cornerAt(0)), (state::Offset{3, -2.5}));
  start();
  EXPECT_EQ(shown(), std::pair(7, 5));
  ask("undo");
  EXPECT_EQ(shown(), std::pair(4, 8)) << "also steps of before the restart";
  EXPECT_EQ(ask("redo")["done"], "left top_left by 3, -2.5");
  ask("reset left");
  EXPECT_EQ(shown(), std::pair(4, 8));
}

TEST_F(AlignerTest, APointOfTheMeshMovesInSharesOfTheOutput) {
  ask("point 1 0 -64 48 right");
  ASSERT_TRUE(test::eventually([&] { return ask("list")["outputs"][1]["pending"] == false; }));
  const std::lock_guard lock(mutex_);
  EXPECT_EQ(built_.back().mesh.points[1], (render::correct::MeshPoint{0.9, 0.1}));
  EXPECT_EQ(built_.back().mesh.points[0], (render::correct::MeshPoint{0, 0}));
}

TEST_F(AlignerTest, SaysWhetherATestCardIsShown) {
  EXPECT_FALSE(aligner_->showsCard());
  EXPECT_TRUE(aligner_->showCard("grid"));
  EXPECT_TRUE(aligner_->showsCard());
  EXPECT_FALSE(aligner_->showCard("purple"));
  EXPECT_TRUE(aligner_->showsCard()) << "as before";
  EXPECT_TRUE(aligner_->showCard("off"));
  EXPECT_FALSE(aligner_->showsCard());
}

TEST_F(AlignerTest, WhatIsOffIsNoCorrectionAtAll) {
  base_ = {};
  start();
  const std::uint8_t pixel[4] = {};
  EXPECT_EQ(left_->apply({1, 1, pixel}).pixels.data(), pixel);
}

TEST_F(AlignerTest, WhatCannotBeShownIsRefusedAndNothingChanges) {
  const std::pair<const char*, const char*> refused[] = {
      {"move top_left 400 300 left",
       "top_left of output left stays where it is: corners do not form a convex picture"},
      {"move top_left -330 0 left", "corner top_left would be at (-326, 8), more than half"},
      {"move bottom_right 0 300 left",
       "corner bottom_right would be at (640, 780), more than half"},
      {"point 1 0 -900 0 right", "point 1 0 of output right stays where it is: mesh"},
      {"point 2 0 1 0 right", "has no point 2 0: its mesh has 2 columns and 2 rows"},
      {"point 0 0 1 0 left", "output left has no mesh"},
      {"move top_left 1 1 top",
       "there is no output \"top\"; those that can be aligned are left, "
       "right"},
      {"move top_left 1 1 shared_memory", "of kind shared_memory, which holds the frame"},
      {"reset x", "there is no output \"x\""},
      {"undo", "there is nothing to undo"},
      {"redo", "there is nothing to redo"},
      {"move top_left 1 left",
       "is not a valid request; allowed are: list | move CORNER DX DY OUTPUT"},
      {"move upper_left 1 1 left", "CORNER is top_left, top_right, bottom_left, bottom_right"},
      {"move top_left nan 1 left", "is not a valid request"},
      {"move top_left 1e9 1 left", "is not a valid request"},
      {"", "is not a valid request"}};
  for (const auto& [argument, what] : refused) {
    const json answer = ask(argument);
    ASSERT_TRUE(answer.is_string()) << argument << answer;
    EXPECT_NE(answer.get<std::string>().find(what), std::string::npos) << argument << answer;
  }
  EXPECT_EQ(ask("list")["undo"], 0);
  EXPECT_EQ(shown(), std::pair(4, 8));
}

TEST_F(AlignerTest, BoundInputsMoveWhatIsChosen) {
  AlignInput input;
  input.actions = {3, 3, 5};  // right twice, then down
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_left") == json({2, 1}); }));
  input.actions = {0, 1, 1, 1, 2};  // next output, three corners further, then left
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("bottom_right", 1) == json({-1, 0}); }));
  EXPECT_EQ(aligner_->selection(), (Aligner::Selection{"right", state::cornerAt(3)}));
  ask("select top_left left");
  input.actions = {};
  input.push = {0.5, 0.25};
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_left") == json({2.5, 1.25}); }));
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_left") == json({3, 1.5}); }));
  ask("undo");
  EXPECT_EQ(moved("top_left"), json({2, 1})) << "a push is one step";
}

TEST_F(AlignerTest, BoundInputsAreExecutedInTheirOrder) {
  AlignInput input;
  input.actions = {3, 3, 1, 5, 5, 6};  // right twice, next corner, down twice, undo
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_right") == json({0, 1}); }));
  EXPECT_EQ(moved("top_left"), json({2, 0}));
}

// The aligned corners were written into the configuration, so the moves must not be added to them
// again.
TEST_F(AlignerTest, CornersThatTheConfigurationChangesAreTakenWithoutWhatWasMoved) {
  ask("move top_left 3 2 left");
  start();
  EXPECT_EQ(moved("top_left"), json({3, 2})) << "another start changes nothing";
  keeper_.takeNotices();
  base_.corners[0] += 3, base_.corners[1] += 2;
  start();
  EXPECT_EQ(moved("top_left"), json({0, 0}));
  EXPECT_NE(keeper_.takeNotices().at(0).find("alignment of output left is set aside: its corners"),
            std::string::npos);
}

TEST_F(AlignerTest, AnOutputWithBothEyesPicturesIsNotMoved) {
  ask("move top_left 3 2 left");
  keeper_.takeNotices();
  fixed_ = "it shows a picture of each eye";
  start();
  EXPECT_EQ(moved("top_left"), json({0, 0})) << "what was moved before is set aside";
  EXPECT_NE(keeper_.takeNotices().at(0).find("is set aside: it shows a picture of each eye"),
            std::string::npos);
  const json answer = ask("move top_left 3 2 left");
  ASSERT_TRUE(answer.is_string()) << answer;
  EXPECT_NE(answer.get<std::string>().find("it shows a picture of each eye"), std::string::npos);
  start();
  EXPECT_TRUE(keeper_.takeNotices().empty()) << "said once";
  fixed_.clear();
  start();
  EXPECT_EQ(moved("top_left"), json({3, 2}));
}

// The projector hangs upside down: what is on the left for a person before the wall is on the right
// in its signal.
TEST_F(AlignerTest, BoundInputsMoveCornersAsTheyAreSeen) {
  axes_ = {{-1, 0}, {0, -1}};
  start();
  AlignInput input;
  input.actions = {3, 3, 5};  // right twice, then down
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_left") == json({-2, -1}); }));
  input.actions = {};
  input.push = {2.5, 0};
  aligner_->ask(input);
  EXPECT_TRUE(test::eventually([&] { return moved("top_left") == json({-4.5, -1}); }));
  EXPECT_EQ(ask("list")["outputs"][0]["seen"], (json{{"right", {-1, 0}}, {"down", {0, -1}}}));
}

TEST_F(AlignerTest, AnotherConfigurationIsShownAndKeepsWhatWasMoved) {
  ask("move top_left 3 1 left");
  EXPECT_EQ(shown(), std::pair(7, 9));
  auto other = base_;
  other.blend.right = 80;
  aligner_->configure("left", other);
  EXPECT_TRUE(test::eventually([&] {
    const std::lock_guard lock(mutex_);
    return built_.back().blend.right == 80;
  }));
  EXPECT_EQ(shown(), std::pair(7, 9));
  other.corners[0] = 5;  // the alignment was made for other configured corners
  aligner_->configure("left", other);
  EXPECT_EQ(moved("top_left"), json({0, 0}));
  EXPECT_EQ(shown(), std::pair(5, 8));
}

TEST_F(AlignerTest, ARefusedActionIsANoticeOnce) {
  AlignInput input;
  input.push = {-400, 0};
  for (int i = 0; i < 3; ++i) aligner_->ask(input);
  std::vector<std::string> notices;
  EXPECT_TRUE(test::eventually([&] {
    for (std::string& notice : keeper_.takeNotices()) {
      if (notice.starts_with("align: ")) notices.push_back(std::move(notice));
    }
    return !notices.empty();
  }));
  EXPECT_NE(notices[0].find("align: top_left of output left stays"), std::string::npos);
}

TEST_F(AlignerTest, AnAlignmentThatFitsNoLongerIsSetAsideWithANotice) {
  keeper_.takeNotices();
  ask("move top_left 300 200 left");
  ask("move top_left 1 1 right");
  base_.corners = {300, 250, 0, 0, 0, 0, 0, 0};
  start();
  EXPECT_EQ(shown(), std::pair(300, 250));
  auto notices = keeper_.takeNotices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_TRUE(
      notices[0].starts_with("the alignment of output left is set aside: its corners in the"))
      << notices[0];
  EXPECT_EQ(ask("list")["undo"], 1) << "that of the other output";
  ask("move top_left 1 1 left");
  width_ = 800;
  start();
  notices = keeper_.takeNotices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("it was made for 640 x 480 pixels"), std::string::npos);
  EXPECT_EQ(moved("top_left"), json({0, 0}));
  EXPECT_EQ(moved("top_left", 1), json({1, 1}));
}

TEST_F(AlignerTest, AnAlignmentComesBackWithItsStepsWhenTheOutputHasItsSizeAgain) {
  ask("move top_left 3 2 left");
  ask("move top_left 1 0 left");
  ask("undo");
  keeper_.takeNotices();
  width_ = 64;  // a wrong number in the configuration
  start();
  EXPECT_EQ(shown(), std::pair(4, 8));
  EXPECT_EQ(ask("list")["undo"], 0);
  EXPECT_EQ(keeper_.takeNotices(),
            std::vector<std::string>{
                "the alignment of output left is set aside: it was made for 640 x 480 pixels and a "
                "mesh of 0 x 0 points, but the output now has 64 x 480 pixels and a mesh of 0 x 0 "
                "points; it comes back, with its undo steps, when the output is again as it was "
                "then"});
  ask("move top_left 5 5 left");
  width_ = 640;
  start();
  EXPECT_EQ(shown(), std::pair(7, 10));
  const auto notices = keeper_.takeNotices();
  ASSERT_EQ(notices.size(), 2u) << "the other size's alignment is set aside in turn";
  EXPECT_EQ(notices[1],
            "the alignment of output left, which was set aside, is in effect again, since the "
            "output is as it was then");
  EXPECT_EQ(ask("redo")["done"], "left top_left by 1, 0");
  ask("undo");
  ask("undo");
  EXPECT_EQ(shown(), std::pair(4, 8));
  width_ = 64;
  start();
  EXPECT_EQ(moved("top_left"), json({5, 5}));
}

TEST_F(AlignerTest, AReloadThatTakesTheCornersBackBringsTheAlignmentBack) {
  ask("move top_left 3 1 left");
  auto other = base_;
  other.corners[0] = 5;
  aligner_->configure("left", other);
  EXPECT_EQ(moved("top_left"), json({0, 0}));
  EXPECT_EQ(keeper_.state().set_aside.alignments().size(), 1u);
  aligner_->configure("left", base_);
  EXPECT_EQ(moved("top_left"), json({3, 1}));
  EXPECT_TRUE(keeper_.state().set_aside.alignments().empty());
  EXPECT_EQ(keeper_.state().alignment.offset("left", state::cornerAt(0)), (state::Offset{3, 1}));
}

// The alignments of all outputs share one limit. When one is reset, the next that fits uses the
// free room.
TEST_F(AlignerTest, AnAlignmentThatComesBackToAnotherOutputThanTheConfiguredOneIsShown) {
  base_.mesh.columns = base_.mesh.rows = 64;
  for (int i = 0; i < 64 * 64; ++i) base_.mesh.points.push_back({i % 64 / 63.0, i / 64 / 63.0});
  state::Alignment left, right;
  for (int i = 0; i < static_cast<int>(state::kMostMoved); ++i) {
    left.move({"left", 640, 480, 64, 64, base_.corners}, {state::Place::Of::kMesh, i % 64, i / 64},
              {0.001, 0});
  }
  right.move({"right", 640, 480, 2, 2, meshed().corners}, state::cornerAt(0), {3, 1});
  keeper_.change([&](state::State& s) {
    s.alignment = left;
    s.set_aside.add(right);
  });
  start();
  EXPECT_EQ(moved("top_left", 1), json({0, 0})) << "no room";
  ask("reset left");
  auto other = base_;
  other.blend.right = 80;
  aligner_->configure("left", other);
  EXPECT_EQ(moved("top_left", 1), json({3, 1}));
  EXPECT_TRUE(test::eventually([&] { return right_->apply({}).width == 3; }));
}

}  // namespace
}  // namespace merlin::wall
