// The pixels of the operator's panel: their place, when they are drawn anew, and that none remains
// after the panel is erased.
#include "render/panel/panel_overlay.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace merlin::render::panel {
namespace {

using C = ControlId;

class FakeSource final : public PanelSource {
 public:
  const PanelView& view() override { return shown; }
  PanelView shown;
};

tiles::TilePlan planOf(int width, int height) {
  tiles::TilesSettings settings;
  settings.tile_width = width, settings.tile_height = height;
  settings.frame_width = 2 * width, settings.frame_height = height;
  settings.tiles = {{"centre", tiles::TileKind::kWall, 0, 0, 0},
                    {"operator", tiles::TileKind::kOperator, width, 0, 0}};
  return *tiles::planTiles(settings);
}

// A frame of noise, and a panel that is drawn on it.
struct Wall {
  explicit Wall(int width = 640, int height = 480) : plan(planOf(width, height)) {
    options.contents = {{"scan", true}, {"map", false}};
    options.projectors = options.lamp = options.video = true;
    place = placePanel(plan, options);
    source.shown.facts.content = "scan";
    source.shown.facts.rate_hz = 30;
    overlay = *PanelOverlay::make(plan, *place, options, source);
    canvas.resize(static_cast<std::size_t>(4 * plan.frame_width * plan.frame_height));
    for (std::size_t i = 0; i < canvas.size(); ++i)
      canvas[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 2654435761U >> 7);
    before = canvas;
  }
  const std::uint8_t* pixel(const std::vector<std::uint8_t>& of, int x, int y) const {
    return &of[static_cast<std::size_t>(4 * (y * plan.frame_width + x))];
  }
  // Returns the numbers of pixels inside and outside the panel's place that differ from the
  // picture.
  std::pair<int, int> changed() const {
    const Rect at = place->inFrame();
    std::pair<int, int> counts;
    for (int y = 0; y < plan.frame_height; ++y) {
      for (int x = 0; x < plan.frame_width; ++x) {
        const bool differs =
            !std::equal(pixel(canvas, x, y), pixel(canvas, x, y) + 4, pixel(before, x, y));
        const bool inside = x >= at.x && y >= at.y && x < at.x + at.width && y < at.y + at.height;
        (inside ? counts.first : counts.second) += differs ? 1 : 0;
      }
    }
    return counts;
  }
  // Draws the panel with this view; returns the panel's pixels.
  std::vector<std::uint8_t> drawn() {
    overlay->draw(canvas);
    auto pixels = canvas;
    overlay->erase(canvas);
    return pixels;
  }

  tiles::TilePlan plan;
  PanelOptions options;
  std::optional<PanelPlace> place;
  FakeSource source;
  std::unique_ptr<PanelOverlay> overlay;
  std::vector<std::uint8_t> canvas, before;
};

TEST(PanelOverlay, DrawsOnItsPlaceAloneAndErasesEachByte) {
  for (const auto& [width, height] : {std::pair{320, 240}, {640, 480}, {1920, 1080}}) {
    Wall wall(width, height);
    wall.overlay->draw(wall.canvas);
    const auto [inside, outside] = wall.changed();
    const Rect at = wall.place->inFrame();
    EXPECT_GT(inside, at.width * at.height * 9 / 10);
    EXPECT_EQ(outside, 0);
    wall.overlay->erase(wall.canvas);
    EXPECT_EQ(wall.canvas, wall.before);
  }
}

TEST(PanelOverlay, IsDrawnAnewOnlyIfItsViewIsAnotherOne) {
  Wall wall;
  EXPECT_TRUE(wall.overlay->hasChanged());
  const auto first = wall.drawn();
  EXPECT_FALSE(wall.overlay->hasChanged());
  EXPECT_EQ(wall.drawn(), first);
  wall.source.shown.facts.rate_hz = 60;
  EXPECT_TRUE(wall.overlay->hasChanged());
  EXPECT_NE(wall.drawn(), first);
  wall.source.shown.facts.rate_hz = 30;
  EXPECT_EQ(wall.drawn(), first) << "the same view gives the same bytes";
}

// Each state that an operator has to see changes the pixels of its control and no others.
TEST(PanelOverlay, ShowsWhatIsHoveredPressedSelectedAndSwitchedOn) {
  using Change = void (*)(PanelView&);
  const std::pair<C, Change> changes[] = {
      {C::kBlank, [](PanelView& v) { v.hovered = C::kBlank; }},
      {C::kBlank, [](PanelView& v) { v.pressed = C::kBlank; }},
      {C::kBlank, [](PanelView& v) { v.facts.blank = true; }},
      {C::kFreeze, [](PanelView& v) { v.facts.frozen = true; }},
      {C::kLampSlow, [](PanelView& v) { v.facts.lamp = 1; }},
      {C::kProjectorsOff, [](PanelView& v) { v.facts.projectors_wanted = false; }},
      {C::kMode, [](PanelView& v) { v.facts.flies = true; }},
      {C::kUp, [](PanelView& v) { v.selected = C::kUp; }},
  };
  for (const auto& [id, change] : changes) {
    Wall wall;
    const auto plain = wall.drawn();
    change(wall.source.shown);
    const auto other = wall.drawn();
    const Rect panel = wall.place->inFrame(), r = wall.place->layout.find(id)->at;
    const int edge = 3;  // the selected control has a frame of this width
    int inside = 0, outside = 0;
    for (int y = panel.y; y < panel.y + panel.height; ++y) {
      for (int x = panel.x; x < panel.x + panel.width; ++x) {
        const bool differs = !std::equal(wall.pixel(plain, x, y), wall.pixel(plain, x, y) + 4,
                                         wall.pixel(other, x, y));
        const int in_x = x - panel.x - r.x, in_y = y - panel.y - r.y;
        const bool in =
            in_x >= -edge && in_y >= -edge && in_x < r.width + edge && in_y < r.height + edge;
        (in ? inside : outside) += differs ? 1 : 0;
      }
    }
    EXPECT_GT(inside, 20) << static_cast<int>(id);
    EXPECT_EQ(outside, 0) << static_cast<int>(id);
  }
}

TEST(PanelOverlay, AnyTextStaysOnThePanel) {
  Wall wall;
  PanelFacts& f = wall.source.shown.facts;
  const std::string hostile = "\xFF\xC0\xE2\x82\x1B[31m" + std::string(5000, 'W');
  f.content = f.slide = f.detail_unit = f.projectors = f.notice = hostile;
  f.rate_hz = 1e300, f.detail = f.full_detail = 4'294'967'295U;
  f.lamp = f.video = 4'294'967'295U;
  wall.overlay->draw(wall.canvas);
  EXPECT_EQ(wall.changed().second, 0);
  wall.overlay->erase(wall.canvas);
  EXPECT_EQ(wall.canvas, wall.before);
}

TEST(PanelOverlay, ItsPlaceIsTheFirstOperatorsTileWithRoom) {
  tiles::TilesSettings settings;
  settings.frame_width = 1280, settings.frame_height = 960;
  settings.tiles = {{"small", tiles::TileKind::kOperator, 0, 0, 0, 200, 200},
                    {"large", tiles::TileKind::kOperator, 640, 480, 1}};
  const auto place = placePanel(*tiles::planTiles(settings), {});
  ASSERT_TRUE(place);
  EXPECT_EQ(place->tile, (Rect{640, 480, 640, 480}));
  settings.tiles.pop_back();
  EXPECT_FALSE(placePanel(*tiles::planTiles(settings), {}));
}

}  // namespace
}  // namespace merlin::render::panel
