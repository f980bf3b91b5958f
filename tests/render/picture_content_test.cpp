// Pictures as a content: which tiles are chosen, requested and drawn. The drawn pixels are compared
// with the picture itself, which the test scales or maps onto the sphere.
#include "render/content/picture/picture_content.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "render/frame/frame_renderer.h"
#include "tests/support/pyramids.h"

namespace merlin::render::content {
namespace {

using image::TilePlace;

// Loads each tile as soon as it is requested; loads nothing while `silent`.
class FakeTiles final : public TileSource {
 public:
  void ask(const std::shared_ptr<const Picture>& picture,
           std::span<const TilePlace> places) override {
    if (picture != picture_) reader_.reset();
    picture_ = picture;
    asked.assign(places.begin(), places.end());
    next_ = 0;
  }
  std::optional<LoadedTile> take() override {
    if (!hasLoaded()) return std::nullopt;
    const TilePlace place = asked[next_++];
    if (!reader_) reader_.emplace(picture_->file);
    LoadedTile tile{picture_, place, {}};
    ++taken;
    if (broken.count(place) > 0) return tile;
    EXPECT_TRUE(readPictureTile(*reader_, picture_->kind, place, tile.pixels));
    return tile;
  }
  bool hasLoaded() const override { return !silent && next_ < asked.size(); }
  bool isLoading() const override { return silent && next_ < asked.size(); }

  std::vector<TilePlace> asked;
  std::set<TilePlace> broken;
  bool silent = false;
  int taken = 0;

 private:
  std::shared_ptr<const Picture> picture_;
  std::optional<image::PyramidReader> reader_;
  std::size_t next_ = 0;
};

std::shared_ptr<const Picture> pictureOf(const test::PyramidSpec& spec,
                                         ShowAs as = ShowAs::kAsMarked) {
  auto file = test::readPyramid(test::pyramidBytes(spec));
  EXPECT_TRUE(file) << file.error().what;
  auto picture = makePicture(*std::move(file), as);
  EXPECT_TRUE(picture);
  return *picture;
}

// Returns the colour at a pixel of a picture whose colours change smoothly and differ everywhere.
test::Rgb waves(int x, int y) {
  const auto wave = [](double phase) {
    return static_cast<std::uint8_t>(127.5 + 120 * std::sin(phase));
  };
  return {wave(x / 40.0), wave(y / 30.0), wave((x + y) / 50.0)};
}

test::Rgb plain(int /*x*/, int /*y*/) { return {1, 2, 3}; }

constexpr int kSide = 256;

tiles::TilePlan planOf(double field_of_view_deg) {
  tiles::TilesSettings s;
  s.tile_width = s.tile_height = s.frame_width = s.frame_height = kSide;
  s.field_of_view_deg = field_of_view_deg;
  s.tiles = {{"all", tiles::TileKind::kWall, 0, 0, 0}};
  return *tiles::planTiles(s);
}

// Returns the view that the plan's first tile has of a content with the given pose.
ContentView viewOf(const tiles::TilePlan& plan, const Eigen::Isometry3f& T_eye_content) {
  const tiles::Tile& t = plan.tiles[0];
  return {0,
          t.projection * t.view * T_eye_content.matrix(),
          Eigen::Matrix3f::Identity(),
          t.width,
          t.height,
          1};
}

class PictureTest : public testing::Test {
 protected:
  void look(const Eigen::Isometry3f& T_eye_content) { view_ = viewOf(plan_, T_eye_content); }
  void choose(std::size_t step = 0) { content_->choose(step, std::span(&view_, 1)); }
  void make(const test::PyramidSpec& spec, ShowAs as = ShowAs::kAsMarked,
            std::size_t memory = std::size_t{64} << 20) {
    content_ =
        std::make_unique<PictureContent>(pictureOf(spec, as), tiles_, std::sqrt(2.0),
                                         std::size_t{kSide} * kSide, PictureMemory{memory, 1});
  }

  // Returns the coarsest level of all tiles that are drawn.
  int levelShown() const {
    int level = 0;
    for (const TilePiece& piece : content_->drawList().pieces[0])
      level = std::max(level, content_->cache().slot(piece.slot).place->level);
    return level;
  }

  tiles::TilePlan plan_ = planOf(90);
  FakeTiles tiles_;
  std::unique_ptr<PictureContent> content_;
  ContentView view_ = viewOf(plan_, Eigen::Isometry3f(Eigen::Translation3f(0, 0, -1)));
};

TEST_F(PictureTest, NeedsTheLevelWhosePixelsAreNoLargerThanTheViews) {
  make({.width = 2048, .height = 2048, .colour = waves});
  choose();
  // The whole picture fills 256 pixels, so the coarsest level, which is always loaded, suffices.
  EXPECT_TRUE(tiles_.asked.empty());
  EXPECT_EQ(content_->drawList().pieces[0].size(), 1U);
  EXPECT_EQ(content_->pending(), Pending::kNothing);
  look(Eigen::Isometry3f(Eigen::Translation3f(0, 0, -0.25F)));  // a quarter of it, 512 pixels
  choose();
  EXPECT_EQ(content_->pending(), Pending::kArrived);
  const int finest = std::ranges::min_element(tiles_.asked, {}, &TilePlace::level)->level;
  EXPECT_EQ(finest, 1);
  EXPECT_EQ(tiles_.asked.front().level, 2) << "coarse ones come first";
}

TEST_F(PictureTest, ShowsCoarserTilesUntilTheOthersAreThere) {
  make({.width = 2048, .height = 2048, .colour = waves});
  look(Eigen::Isometry3f(Eigen::Translation3f(0, 0, -0.25F)));
  tiles_.silent = true;
  choose();
  EXPECT_EQ(content_->pending(), Pending::kLoading);
  for (const TilePiece& piece : content_->drawList().pieces[0])
    EXPECT_EQ(content_->cache().slot(piece.slot).place, (TilePlace{3, 0, 0}));
  tiles_.silent = false;
  choose();
  EXPECT_EQ(content_->pending(), Pending::kNothing);
  for (const TilePiece& piece : content_->drawList().pieces[0])
    EXPECT_EQ(content_->cache().slot(piece.slot).place->level, 1);
}

TEST_F(PictureTest, TakesFewTilesAFrameWhileItMoves) {
  make({.width = 2048, .height = 2048, .colour = plain});
  view_.width_px = view_.height_px = 1024;  // 16 tiles of level 1
  content_->setMoving(true);
  choose();
  choose();
  EXPECT_EQ(tiles_.taken, 6);
  content_->setMoving(false);
  choose();
  EXPECT_EQ(content_->pending(), Pending::kNothing);
}

TEST_F(PictureTest, ACoarserStepShowsACoarserLevel) {
  make({.width = 2048, .height = 2048, .colour = plain});
  // Now 1.6 pixels of the picture are in one pixel of the view.
  look(Eigen::Isometry3f(Eigen::Translation3f(0, 0, -0.2F)));
  for (int i = 0; i < 3; ++i) choose(0);
  EXPECT_EQ(levelShown(), 0);
  choose(4);  // texels of up to 4 pixels
  EXPECT_EQ(levelShown(), 2);
  EXPECT_EQ(content_->detail().costOf(4), content_->detail().costOf(0) / 16);
  EXPECT_EQ(content_->detail().stepWithin(content_->detail().costOf(4)), 4U);
  EXPECT_EQ(content_->detail().stepWithin(0), content_->detail().steps() - 1);
}

TEST_F(PictureTest, ATileThatCannotBeReadIsShownCoarserAndNothingWaitsForIt) {
  make({.width = 1024, .height = 1024, .colour = waves});
  look(Eigen::Isometry3f(Eigen::Translation3f(0, 0, -0.1F)));
  for (std::int32_t i = 0; i < 4; ++i)
    for (std::int32_t j = 0; j < 4; ++j) tiles_.broken.insert({0, i, j});
  for (int i = 0; i < 3; ++i) choose();
  EXPECT_EQ(content_->pending(), Pending::kNothing);
  for (const TilePiece& piece : content_->drawList().pieces[0])
    EXPECT_EQ(content_->cache().slot(piece.slot).place->level, 1);
}

TEST_F(PictureTest, KeepsWithinItsMemory) {
  constexpr std::size_t kMemory = std::size_t{64} << 20;
  make({.width = 1024, .height = 1024, .colour = waves}, ShowAs::kAsMarked, kMemory);
  const std::size_t textures = content_->cache().size() * 4 * kBorderedSide * kBorderedSide;
  EXPECT_LT(textures + TileLoader::kMostLoaded * image::kTileBytes, kMemory);
  EXPECT_GT(textures, kMemory / 3);
}

// The picture has 400,000 x 250,000 pixels. Only its levels matter here, so there is no file.
TEST(TileChoice, OfA100GigapixelPictureIsAsSmallAsTheView) {
  std::vector<image::PyramidLevel> levels;
  for (std::int64_t w = 400'000, h = 250'000;; w /= 2, h /= 2) {
    levels.push_back({w, h, (w + 255) / 256, (h + 255) / 256});
    if (w <= 256 && h <= 256) break;
  }
  const auto plane = makePlane(400'000, 250'000, 1);
  const tiles::TilePlan plan = planOf(50);
  for (const float distance : {2.0F, 0.1F, 0.001F, 0.0001F}) {
    const ContentView view =
        viewOf(plan, Eigen::Isometry3f(Eigen::Translation3f(0.3F, 0.2F, -distance)));
    std::vector<TilePlace> tiles;
    EXPECT_TRUE(chooseTiles(levels, *plane, {view.clip_from_metres.cast<double>(), kSide, kSide}, 1,
                            40, tiles));
    EXPECT_FALSE(tiles.empty()) << distance;
  }
}

// The default memory is checked at any zoom, on a wall of four tiles that show different parts of
// the picture.
TEST(PictureMemory, ByDefaultIsEnoughForFullDetailOfAnyWall) {
  const std::vector<image::PyramidLevel> levels = [] {
    std::vector<image::PyramidLevel> all;
    for (std::int64_t side = 1 << 18; side >= 256; side /= 2)
      all.push_back({side, side, side / 256, side / 256});
    return all;
  }();
  const auto plane = makePlane(1 << 18, 1 << 18, 1);
  for (const auto& [width, height] : {std::pair{640, 480}, {1920, 1080}, {3840, 2160}}) {
    std::size_t most = 0;
    for (double zoom = 8; zoom < 18; zoom *= 1.03) {
      Eigen::Matrix4d clip = Eigen::Matrix4d::Identity();
      clip(0, 0) = zoom;
      clip(1, 1) = zoom * width / height;
      clip(0, 3) = 0.011 * zoom;
      std::vector<TilePlace> tiles;
      const PictureView view{clip, static_cast<double>(width), static_cast<double>(height)};
      EXPECT_TRUE(chooseTiles(levels, *plane, view, 1, 100'000, tiles));
      most = std::max(most, tiles.size());
    }
    const auto wall_px = static_cast<std::size_t>(4 * width * height);
    EXPECT_LE(static_cast<double>(4 * most),
              0.7 * static_cast<double>(pictureSlots({0, 2}, wall_px)))
        << width << " x " << height << ": " << most << " tiles a view";
    EXPECT_GT(most, 20u);
  }
  EXPECT_LT(pictureSlots({std::size_t{64} << 20, 2}, 33'000'000), 200u) << "if it is set, it holds";
}

TEST(TileChoice, EveryPixelOfAPictureHasOneTileInEachLevel) {
  // 513 pixels are three tiles; the next level is rounded down and has one tile in their place.
  const std::vector<image::PyramidLevel> levels = {{513, 300, 3, 2}, {256, 150, 1, 1}};
  EXPECT_EQ(parentOf(levels, {0, 2, 1}), (TilePlace{1, 0, 0}));
  EXPECT_EQ(rectOf(levels, {1, 0, 0}).right, 513);
  EXPECT_EQ(rectOf(levels, {0, 2, 1}).right, 513);
  EXPECT_EQ(rectOf(levels, {0, 2, 1}).left, 512);
}

// Draws with one EGL context.
class DrawnPictureTest : public testing::Test {
 protected:
  void show(const test::PyramidSpec& spec, const tiles::TilePlan& plan, double radius_m,
            ShowAs as = ShowAs::kAsMarked) {
    plan_ = plan;
    auto content = std::make_unique<PictureContent>(pictureOf(spec, as), tiles_, radius_m,
                                                    std::size_t{kSide} * kSide, PictureMemory{});
    renderer_ = *frame::FrameRenderer::make(std::move(content), plan_,
                                            *frame::DrawContexts::make({}), clock_);
  }
  // Draws until all tiles that the view needs are loaded.
  void draw(const Eigen::Isometry3f& T_eye_content) {
    for (int i = 0; i < 40; ++i) renderer_->draw({.T_eye_content = T_eye_content, .step = 0});
    EXPECT_EQ(renderer_->pending(), Pending::kNothing);
  }
  const std::uint8_t* at(int x, int y) {
    return &renderer_->pixels()[static_cast<std::size_t>(4 * (kSide * y + x))];
  }
  // Returns the largest difference between a drawn pixel and what `expected` computes for its
  // centre.
  template <typename Expected>
  int worst(const Expected& expected) {
    int difference = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const test::Rgb rgb = expected(x + 0.5, y + 0.5);
        for (int k = 0; k < 3; ++k)
          difference =
              std::max(difference, std::abs(at(x, y)[k] - rgb[static_cast<std::size_t>(k)]));
      }
    }
    return difference;
  }

  FakeTiles tiles_;
  SystemClock clock_;
  tiles::TilePlan plan_;
  std::unique_ptr<frame::FrameRenderer> renderer_;
};

// A picture of 1024 x 1024 pixels fills the view of 256 x 256 pixels after a zoom by four, with one
// texel in each pixel. The seams of its tiles lie at 0 and 256 pixels, moved by 100.
TEST_F(DrawnPictureTest, IsThePictureToOneLevelWithoutSeams) {
  show({.width = 1024, .height = 1024, .colour = waves}, planOf(90), std::sqrt(2.0));
  const float pixel_m = 2.0F / 1024;
  draw(Eigen::Isometry3f(Eigen::Translation3f(100 * pixel_m, 60 * pixel_m, -0.25F)));
  const auto expected = [](double x, double y) {
    // The middle of the view shows pixel (512 - 100, 512 + 60).
    return waves(static_cast<int>(std::floor(x)) + 384 - 100,
                 static_cast<int>(std::floor(y)) + 384 + 60);
  };
  EXPECT_LE(worst(expected), 2);
}

// At a magnification of 8, filtering must work across the seam between two tiles as it does
// elsewhere.
TEST_F(DrawnPictureTest, FiltersAcrossTheSeamsOfTiles) {
  const auto steps = [](int x, int y) {
    return test::Rgb{static_cast<std::uint8_t>(x / 2 % 256), static_cast<std::uint8_t>(y / 2 % 256),
                     77};
  };
  show({.width = 512, .height = 512, .colour = steps}, planOf(90), std::sqrt(2.0));
  draw(Eigen::Isometry3f(
      Eigen::Translation3f(0, 0, -1.0F / 16)));  // 32 x 32 pixels about the middle
  int last = at(0, 128)[0];
  for (int x = 1; x < kSide; ++x) {
    EXPECT_GE(at(x, 128)[0], last) << x;
    EXPECT_LE(at(x, 128)[0], last + 1) << x;
    last = at(x, 128)[0];
  }
  EXPECT_EQ(at(4, 4)[2], 77);
}

TEST_F(DrawnPictureTest, APictureSmallerThanTheViewLeavesTheRestAsBackground) {
  show({.width = 400,
        .height = 200,
        .colour =
            [](int, int) {
              return test::Rgb{255, 255, 255};
            }},
       planOf(90), std::sqrt(5.0) / 4);  // 1 m wide, half a metre high
  draw(Eigen::Isometry3f(Eigen::Translation3f(0, 0, -1)));
  EXPECT_EQ(at(66, 128)[0], 255);
  EXPECT_EQ(at(62, 128)[0], 0);
  EXPECT_EQ(at(128, 98)[0], 255);
  EXPECT_EQ(at(128, 94)[0], 0);
}

// Returns the colour of a panorama in a given direction (x right, y up; the eye looks along -z).
test::Rgb panoramaAt(const Eigen::Vector3d& direction, int width, int height) {
  const Eigen::Vector3d d = direction.normalized();
  const double u = std::atan2(d.x(), -d.z()) / (2 * std::numbers::pi) + 0.5;
  const double v = 0.5 - std::asin(d.y()) / std::numbers::pi;
  return {static_cast<std::uint8_t>(127.5 + 120 * std::sin(2 * std::numbers::pi * u)),
          static_cast<std::uint8_t>(127.5 + 120 * std::cos(2 * std::numbers::pi * u)),
          static_cast<std::uint8_t>(255 * std::clamp(v, 0.0, 1.0) + 0 * (width + height))};
}

test::PyramidSpec panoramaSpec() {
  constexpr int kWidth = 2048, kHeight = 1024;
  return {.width = kWidth,
          .height = kHeight,
          .colour =
              [](int x, int y) {
                const double u = (x + 0.5) / kWidth, v = (y + 0.5) / kHeight;
                return test::Rgb{
                    static_cast<std::uint8_t>(127.5 + 120 * std::sin(2 * std::numbers::pi * u)),
                    static_cast<std::uint8_t>(127.5 + 120 * std::cos(2 * std::numbers::pi * u)),
                    static_cast<std::uint8_t>(255 * v)};
              },
          .description = image::kPanoramaMark};
}

class PanoramaTest : public DrawnPictureTest,
                     public testing::WithParamInterface<std::array<double, 2>> {};

// The directions are straight ahead, across the seam at 180 degrees, and both poles.
TEST_P(PanoramaTest, IsWhatEachDirectionShows) {
  const auto [yaw_deg, pitch_deg] = GetParam();
  show(panoramaSpec(), planOf(60), 1);
  constexpr double kRadian = std::numbers::pi / 180;
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(pitch_deg * kRadian, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(yaw_deg * kRadian, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  pose.linear() = turned.cast<float>();
  draw(pose);
  const double tangent = std::tan(30 * kRadian);
  EXPECT_LE(worst([&](double x, double y) {
              const Eigen::Vector3d seen((x / kSide * 2 - 1) * tangent,
                                         (1 - y / kSide * 2) * tangent, -1);
              return panoramaAt(turned.transpose() * seen, 2048, 1024);
            }),
            3);
}
INSTANTIATE_TEST_SUITE_P(Directions, PanoramaTest,
                         testing::Values(std::array{0.0, 0.0}, std::array{180.0, 0.0},
                                         std::array{179.0, 10.0}, std::array{40.0, -85.0},
                                         std::array{-100.0, 85.0}));

TEST_F(DrawnPictureTest, APanoramaIsSeenFromItsMiddleWhereverTheHeadIs) {
  show(panoramaSpec(), planOf(60), 1);
  const Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  draw(pose);
  const std::vector<std::uint8_t> middle(renderer_->pixels().begin(), renderer_->pixels().end());
  plan_.tiles[0].view(0, 3) = 0.4F;  // the head is 0.4 m to the left
  draw(pose);
  EXPECT_TRUE(std::ranges::equal(renderer_->pixels(), middle));
  EXPECT_EQ(renderer_->content().navigation(), Navigation::kPanorama);
}

TEST_F(DrawnPictureTest, ShowsAnotherPictureInTheNextFrame) {
  auto content = std::make_unique<PictureContent>(pictureOf({.colour =
                                                                 [](int, int) {
                                                                   return test::Rgb{200, 0, 0};
                                                                 }}),
                                                  tiles_, std::sqrt(2.0),
                                                  std::size_t{kSide} * kSide, PictureMemory{});
  PictureContent& shown = *content;
  plan_ = planOf(90);
  renderer_ = *frame::FrameRenderer::make(std::move(content), plan_, *frame::DrawContexts::make({}),
                                          clock_);
  const Eigen::Isometry3f pose(Eigen::Translation3f(0, 0, -1));
  draw(pose);
  EXPECT_EQ(at(128, 128)[0], 200);
  shown.show(pictureOf({.width = 300, .height = 300, .colour = [](int, int) {
                          return test::Rgb{0, 100, 0};
                        }}));
  renderer_->draw({.T_eye_content = pose, .step = 0});
  EXPECT_EQ(at(128, 128)[0], 0);
  EXPECT_EQ(at(128, 128)[1], 100);
}

}  // namespace
}  // namespace merlin::render::content
