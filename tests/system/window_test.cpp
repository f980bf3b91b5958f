// Outputs of kind window at a real X server: what the window shows, what a person does there, and
// how the wall goes on when the display fails.
#include <filesystem>
#include <string>

#include <X11/keysym.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "render/image/image_file.h"
#include "render/panel/panel_overlay.h"
#include "tests/support/x_server.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr int kWidth = 320, kHeight = 240;  // of a tile; the frame has two by two

class WindowOutput : public testing::Test {
 protected:
  // Shows a wall with one window of 640 x 480 pixels at the screen's upper left corner.
  void show(const json& window = json::object(), const std::string& script = "still",
            std::map<std::string, std::string> environment = {}) {
    json settings = {{"x", 0}, {"y", 0}, {"title", "wall"}};
    settings.merge_patch(window);
    start(wallOf(settings), script, std::move(environment));
  }
  void start(const json& wall, const std::string& script,
             std::map<std::string, std::string> environment = {}) {
    MerlindOptions options;
    options.script = script;
    options.environment = {{"DISPLAY", x_.display()}, {"WAYLAND_DISPLAY", ""}};
    for (const auto& [name, value] : environment) options.environment[name] = value;
    options.also = {{"wall", wall}};
    wall_ = std::make_unique<Merlind>(dir_, model_, "window", options);
    ASSERT_TRUE(wall_->ready()) << wall_->process().output();
  }
  static json wallOf(const json& window) {
    return {
        {"tiles",
         {{"tile_width", kWidth},
          {"tile_height", kHeight},
          {"frame_width", 2 * kWidth},
          {"frame_height", 2 * kHeight},
          {"tiles",
           json::array(
               {{{"name", "left"}, {"turns", 1}},
                {{"name", "centre"}, {"x", kWidth}},
                {{"name", "right"}, {"y", kHeight}, {"turns", -1}},
                {{"name", "operator"}, {"kind", "operator"}, {"x", kWidth}, {"y", kHeight}}})}}},
        {"scene", {{"model_radius_m", 1.5}, {"model_distance_m", 2.05}}},
        {"outputs",
         json::array({{{"kind", "shared_memory"}}, {{"kind", "window"}, {"window", window}}})}};
  }

  json output(const std::string& name) { return wall_->status()["outputs"][name]; }
  bool isWell() {
    return eventually([&] { return output("window").value("health", "") == "ok"; });
  }
  // Waits until the window's upper left corner shows the frame's background. The output's health
  // alone is not enough, since it is "ok" before the window is open.
  bool isThere() {
    return eventually([&] {
      const Image screen = x_.screenshot();
      return screen.width > 0 && screen.at(1, 1) != Rgba{0, 0, 0, 255};
    });
  }
  // Waits until the output's health gives this reason for showing nothing.
  bool saysWhy(const std::string& why) {
    return eventually(
        [&] { return output("window").value("reason", "").find(why) != std::string::npos; });
  }
  // Returns whether the wall goes on drawing and its other output works.
  bool wallGoesOn() {
    const auto before = wall_->wall().frames;
    return eventually([&] { return wall_->wall().frames > before + 5; }) &&
           output("shared_memory").value("health", "") == "ok";
  }
  Image snapshot() {
    const std::string file = dir_ / "frame.png";
    EXPECT_EQ(run({kMerlin, "snapshot", "-o", file, "--instance", wall_->instance()}).status, 0);
    const auto read = render::image::readImage(file);
    EXPECT_TRUE(read) << read.error().what;
    Image image{2 * kWidth, 2 * kHeight, {}};
    for (std::size_t i = 0; read && i < read->pixels.size(); i += 3) {
      image.pixels.insert(image.pixels.end(),
                          {read->pixels[i], read->pixels[i + 1], read->pixels[i + 2], 255});
    }
    return image;
  }
  // Returns the part of the screen at (x, y) with the size of the frame.
  Image shownAt(int x, int y) const {
    const Image screen = x_.screenshot();
    Image part{2 * kWidth, 2 * kHeight, {}};
    if (screen.width == 0) return part;
    for (int row = 0; row < part.height; ++row) {
      const auto from = screen.pixels.begin() + 4 * ((y + row) * screen.width + x);
      part.pixels.insert(part.pixels.end(), from, from + 4 * part.width);
    }
    return part;
  }
  bool showsTheFrameAt(int x, int y) {
    return eventually([&] {
      const Image part = shownAt(x, y);
      return !part.pixels.empty() && part.pixels == snapshot().pixels;
    });
  }

  TempDir dir_;
  std::string model_ = makeModel(dir_, 2);
  XServer x_;
  std::unique_ptr<Merlind> wall_;
};

TEST_F(WindowOutput, ItsPixelsAreTheFramesOwn) {
  show({{"x", 100}, {"y", 50}});
  EXPECT_TRUE(isWell()) << output("window");
  EXPECT_TRUE(showsTheFrameAt(100, 50));
  const Image frame = snapshot();
  EXPECT_GT(frame.covered(frame.at(0, 0)), 5000) << "the model covers a part of it";
  EXPECT_EQ(x_.screenshot().at(99, 50), (Rgba{0, 0, 0, 255})) << "beside the window";
}

TEST_F(WindowOutput, AnotherSizeIsFilledAsFarAsTheProportionsAllow) {
  show({{"width", 300}, {"height", 300}});
  ASSERT_TRUE(isWell());
  const Image frame = snapshot();
  const Rgba background = frame.at(0, 0), black{0, 0, 0, 255};
  ASSERT_NE(background, black);
  ASSERT_TRUE(eventually([&] { return x_.screenshot().at(1, 150) == background; }));
  const Image screen = x_.screenshot();
  for (const int x : {0, 299}) {
    EXPECT_EQ(screen.at(x, 36), black);
    EXPECT_EQ(screen.at(x, 263), black);
    EXPECT_EQ(screen.at(x, 38), background);
    EXPECT_EQ(screen.at(x, 261), background);
  }
}

TEST_F(WindowOutput, FullscreenCoversItsMonitor) {
  show({{"fullscreen", true}, {"x", -1}, {"y", -1}, {"scale", "none"}});
  ASSERT_TRUE(isWell());
  EXPECT_TRUE(showsTheFrameAt((1600 - 2 * kWidth) / 2, (1200 - 2 * kHeight) / 2));
}

TEST_F(WindowOutput, TheWallGoesOnWithoutItsXServerAndTheWindowComesBackWithIt) {
  show(json::object(), "turning");
  ASSERT_TRUE(isThere()) << output("window");
  x_.process().kill(SIGKILL);
  EXPECT_TRUE(saysWhy("no display can be reached (DISPLAY is " + x_.display())) << output("window");
  EXPECT_EQ(output("window").value("health", ""), "failed");
  EXPECT_TRUE(wallGoesOn());
  x_.start();
  EXPECT_TRUE(isWell()) << output("window");
  EXPECT_TRUE(isThere());
}

// The output's health is reported although no frame is drawn. When the display is back, the window
// shows the last frame.
TEST_F(WindowOutput, AWallAtRestTellsAsWell) {
  show();
  ASSERT_TRUE(isThere());
  ASSERT_TRUE(showsTheFrameAt(0, 0));
  x_.process().kill(SIGKILL);
  EXPECT_TRUE(saysWhy("no display can be reached"));
  x_.start();
  EXPECT_TRUE(isWell());
  EXPECT_TRUE(showsTheFrameAt(0, 0));
}

TEST_F(WindowOutput, AnXServerThatDoesNotAnswerHoldsNothingUp) {
  show(json::object(), "turning");
  ASSERT_TRUE(isThere());
  ::kill(x_.process().pid(), SIGSTOP);
  EXPECT_TRUE(saysWhy("the display does not answer")) << output("window");
  EXPECT_TRUE(wallGoesOn());
  ::kill(x_.process().pid(), SIGCONT);
  EXPECT_TRUE(isWell());
  ::kill(x_.process().pid(), SIGSTOP);
  EXPECT_TRUE(saysWhy("the display does not answer"));
  EXPECT_EQ(wall_->process().kill(SIGTERM), 0) << wall_->process().output();
  ::kill(x_.process().pid(), SIGCONT);
}

TEST_F(WindowOutput, SaysThatThereIsNoDisplay) {
  show(json::object(), "turning", {{"DISPLAY", ":7654"}});
  EXPECT_TRUE(saysWhy("no display can be reached (DISPLAY is :7654)")) << output("window");
  EXPECT_TRUE(wallGoesOn());
  wall_.reset();
  show(json::object(), "turning", {{"DISPLAY", ""}});
  EXPECT_TRUE(saysWhy("neither DISPLAY nor WAYLAND_DISPLAY is set")) << output("window");
  EXPECT_TRUE(wallGoesOn());
  wall_.reset();
  show({{"monitor", 3}}, "turning");
  EXPECT_TRUE(saysWhy("there is no monitor 3: the display has 1, counted from 0"));
}

TEST_F(WindowOutput, ClosingItIsAMatterOfThisOutputOnly) {
  show(json::object(), "turning");
  ASSERT_TRUE(isThere());
  x_.close("wall");
  EXPECT_TRUE(saysWhy("a person closed the window")) << output("window");
  EXPECT_TRUE(wallGoesOn());
  EXPECT_TRUE(eventually([&] { return !x_.hasWindow("wall"); }));
  EXPECT_EQ(wall_->process().kill(SIGTERM), 0);
}

TEST_F(WindowOutput, ClosingItEndsMerlindWhereItIsSetSo) {
  show({{"on_close", "stop"}});
  ASSERT_TRUE(isThere());
  x_.close("wall");
  EXPECT_EQ(wall_->process().wait(), 0);
  EXPECT_TRUE(wall_->process().saysEventually("the window \"wall\" was closed"));
  EXPECT_TRUE(wall_->leftInSharedMemory().empty());
}

TEST_F(WindowOutput, ItsProgramIsStartedAgainAndEndsWithMerlind) {
  show();
  ASSERT_TRUE(isThere());
  const auto first = wall_->children("merlin-window");
  ASSERT_EQ(first.size(), 1u);
  ::kill(first[0], SIGKILL);
  EXPECT_TRUE(eventually([&] {
    const auto now = wall_->children("merlin-window");
    return now.size() == 1 && now != first;
  }));
  EXPECT_TRUE(isWell());
  EXPECT_TRUE(showsTheFrameAt(0, 0));
  wall_->process().kill(SIGKILL);
  EXPECT_TRUE(eventually([&] { return !x_.hasWindow("wall"); }));
}

TEST_F(WindowOutput, KeysAreCommandsUnlessTheyAreOff) {
  show();
  ASSERT_TRUE(isThere());
  const auto mode = [&] { return wall_->status().value("mode", ""); };
  const std::string before = mode();
  x_.key("wall", XK_m);
  EXPECT_TRUE(eventually([&] { return mode() != before; })) << wall_->status();
  wall_.reset();
  show({{"input", false}});
  ASSERT_TRUE(isThere());
  x_.key("wall", XK_m);
  x_.close("wall");  // the key takes effect before the next event is handled
  ASSERT_TRUE(saysWhy("a person closed"));
  EXPECT_EQ(mode(), before);
}

TEST_F(WindowOutput, DraggingTurnsTheModel) {
  if (!findCommand("move")) GTEST_SKIP() << "this merlind has no command move";
  show();
  ASSERT_TRUE(isThere());
  ASSERT_TRUE(showsTheFrameAt(0, 0));
  const Image before = snapshot();
  x_.drag(1, {100, 100}, {200, 0});
  EXPECT_TRUE(eventually([&] { return differing(before, snapshot(), 8) > 3000; }));
  EXPECT_TRUE(showsTheFrameAt(0, 0));
}

// Uses the default wall, whose operator's tile is the lower right quarter of the frame.
TEST_F(WindowOutput, TheMouseWorksTheOperatorsPanel) {
  start(
      {{"operator", {{"panel", true}}},
       {"outputs",
        json::array({{{"kind", "shared_memory"}},
                     {{"kind", "window"}, {"window", {{"x", 0}, {"y", 0}, {"title", "wall"}}}}})}},
      "still");
  ASSERT_TRUE(isThere());
  const auto panel = render::panel::layOutPanel(640, 480, 13, {});
  const auto asked = [&] { return wall_->wall().rate_asked_hz; };
  const auto click = [&](render::panel::ControlId id) {
    const render::text::Rect r = panel->find(id)->at;
    x_.drag(1, {640 + panel->at.x + r.x + r.width / 2, 480 + panel->at.y + r.y + r.height / 2}, {});
  };
  const double before = asked();
  // merlind releases a press that it has not received for 1.5 s without a click, so a busy machine
  // may need two presses.
  for (int tries = 0; tries < 3 && asked() == before; ++tries) {
    click(render::panel::ControlId::kRateLess);
    (void)eventually([&] { return asked() < before; }, std::chrono::seconds(10));
  }
  EXPECT_LT(asked(), before);
  EXPECT_EQ(wall_->wall().moving, 0) << "the model is not dragged";
}

// As in a build without SDL2, the window program is not in merlind's folder.
TEST_F(WindowOutput, TheCheckOfAConfigurationSaysThatItIsNotBuilt) {
  std::filesystem::copy_file(kMerlind, dir_ / "merlind");
  const std::string config = dir_ / "wall.json";
  json wall = wallOf({{"x", 0}});
  wall["model"] = model_;
  writeText(config, json({{"wall", wall}}).dump(1));
  EXPECT_EQ(run({kMerlind, "--check-config", config}).status, 0);
  const Outcome refused = run({dir_ / "merlind", "--check-config", config});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("/wall/outputs/1/kind cannot be window: this build has no window "
                                "output"),
            std::string::npos)
      << refused.output;
  EXPECT_NE(refused.output.find("libsdl2-dev"), std::string::npos) << refused.output;
}

}  // namespace
}  // namespace merlin::test
