// The wall's frame, drawn by Mesa: tiles continue each other, whatever was drawn before.
#include "render/frame/frame_renderer.h"

#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"
#include "tests/support/model_frames.h"
#include "tests/support/pictures.h"

namespace merlin::render {
namespace {

using test::Image;

constexpr int kTileWidth = 160, kTileHeight = 120;

const render::lod::Dendrogram& model() {
  static const render::lod::Dendrogram made = [] {
    render::mesh::Mesh mesh = test::noisyGrid(60, 20, 0.3, 5);
    render::mesh::ensureNormals(mesh);
    return render::lod::buildDendrogram(mesh, render::reduce::reduce(mesh, {})->log);
  }();
  return made;
}

// Returns the pose of a model that is so close to the eye and so wide that it fills all three
// tiles.
Eigen::Isometry3f inFront() {
  Eigen::Isometry3f T_eye_model(Eigen::Translation3f(0.1F, 0.05F, -1.2F));
  T_eye_model.rotate(Eigen::AngleAxisf(0.2F, Eigen::Vector3f::UnitY()));
  return T_eye_model;
}

tiles::TilesSettings fourTiles() {
  tiles::TilesSettings s;
  s.tile_width = kTileWidth;
  s.tile_height = kTileHeight;
  s.frame_width = 2 * kTileWidth;
  s.frame_height = 2 * kTileHeight;
  for (render::tiles::TileSettings& t : s.tiles) {
    t.x /= 4;
    t.y /= 4;
  }
  return s;
}

struct Wall {
  explicit Wall(const tiles::TilesSettings& settings, gl::GlBackend backend = gl::GlBackend::kEgl,
                int contexts = 0, const lod::Dendrogram& shown = model())
      : Wall(settings, {.backend = backend, .contexts = contexts}, shown) {}
  Wall(const tiles::TilesSettings& settings, const gl::GlSettings& gl,
       const lod::Dendrogram& shown = model())
      : plan(*render::tiles::planTiles(settings)),
        renderer(*test::rendererOf(shown, plan, {.gl = gl, .model = {}}, 2.0, clock)) {}

  Image tile(std::size_t index) const {
    const render::tiles::Tile& t = plan.tiles[index];
    Image image{t.width, t.height, {}};
    for (int y = t.y; y < t.y + t.height; ++y) {
      const auto from = renderer->pixels().begin() + 4 * (y * plan.frame_width + t.x);
      image.pixels.insert(image.pixels.end(), from, from + 4 * t.width);
    }
    return image;
  }
  void draw(std::size_t level = 0) { renderer->draw({.T_eye_content = inFront(), .step = level}); }

  SystemClock clock;
  render::tiles::TilePlan plan;
  std::unique_ptr<frame::FrameRenderer> renderer;
};

TEST(FrameRenderer, MiddleTileAloneIsTheSamePixels) {
  Wall wall(fourTiles());
  wall.draw();
  tiles::TilesSettings alone = fourTiles();
  alone.frame_width = kTileWidth;
  alone.frame_height = kTileHeight;
  alone.tiles = {{"centre", tiles::TileKind::kWall, 0, 0, 0}};
  Wall one(alone);
  one.draw();
  EXPECT_EQ(one.tile(0).pixels, wall.tile(1).pixels);
  EXPECT_NE(wall.tile(0).pixels, wall.tile(1).pixels);
}

// At half size, a tile shows the same image in blocks of 2 x 2 pixels; refined detail is drawn at
// full size.
TEST(FrameRenderer, HalfTheSizeIsEnlargedAndGoesWhenItIsRefined) {
  Wall wall(fourTiles());
  wall.draw();
  const Image full = wall.tile(1);
  wall.renderer->setSizeDivisor(2);
  wall.draw(1);
  const Image half = wall.tile(1);
  double off = 0;
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      ASSERT_EQ(test::difference(half.at(x, y), half.at(x / 2 * 2, y / 2 * 2)), 0);
      off += test::difference(half.at(x, y), full.at(x, y));
    }
  }
  EXPECT_GT(off, 0);
  EXPECT_LT(off / (half.width * half.height), 8) << "of 255";
  wall.renderer->beginRefining(inFront(), 0);
  while (!wall.renderer->refine(wall.clock.now() + std::chrono::milliseconds(20)))
    ASSERT_EQ(wall.tile(1).pixels, half.pixels) << "shown when it is whole";
  EXPECT_EQ(wall.tile(1).pixels, full.pixels);
}

// At full detail, vertices that were interpolated are at their own positions again.
TEST(FrameRenderer, FullDetailIsWithoutGeomorphs) {
  Wall wall(fourTiles());
  wall.draw();
  const Image full = wall.tile(1);
  const std::size_t level = model().levelFor(600);
  wall.draw(level);
  const Image moving = wall.tile(1);
  wall.draw();
  EXPECT_EQ(wall.tile(1).pixels, full.pixels);
  wall.draw(level);
  EXPECT_EQ(wall.tile(1).pixels, moving.pixels) << "a function of the level alone";
}

// The result must not depend on which context draws which tile.
TEST(FrameRenderer, TwoContextsDrawThePixelsOfOne) {
  Wall one(fourTiles(), gl::GlBackend::kEgl, 1), two(fourTiles(), gl::GlBackend::kEgl, 2);
  EXPECT_EQ(two.renderer->contexts()->renderer(),
            one.renderer->contexts()->renderer() + ", two contexts");
  const auto same = [&] {
    return std::ranges::equal(one.renderer->pixels(), two.renderer->pixels());
  };
  for (const std::size_t triangles : {2000U, 800U, 300U, 1500U}) {
    for (Wall* wall : {&one, &two}) wall->draw(model().levelFor(triangles));
    EXPECT_TRUE(same()) << triangles;
  }
  for (Wall* wall : {&one, &two}) {
    wall->renderer->beginRefining(inFront(), 0);
    while (!wall->renderer->refine(wall->clock.now() + std::chrono::milliseconds(20))) continue;
  }
  EXPECT_TRUE(same());
  one.draw();
  EXPECT_TRUE(same()) << "full detail, drawn at once by one";
}

// Returns frames at full size and at reduced sizes, and a refined one. Only one wall at a time can
// have its context current.
std::vector<std::vector<std::uint8_t>> framesOf(const gl::GlSettings& settings) {
  Wall wall(fourTiles(), settings);
  EXPECT_EQ(wall.renderer->contexts()->asynchronous,
            settings.read_back == gl::ReadBackMode::kAsynchronous);
  std::vector<std::vector<std::uint8_t>> frames;
  const auto keep = [&] {
    const auto pixels = wall.renderer->pixels();
    frames.emplace_back(pixels.begin(), pixels.end());
  };
  for (const int divisor : {1, 2, 1}) {
    wall.renderer->setSizeDivisor(divisor);
    wall.draw(model().levelFor(500 + 100 * frames.size()));
    keep();
  }
  wall.renderer->beginRefining(inFront(), 0);
  while (!wall.renderer->refine(wall.clock.now() + std::chrono::milliseconds(20))) continue;
  keep();
  return frames;
}

TEST(FrameRenderer, PixelsThatAreReadBackAsynchronouslyAreTheSame) {
  using Mode = gl::ReadBackMode;
  for (const auto& [backend, contexts] :
       {std::pair{gl::GlBackend::kEgl, 1}, std::pair{gl::GlBackend::kEgl, 2},
        std::pair{gl::GlBackend::kOsmesa, 1}}) {
    const auto direct = framesOf({.backend = backend, .contexts = 1, .read_back = Mode::kDirect});
    const auto later =
        framesOf({.backend = backend, .contexts = contexts, .read_back = Mode::kAsynchronous});
    EXPECT_EQ(direct, later) << contexts;
    EXPECT_NE(direct[0], direct[2]) << "several frames, not one";
  }
}

TEST(FrameRenderer, ASoftwareRendererIsReadBackDirectlyUnlessSet) {
  const auto contexts = frame::DrawContexts::make({.gpu = gl::kNoGpu});
  ASSERT_TRUE(contexts) << contexts.error().what;
  EXPECT_TRUE((*contexts)->own->info().software);
  EXPECT_FALSE((*contexts)->asynchronous);
}

// A clock that advances by a millisecond each time that it is read.
class TickingClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return now_ += std::chrono::milliseconds(1); }
  bool sleepUntil(Timestamp, const std::stop_token&) noexcept override { return true; }

 private:
  mutable Timestamp now_{};
};

// The measured time includes giving a frame to the GPU, waiting for it, and copying its pixels.
TEST(FrameRenderer, AsynchronousFramesCountTheirWholeTime) {
  const auto timesWith = [](gl::ReadBackMode mode) {
    const TickingClock clock;
    const auto plan = *render::tiles::planTiles(fourTiles());
    const auto renderer = *test::rendererOf(
        model(), plan, {.gl = {.contexts = 1, .read_back = mode}, .model = {}}, 2.0, clock);
    renderer->draw({.T_eye_content = inFront(), .step = 0});
    return renderer->draw({.T_eye_content = inFront(), .step = 0});
  };
  const frame::DrawTimes direct = timesWith(gl::ReadBackMode::kDirect);
  const frame::DrawTimes later = timesWith(gl::ReadBackMode::kAsynchronous);
  // In the asynchronous mode the renderer reads the clock twice more for each of the four tiles.
  EXPECT_GT(later.drawing + later.fixed,
            direct.drawing + direct.fixed + std::chrono::milliseconds(7));
  EXPECT_GE(later.drawing, direct.drawing);
}

TEST(FrameRenderer, OsmesaHasOneContextForAProcess) {
  const auto plan = *render::tiles::planTiles(fourTiles());
  const SystemClock clock;
  const auto two = test::rendererOf(
      model(), plan, {.gl = {gl::GlBackend::kOsmesa, 2, 0}, .model = {}}, 2.0, clock);
  ASSERT_FALSE(two);
  EXPECT_EQ(
      two.error().what,
      "render.contexts: OSMesa has only one context in a process; set it to 1, or render.backend "
      "to egl");
}

// In a wall of several models, drawing one must leave no GL state that affects another.
TEST(FrameRenderer, TwoInOneContextDrawWhatEachDrawsAlone) {
  Wall alone(fourTiles()), first(fourTiles());
  const SystemClock clock;
  frame::RenderSettings dark;
  dark.model.style.brightness = 0.5F;
  const auto second =
      *test::rendererOf(model(), first.plan, dark, 2.0, clock, first.renderer->contexts());
  alone.draw();
  first.draw();
  second->draw({.T_eye_content = inFront(), .step = 10});
  EXPECT_FALSE(std::ranges::equal(second->pixels(), alone.renderer->pixels()));
  first.draw(5);
  first.draw();
  EXPECT_TRUE(std::ranges::equal(first.renderer->pixels(), alone.renderer->pixels()));
}

// Returns the mean difference, 0..255, between two columns of pixels.
double step(const Image& left, int x, const Image& right, int y) {
  double sum = 0;
  for (int row = 0; row < left.height; ++row)
    sum += test::difference(left.at(x, row), right.at(y, row));
  return sum / left.height;
}

TEST(FrameRenderer, TilesContinueOneAnotherAtTheSeams) {
  Wall wall(fourTiles());
  wall.draw();
  const Image left = wall.tile(0), centre = wall.tile(1), right = wall.tile(2);
  const int last = kTileWidth - 1;
  const double inside = (step(left, last - 1, left, last) + step(centre, 0, centre, 1) +
                         step(centre, last - 1, centre, last) + step(right, 0, right, 1)) /
                        4;
  ASSERT_GT(inside, 0.5);  // the columns at the seam are not uniform
  EXPECT_LT(step(left, last, centre, 0), 2 * inside);
  EXPECT_LT(step(centre, last, right, 0), 2 * inside);
  EXPECT_GT(step(right, last, left, 0), 3 * inside);  // for comparison: two edges that do not touch
}

// A single view centred between two tiles shows at its middle what each tile shows at the seam.
TEST(FrameRenderer, SeamIsWhereOneWideViewHasIt) {
  Wall wall(fourTiles());
  wall.draw();
  tiles::TilesSettings between = fourTiles();
  between.frame_width = kTileWidth;
  between.frame_height = kTileHeight;
  between.tiles = {{"half left", tiles::TileKind::kWall, 0, 0, 0.5}};
  Wall one(between);
  one.draw();
  // At the middle of this view the ray is that of the seam; its pixels are a little smaller.
  const Image left = wall.tile(0), centre = wall.tile(1), half = one.tile(0);
  const auto far = [](const Image& a, int x, int y, const Image& b) {
    return test::difference(a.at(x, y), b.at(kTileWidth / 2, kTileHeight / 2));
  };
  EXPECT_LE(std::min(far(left, kTileWidth - 1, kTileHeight / 2, half),
                     far(centre, 0, kTileHeight / 2, half)),
            12);
}

TEST(FrameRenderer, RefiningInSlicesEndsInTheSamePicture) {
  Wall wall(fourTiles());
  wall.draw(0);
  const std::vector<std::uint8_t> whole(wall.renderer->pixels().begin(),
                                        wall.renderer->pixels().end());
  wall.draw(model().levelFor(200));
  EXPECT_FALSE(std::equal(whole.begin(), whole.end(), wall.renderer->pixels().begin()));
  wall.renderer->beginRefining(inFront(), 0);
  while (!wall.renderer->refine(wall.clock.now() + std::chrono::milliseconds(20))) {
  }
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), wall.renderer->pixels().begin()));
}

TEST(FrameRenderer, RefiningToALevelEndsInThatLevelsPicture) {
  Wall wall(fourTiles());
  const std::size_t level = model().levelFor(400);
  wall.draw(level);
  const std::vector<std::uint8_t> whole(wall.renderer->pixels().begin(),
                                        wall.renderer->pixels().end());
  wall.draw(model().levelFor(100));
  EXPECT_FALSE(std::equal(whole.begin(), whole.end(), wall.renderer->pixels().begin()));
  wall.renderer->beginRefining(inFront(), level);
  while (!wall.renderer->refine(wall.clock.now() + std::chrono::milliseconds(20))) {
  }
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), wall.renderer->pixels().begin()));
}

TEST(FrameRenderer, SaysWhatItsTimeWentTo) {
  Wall wall(fourTiles(), gl::GlBackend::kEgl, 1);
  wall.draw(model().levelFor(200));
  std::vector<frame::FrameStep::Kind> kinds;
  Timestamp last{};
  for (const frame::FrameStep& step : wall.renderer->steps()) {
    kinds.push_back(step.kind);
    EXPECT_GE(step.begin, last);
    EXPECT_GE(step.end, step.begin);
    last = step.end;
  }
  using enum frame::FrameStep::Kind;
  EXPECT_EQ(kinds, (std::vector{kChoose, kUpload, kDraw, kReadBack, kDraw, kReadBack, kDraw,
                                kReadBack, kDraw, kReadBack}));
}

// The steps of the second thread follow those of the first one; each tile is drawn by one thread.
TEST(FrameRenderer, SaysWhatTheTimeOfBothThreadsWentTo) {
  Wall wall(fourTiles(), gl::GlBackend::kEgl, 2);
  wall.draw(model().levelFor(200));
  std::map<frame::FrameStep::Kind, std::multiset<int>> tiles;
  for (const frame::FrameStep& step : wall.renderer->steps()) tiles[step.kind].insert(step.tile);
  using enum frame::FrameStep::Kind;
  EXPECT_EQ(tiles[kChoose].size(), 1U);
  EXPECT_EQ(tiles[kUpload].size(), 2U);
  EXPECT_EQ(tiles[kDraw], (std::multiset{0, 1, 2, 3}));
  EXPECT_EQ(tiles[kReadBack], (std::multiset{0, 1, 2, 3}));
}

TEST(FrameRenderer, OperatorSeesTheWholeModel) {
  Wall wall(fourTiles());
  wall.draw();
  const Image operators = wall.tile(3);
  const test::Rgba background{15, 18, 23, 255};
  EXPECT_GT(operators.covered(background), kTileWidth * kTileHeight / 20);
  for (int x = 0; x < kTileWidth; ++x) {
    EXPECT_EQ(operators.at(x, 0), background);
    EXPECT_EQ(operators.at(x, kTileHeight - 1), background);
  }
  for (int y = 0; y < kTileHeight; ++y) {
    EXPECT_EQ(operators.at(0, y), background);
    EXPECT_EQ(operators.at(kTileWidth - 1, y), background);
  }
}

TEST(FrameRenderer, OperatorsViewGivesWayBeforeTheFrameIsLate) {
  for (const auto mode : {gl::ReadBackMode::kDirect, gl::ReadBackMode::kAsynchronous}) {
    Wall wall(fourTiles(), gl::GlSettings{.read_back = mode});
    wall.draw();
    const Image left = wall.tile(0), operators = wall.tile(3);
    const frame::DrawTimes times = wall.renderer->draw({inFront(), 0, wall.clock.now()});
    EXPECT_TRUE(times.gave_way);
    EXPECT_EQ(wall.tile(0).pixels, left.pixels);
    EXPECT_NE(wall.tile(3).pixels, operators.pixels);
  }
}

TEST(FrameRenderer, OsmesaDrawsTheSameWall) {
  Image egl, osmesa;
  {
    Wall wall(fourTiles());
    wall.draw();
    egl = wall.tile(1);
  }
  {
    Wall wall(fourTiles(), gl::GlBackend::kOsmesa);
    wall.draw();
    osmesa = wall.tile(1);
  }
  EXPECT_LE(1000 * test::differing(egl, osmesa, 2), kTileWidth * kTileHeight);
}

// Returns settings in which one tile has a camera of its own.
tiles::TilesSettings ownView(tiles::TileCamera view) {
  tiles::TilesSettings s;
  s.frame_width = s.tile_width = kTileWidth;
  s.frame_height = s.tile_height = kTileHeight;
  s.tiles = {{"own", tiles::TileKind::kWall, 0, 0, 0}};
  s.tiles[0].view = view;
  return s;
}

// Returns a ball that looks different from every side.
const lod::Dendrogram& lopsided() {
  static const lod::Dendrogram made = [] {
    mesh::Mesh mesh = test::sphere(4);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
      float* const p = &mesh.positions[i];
      const float bump = p[0] > 0.4F && p[1] > 0 ? 1.6F : 1;
      p[0] *= bump;
      p[1] *= 0.7F * bump;
      p[2] *= p[2] > 0 ? 0.4F : 0.9F;
    }
    mesh::ensureNormals(mesh);
    return lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
  }();
  return made;
}

// Seen from the right, the content looks as it does from the front after a quarter turn, wherever
// it is placed.
TEST(OwnViews, AreThoseOfTheSameContentFromAnotherSide) {
  const struct {
    tiles::TileCamera camera;
    Eigen::Vector3f axis;
    float turn;
  } sides[] = {{tiles::TileCamera::kTop, Eigen::Vector3f::UnitX(), 1.5707963F},
               {tiles::TileCamera::kSide, Eigen::Vector3f::UnitY(), -1.5707963F}};
  for (const auto& side : sides) {
    Wall own(ownView(side.camera), gl::GlBackend::kEgl, 0, lopsided());
    Wall front(ownView(tiles::TileCamera::kFront), gl::GlBackend::kEgl, 0, lopsided());
    Eigen::Isometry3f T_eye_model = inFront();
    T_eye_model.rotate(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized()));
    own.renderer->draw({.T_eye_content = T_eye_model, .step = 0});
    Eigen::Isometry3f turned = T_eye_model;
    turned.linear() =
        Eigen::AngleAxisf(side.turn, side.axis).toRotationMatrix() * T_eye_model.linear();
    turned.translation() += Eigen::Vector3f(5, -3, 1);
    front.renderer->draw({.T_eye_content = turned, .step = 0});
    const Image from_side = own.tile(0), from_front = front.tile(0);
    EXPECT_GT(from_side.covered(from_side.at(0, 0)), kTileWidth * kTileHeight / 20);
    EXPECT_LT(test::differing(from_side, from_front, 8), kTileWidth * kTileHeight / 500);
    front.renderer->draw({.T_eye_content = T_eye_model, .step = 0});
    EXPECT_GT(test::differing(from_side, front.tile(0), 8), kTileWidth * kTileHeight / 50);
  }
}

// In every view the content is drawn at the requested detail, and the pixels of the wall's tiles do
// not change.
TEST(OwnViews, DoNotChangeTheWallsPicture) {
  tiles::TilesSettings with = fourTiles();
  with.tiles[0].turns = 0;
  with.tiles[0].view = tiles::TileCamera::kTop;
  Wall wall(fourTiles()), other(with);
  wall.draw();
  other.draw();
  for (const std::size_t tile : {1u, 2u, 3u})
    EXPECT_EQ(other.tile(tile).pixels, wall.tile(tile).pixels);
  EXPECT_NE(other.tile(0).pixels, wall.tile(0).pixels);
}

}  // namespace
}  // namespace merlin::render
