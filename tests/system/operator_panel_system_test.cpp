// The operator's panel with real programs: a VNC client's mouse, and an emulated ball.
#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "render/image/image_file.h"
#include "render/panel/panel_overlay.h"
#include "tests/support/vnc_client.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;
using render::panel::ControlId;

// The panel's layout on the default wall, whose operator's tile has 640 x 480 pixels.
const render::panel::PanelLayout& layout() {
  static const auto kLayout = *render::panel::layOutPanel(640, 480, 13, {});
  return kLayout;
}

class OperatorPanelSystem : public testing::Test {
 protected:
  void start(const std::string& script, json also = json::object()) {
    MerlindOptions options{.script = script};
    options.also = {{"wall", {{"operator", {{"panel", true}}}}}};
    options.also.merge_patch(also);
    wall_ = std::make_unique<Merlind>(dir_, makeModel(dir_, 5), "panel", options);
    ASSERT_TRUE(wall_->ready()) << wall_->process().output();
  }
  // Returns a VNC client that sees the operator's tile and may use it.
  VncClient& client() {
    if (client_) return *client_;
    rfb_ = std::make_unique<Process>(
        std::vector<std::string>{MERLIN_BIN_DIR "/merlin-rfb", "--instance", wall_->instance(),
                                 "--listen", "127.0.0.1:0", "--view", "operator", "--allow-input"});
    EXPECT_TRUE(rfb_->saysEventually("clients at most")) << rfb_->output();
    const std::string said = rfb_->output(), before = "at 127.0.0.1:";
    const std::size_t at = said.find(before);
    int port = 0;
    if (at != std::string::npos)
      std::from_chars(said.data() + at + before.size(), said.data() + said.size(), port);
    client_ = std::make_unique<VncClient>(port);
    EXPECT_TRUE(client_->isConnected() && client_->refresh());
    return *client_;
  }
  void point(int buttons, ControlId id) {
    const render::text::Rect panel = layout().at, r = layout().find(id)->at;
    client().pointer(buttons, panel.x + r.x + r.width / 2, panel.y + r.y + r.height / 2);
  }
  void click(ControlId id) {
    point(0, id);
    point(1, id);
    point(0, id);
  }
  using Condition = std::function<bool(const shm::WallStats&)>;
  // Clicks on the control until the condition holds. merlind releases a press that it has not
  // received for 1.5 s without a click, so a busy machine may need another click.
  bool clickMakes(ControlId id, const Condition& condition) {
    const auto holds = [&] { return condition(wall_->wall()); };
    for (int tries = 0; tries < 4; ++tries) {
      click(id);
      if (client().until(holds, std::chrono::seconds(30))) return true;
    }
    return false;
  }
  bool byBall() const {
    const auto opened =
        shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(wall_->instance(), "wall"));
    const auto panel = opened ? (*opened)->panel.read() : std::nullopt;
    return panel && panel->by_ball == 1;
  }
  // Returns the part of the operator's tile beside the panel, cut out of a picture of that tile or
  // of the whole frame.
  static Image model(const Image& of) {
    const int left = of.width - 640, top = of.height - 480;
    Image part{layout().at.x, 480, {}};
    for (int y = top; y < of.height; ++y) {
      const auto row = of.pixels.begin() + 4 * (static_cast<std::ptrdiff_t>(y) * of.width + left);
      part.pixels.insert(part.pixels.end(), row, row + 4 * part.width);
    }
    return part;
  }
  // Returns the part of the operator's tile beside the panel, from the picture of `merlin
  // snapshot`.
  Image snapshot() {
    const std::string file = dir_ / "s.png";
    EXPECT_EQ(run({kMerlin, "snapshot", "--instance", wall_->instance(), "-o", file}).status, 0);
    const auto read = render::image::readImage(file);
    EXPECT_TRUE(read) << read.error().what;
    Image image{read->width, read->height, {}};
    for (std::size_t i = 0; i < read->pixels.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c) image.pixels.push_back(read->pixels[i + c]);
      image.pixels.push_back(255);
    }
    return model(image);
  }
  bool isStill() {
    return eventually([&] { return wall_->wall().full_detail == 1; });
  }

  TempDir dir_;
  std::unique_ptr<Merlind> wall_;
  std::unique_ptr<Process> rfb_;
  std::unique_ptr<VncClient> client_;
};

TEST_F(OperatorPanelSystem, AVncClientsMouseWorksItAndMovesNothingElse) {
  start("still");
  ASSERT_TRUE(isStill());
  const Image before = snapshot();
  const auto stands = [&] { return differing(model(client().picture()), before, 0) == 0; };
  ASSERT_TRUE(client().until(stands));
  EXPECT_TRUE(clickMakes(ControlId::kRateLess, [](const auto& w) { return w.rate_asked_hz == 5; }));
  EXPECT_TRUE(
      clickMakes(ControlId::kRateAuto, [](const auto& w) { return w.rate_asked_hz == 10; }));
  EXPECT_TRUE(clickMakes(ControlId::kDetailLess, [](const auto& w) { return w.held_cost > 0; }));
  EXPECT_TRUE(clickMakes(ControlId::kDetailAuto, [](const auto& w) { return w.held_cost == 0; }));
  EXPECT_TRUE(
      clickMakes(ControlId::kMode, [](const auto& w) { return std::string(w.mode) == "fly"; }));
  EXPECT_TRUE(
      clickMakes(ControlId::kMode, [](const auto& w) { return std::string(w.mode) == "object"; }));

  // The model must not have moved: no pixel beside the panel has changed.
  ASSERT_TRUE(isStill());
  EXPECT_TRUE(client().until(stands));

  // An arrow that is held turns the model, which stops when the arrow is released.
  point(1, ControlId::kLeft);
  EXPECT_TRUE(
      client().until([&] { return differing(model(client().picture()), before, 8) > 1000; }));
  point(0, ControlId::kLeft);
  EXPECT_TRUE(isStill());
  for (int tries = 0; tries < 3 && !stands(); ++tries) {
    click(ControlId::kReset);
    client().until(stands, std::chrono::seconds(30));
  }
  EXPECT_TRUE(stands());
}

TEST_F(OperatorPanelSystem, AClientThatDiesWithAnArrowHeldLetsGo) {
  start("still");
  ASSERT_TRUE(isStill());
  point(0, ControlId::kLeft);
  point(1, ControlId::kLeft);
  ASSERT_TRUE(client().until([&] { return wall_->wall().moving == 1; }));
  rfb_->kill(SIGKILL);
  EXPECT_TRUE(isStill());
}

// The emulated visitor enters the panel with button 3, selects the arrow down, holds it with button
// 1, and leaves with button 3. Between entering and leaving, only the arrow moves the model.
TEST_F(OperatorPanelSystem, TheBallEntersWorksItAndLeaves) {
  start("panel", {{"bindings",
                   json::array({json{{"input", "ball.button.3"}, {"action", "operator_panel"}}})}});
  // The visitor repeats these actions every eight seconds; a busy machine may miss a button.
  constexpr std::chrono::minutes kPatience(2);
  EXPECT_TRUE(eventually([&] { return byBall() && wall_->wall().moving == 0; }, kPatience));
  EXPECT_TRUE(eventually([&] { return byBall() && wall_->wall().moving == 1; }, kPatience));
  EXPECT_TRUE(eventually([&] { return !byBall(); }, kPatience));
}

TEST(OperatorPanelCommands, AreRefusedWithoutAPanel) {
  const TempDir dir;
  Merlind wall(dir, makeModel(dir, 2), "none", {.script = "still"});
  ASSERT_TRUE(wall.ready());
  const Outcome asked = run({kMerlin, "operator_panel", "--instance", wall.instance()});
  EXPECT_EQ(asked.status, 2) << asked.output;
  EXPECT_NE(asked.output.find("/wall/operator/panel is off"), std::string::npos) << asked.output;
}

}  // namespace
}  // namespace merlin::test
