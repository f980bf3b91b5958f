// For each preset, the tiles together must show one view: each tile equals a part of one larger
// rendering in its panel's plane, and neighbours meet at their seams.
//
// The test prints its figures. If the environment variable MERLIN_PICTURES is set, it writes
// pictures of the seams into that folder, for people to look at: both tiles side by side, and below
// them the one rendering in the left tile's plane.
#include <cmath>
#include <cstdlib>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/image/png_writer.h"
#include "render/reduce/reduce.h"
#include "render/room/room_tiles.h"
#include "tests/support/meshes.h"
#include "tests/support/model_frames.h"
#include "tests/support/pictures.h"

namespace merlin::render {
namespace {

using Eigen::Vector3d;
using test::Image;

constexpr int kWidth = 320, kHeight = 240;
constexpr int kTolerance = 8;       // of 255
constexpr double kMostOff = 0.001;  // share of the pixels that may differ by more
constexpr double kHallRadius_m = 9;

mesh::Mesh scaled(mesh::Mesh mesh, float factor) {
  for (float& x : mesh.positions) x *= factor;
  return mesh;
}

// Returns a hall with a bumpy wall around the eye, in which there are a hundred balls and cubes of
// different colours.
mesh::Mesh hall() {
  Random random(11);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  mesh::Mesh mesh = test::sphere(5);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    const float bump = uniform(0.9, 1);
    for (std::size_t k = 0; k < 3; ++k) mesh.positions[i + k] *= bump;
  }
  mesh::Feature colour{"colour", 3, {}};
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    for (int k = 0; k < 3; ++k) colour.values.push_back(uniform(0.3, 0.7));
  }
  for (int n = 0; n < 100; ++n) {
    const double turn = 2 * M_PI * n / 100, away = uniform(0.25, 0.8);
    mesh::Mesh thing = scaled(n % 2 == 0 ? test::sphere(2) : test::cube(), uniform(0.015, 0.05));
    thing = test::moved(std::move(thing), static_cast<float>(away * std::sin(turn)),
                        uniform(-0.35, 0.35), static_cast<float>(away * std::cos(turn)));
    const float rgb[] = {uniform(0, 1), uniform(0, 1), uniform(0, 1)};
    for (std::size_t v = 0; v < thing.vertexCount(); ++v)
      colour.values.insert(colour.values.end(), std::begin(rgb), std::end(rgb));
    mesh = test::together(std::move(mesh), thing);
  }
  mesh.features.push_back(std::move(colour));
  return mesh;
}

const lod::Dendrogram& model() {
  static const lod::Dendrogram made = [] {
    mesh::Mesh mesh = hall();
    mesh::ensureNormals(mesh);
    return lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
  }();
  return made;
}

// Draws tiles at full detail, as the wall does. The contexts are shared, since making them takes
// the longest time.
class Painter {
 public:
  // Returns the tiles' images in the order of the tiles.
  std::vector<Image> draw(const tiles::TilesSettings& tiles) {
    const tiles::TilePlan plan = *tiles::planTiles(tiles);
    frame::RenderSettings settings;
    settings.model.style.draw_back_faces = true;
    auto renderer = *test::rendererOf(model(), plan, settings, kHallRadius_m, clock_, contexts_);
    Eigen::Isometry3f T_eye_model(Eigen::Translation3f(0.1F, 0.05F, -0.2F));
    renderer->draw({.T_eye_content = T_eye_model, .step = 0});
    std::vector<Image> images;
    for (const tiles::Tile& t : plan.tiles) {
      Image image{t.width, t.height, {}};
      for (int y = t.y; y < t.y + t.height; ++y) {
        const auto from = renderer->pixels().begin() + 4 * (y * plan.frame_width + t.x);
        image.pixels.insert(image.pixels.end(), from, from + 4 * t.width);
      }
      images.push_back(std::move(image));
    }
    return images;
  }

 private:
  SystemClock clock_;
  std::shared_ptr<const frame::DrawContexts> contexts_ = *frame::DrawContexts::make({});
};

// A rectangle in the room, whose front the eye sees.
struct Rectangle {
  Vector3d corner, across, up;  // lower left; lower and left edge [m]

  explicit Rectangle(const tiles::TileSettings& t)
      : corner(&t.screen_m[0]),
        across(Vector3d(&t.screen_m[3]) - corner),
        up(Vector3d(&t.screen_m[6]) - corner) {}
  // Returns a part of the rectangle, or a rectangle that extends beyond it: left, lower edge, width
  // and height as shares of the rectangle's size.
  Rectangle part(double left, double lower, double width, double height) const {
    Rectangle r = *this;
    r.corner += left * across + lower * up;
    r.across *= width;
    r.up *= height;
    return r;
  }
  // Returns the point in the room of a pixel position, counted from the upper left corner of a
  // picture of width x height pixels.
  Vector3d at(double x, double y, int width, int height) const {
    return corner + x / width * across + (1 - y / height) * up;
  }
  // Sets (x, y) to the pixel position at which the ray from the eye through `point` meets the
  // rectangle's plane; returns false if that is behind the eye.
  bool meets(const Vector3d& point, int width, int height, double& x, double& y) const {
    const Vector3d normal = across.cross(up);
    const double along = corner.dot(normal) / point.dot(normal);
    if (!(along > 0)) return false;
    const Vector3d on = along * point - corner;
    x = on.dot(across) / across.squaredNorm() * width;
    y = (1 - on.dot(up) / up.squaredNorm()) * height;
    return true;
  }
};

tiles::TilesSettings oneTile(const Rectangle& r, int width, int height) {
  tiles::TilesSettings s;
  s.frame_width = width;
  s.frame_height = height;
  s.tiles = {{"one", tiles::TileKind::kWall, 0, 0, 0}};
  s.tiles[0].width = width;
  s.tiles[0].height = height;
  Eigen::Map<Eigen::Matrix3d>(s.tiles[0].screen_m.data()) << r.corner,
      Vector3d(r.corner + r.across), Vector3d(r.corner + r.up);
  return s;
}

struct Count {
  int pixels = 0, off = 0, off_in_surfaces = 0;
  double share() const { return pixels > 0 ? static_cast<double>(off) / pixels : 0; }
};

// Returns whether a pixel next to (x, y) differs from it, so that an edge passes there.
bool isAtEdge(const Image& image, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int nx = std::clamp(x + dx, 0, image.width - 1);
      const int ny = std::clamp(y + dy, 0, image.height - 1);
      if (test::difference(image.at(x, y), image.at(nx, ny)) > kTolerance) return true;
    }
  }
  return false;
}

void compare(const test::Rgba& pixel, const Image& one, int x, int y, Count& count) {
  ++count.pixels;
  if (test::difference(pixel, one.at(x, y)) <= kTolerance) return;
  ++count.off;
  count.off_in_surfaces += isAtEdge(one, x, y) ? 0 : 1;
}

// Compares a tile with the part of `one` whose upper left pixel is at (left, top).
Count comparePart(const Image& tile, const Image& one, int left, int top) {
  Count count;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) compare(tile.at(x, y), one, left + x, top + y, count);
  }
  return count;
}

test::Rgba mixed(const test::Rgba& a, const test::Rgba& b, double share) {
  const auto mix = [&](int from, int to) {
    return static_cast<int>(std::lround(from + share * (to - from)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), 255};
}

// Returns the colour interpolated between the four nearest pixels; pixel (x, y) has its centre at
// (x + 0.5, y + 0.5).
test::Rgba sampleAt(const Image& image, double x, double y) {
  const double fx = std::clamp(x - 0.5, 0.0, image.width - 1.001);
  const double fy = std::clamp(y - 0.5, 0.0, image.height - 1.001);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const auto row = [&](int at) { return mixed(image.at(ix, at), image.at(ix + 1, at), fx - ix); };
  return mixed(row(iy), row(iy + 1), fy - iy);
}

struct Seam {
  std::size_t left, right;  // numbers of the tiles
};

std::vector<Seam> seamsOf(const tiles::TilesSettings& wall) {
  std::vector<Seam> seams;
  for (std::size_t i = 0; i < wall.tiles.size(); ++i) {
    for (std::size_t k = 0; k < wall.tiles.size(); ++k) {
      const Rectangle a(wall.tiles[i]), b(wall.tiles[k]);
      const bool meet = (a.corner + a.across - b.corner).norm() < 1e-6 &&
                        (a.corner + a.across + a.up - b.corner - b.up).norm() < 1e-6;
      if (i != k && meet) seams.push_back({i, k});
    }
  }
  return seams;
}

tiles::TilesSettings wallOf(room::RoomPreset preset) {
  room::RoomSettings room;
  room.preset.name = preset;
  room.preset.width = kWidth;
  room.preset.height = kHeight;
  room.operator_width = room.operator_height = 0;
  return *room::roomTiles(room, {});
}

class PresetPictures : public testing::TestWithParam<room::RoomPreset> {
 protected:
  static void SetUpTestSuite() { painter_ = std::make_unique<Painter>(); }
  static void TearDownTestSuite() { painter_.reset(); }

  // Draws the tile's plane with a frustum that is larger by a quarter on each side.
  Image around(const tiles::TileSettings& tile) const {
    return painter_->draw(
        oneTile(Rectangle(tile).part(-0.25, -0.25, 1.5, 1.5), kWidth * 3 / 2, kHeight * 3 / 2))[0];
  }
  void print(const char* what, const Count& count) const {
    fmt::print(
        "{}: {}: {} of {} pixels ({:.3f} %) differ by more than {} of 255, {} of them not "
        "at an edge\n",
        nameOf(GetParam()), what, count.off, count.pixels, 100 * count.share(), kTolerance,
        count.off_in_surfaces);
  }

  static inline std::unique_ptr<Painter> painter_;
  tiles::TilesSettings wall_ = wallOf(GetParam());
};

void add(Count& sum, const Count& count) {
  sum.pixels += count.pixels;
  sum.off += count.off;
  sum.off_in_surfaces += count.off_in_surfaces;
}

TEST_P(PresetPictures, AreEachAPartOfOneRenderingInTheirPlane) {
  const std::vector<Image> tiles = painter_->draw(wall_);
  Count all;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Count count = comparePart(tiles[i], around(wall_.tiles[i]), kWidth / 4, kHeight / 4);
    EXPECT_LE(count.share(), kMostOff) << wall_.tiles[i].name;
    EXPECT_GT(tiles[i].covered(tiles[i].at(0, 0)), kWidth * kHeight / 2) << "it shows something";
    add(all, count);
  }
  EXPECT_EQ(all.off_in_surfaces, 0);
  print("tiles against a rendering half as large again", all);
}

// A point of the edge that two panels share must be at the edge of both tiles, and at the same
// height.
TEST_P(PresetPictures, ShowASharedEdgeAtOnePlace) {
  const tiles::TilePlan plan = *tiles::planTiles(wall_);
  const auto seams = seamsOf(wall_);
  EXPECT_FALSE(seams.empty());
  double farthest_px = 0;
  for (const Seam& seam : seams) {
    const Rectangle left(wall_.tiles[seam.left]);
    for (double height = 0; height <= 1; height += 0.125) {
      const Vector3d point = left.corner + left.across + height * left.up;
      const auto shownAt = [&](std::size_t tile) {
        const tiles::Tile& t = plan.tiles[tile];
        const Eigen::Vector4f clip = t.projection * t.view * point.cast<float>().homogeneous();
        return Eigen::Vector2f((clip.x() / clip.w() + 1) / 2 * kWidth,
                               (1 - clip.y() / clip.w()) / 2 * kHeight);
      };
      const Eigen::Vector2f in_left = shownAt(seam.left), in_right = shownAt(seam.right);
      EXPECT_NEAR(in_left.x(), kWidth, 0.01);
      EXPECT_NEAR(in_right.x(), 0, 0.01);
      EXPECT_NEAR(in_left.y(), in_right.y(), 0.01);
      farthest_px = std::max({farthest_px, static_cast<double>(std::abs(in_left.x() - kWidth)),
                              static_cast<double>(std::abs(in_right.x())),
                              static_cast<double>(std::abs(in_left.y() - in_right.y()))});
    }
  }
  fmt::print("{}: {} seams, a point of a shared edge is off by at most {:.4f} px\n",
             nameOf(GetParam()), seams.size(), farthest_px);
}

void append(std::vector<std::uint8_t>& pixels, const test::Rgba& p) {
  for (const int value : {p.red, p.green, p.blue, 255})
    pixels.push_back(static_cast<std::uint8_t>(value));
}

// Writes the left tile and the right tile, resampled onto the left tile's plane, and below them the
// one rendering.
void writeSeam(const Image& left, const Image& one, const Rectangle& plane, const Image& right,
               const Rectangle& screen, const std::string& name) {
  const char* const folder = std::getenv("MERLIN_PICTURES");
  if (!folder) return;
  constexpr int kLeft = kWidth / 4, kTop = kHeight / 4;
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < 2 * kHeight; ++y) {
    for (int x = 0; x < kWidth + kLeft; ++x) {
      const int row = y % kHeight;
      if (y >= kHeight) {
        append(pixels, one.at(kLeft + x, kTop + row));
      } else if (x < kWidth) {
        append(pixels, left.at(x, row));
      } else {
        double rx = 0, ry = 0;
        screen.meets(plane.at(kLeft + x + 0.5, kTop + row + 0.5, one.width, one.height), kWidth,
                     kHeight, rx, ry);
        append(pixels, ry >= 0 && ry < kHeight ? sampleAt(right, rx, ry) : test::Rgba{});
      }
    }
  }
  const auto written =
      image::writePng(fmt::format("{}/{}.png", folder, name), kWidth + kLeft, 2 * kHeight, pixels);
  EXPECT_TRUE(written);
}

// The right tile is resampled onto the left tile's plane and compared with a larger rendering of
// that plane. Interpolation softens edges, so pixels at edges differ.
TEST_P(PresetPictures, GoOnBeyondTheirSeams) {
  const std::vector<Image> tiles = painter_->draw(wall_);
  Count all;
  for (const Seam& seam : seamsOf(wall_)) {
    const Rectangle screen(wall_.tiles[seam.right]);
    const Rectangle plane = Rectangle(wall_.tiles[seam.left]).part(-0.25, -0.25, 1.5, 1.5);
    const Image one = around(wall_.tiles[seam.left]);
    for (int y = kHeight / 4; y < kHeight * 5 / 4; ++y) {
      for (int x = kWidth * 5 / 4; x < kWidth * 3 / 2; ++x) {
        double rx = 0, ry = 0;
        if (!screen.meets(plane.at(x + 0.5, y + 0.5, one.width, one.height), kWidth, kHeight, rx,
                          ry))
          continue;
        if (rx < 0.5 || rx > kWidth - 0.5 || ry < 0.5 || ry > kHeight - 0.5) continue;
        compare(sampleAt(tiles[seam.right], rx, ry), one, x, y, all);
      }
    }
    writeSeam(tiles[seam.left], one, plane, tiles[seam.right], screen,
              fmt::format("{}-{}-{}", nameOf(GetParam()), wall_.tiles[seam.left].name,
                          wall_.tiles[seam.right].name));
  }
  print("right tiles on the left ones' planes", all);
  EXPECT_GT(all.pixels, kWidth * kHeight / 8);
  EXPECT_LE(all.off_in_surfaces, kMostOff * all.pixels);
}

// Returns a smaller image in which each pixel is the mean of `times` x `times` pixels.
Image reduced(const Image& image, int times) {
  Image small{image.width / times, image.height / times, {}};
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      test::Rgba sum;
      for (int i = 0; i < times * times; ++i) {
        const test::Rgba p = image.at(times * x + i % times, times * y + i / times);
        sum.red += p.red;
        sum.green += p.green;
        sum.blue += p.blue;
      }
      const int count = times * times;
      append(small.pixels, {sum.red / count, sum.green / count, sum.blue / count, 255});
    }
  }
  return small;
}

// Compares the tile beyond each seam with one rendering, both eight times as fine in each
// direction, so that edges have the same place and softness in both. Only a strip of a quarter of a
// tile is compared.
TEST_P(PresetPictures, GoOnBeyondTheirSeamsAlsoAtEdges) {
  constexpr int kFiner = 8, kStrip = kWidth / 4;
  Count all;
  for (const Seam& seam : seamsOf(wall_)) {
    const Rectangle strip = Rectangle(wall_.tiles[seam.left]).part(1, 0, 0.25, 1);
    const Rectangle screen = Rectangle(wall_.tiles[seam.right]).part(0, 0, 0.5, 1);
    const int width = kStrip * kFiner, height = kHeight * kFiner;
    const Image one = painter_->draw(oneTile(strip, width, height))[0];
    const Image right = painter_->draw(oneTile(screen, kWidth / 2 * kFiner, height))[0];
    Image resampled = one;  // pixels that the right tile does not show count as equal
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double rx = 0, ry = 0;
        if (!screen.meets(strip.at(x + 0.5, y + 0.5, width, height), right.width, right.height, rx,
                          ry) ||
            rx < 0 || rx >= right.width || ry < 0 || ry >= right.height)
          continue;
        const auto from =
            4 * (static_cast<std::ptrdiff_t>(ry) * right.width + static_cast<std::ptrdiff_t>(rx));
        std::copy_n(right.pixels.begin() + from, 4,
                    resampled.pixels.begin() + 4 * (static_cast<std::ptrdiff_t>(y) * width + x));
      }
    }
    add(all, comparePart(reduced(resampled, kFiner), reduced(one, kFiner), 0, 0));
  }
  print("right tiles on the left ones' planes, both drawn 8 times as fine", all);
  EXPECT_LE(all.share(), kMostOff);
  EXPECT_EQ(all.off_in_surfaces, 0);
}

std::string nameOfCase(const testing::TestParamInfo<room::RoomPreset>& info) {
  return nameOf(info.param);
}
INSTANTIATE_TEST_SUITE_P(Rooms, PresetPictures,
                         testing::Values(room::RoomPreset::kFlat, room::RoomPreset::kThree160,
                                         room::RoomPreset::kThree120, room::RoomPreset::kSix,
                                         room::RoomPreset::kHexagon, room::RoomPreset::kArc160,
                                         room::RoomPreset::kArc120),
                         nameOfCase);

// If all panels are in one plane, all tiles together equal one rendering.
TEST(CoplanarPictures, AreTogetherOneRendering) {
  Painter painter;
  for (const room::RoomPreset preset : {room::RoomPreset::kFlat, room::RoomPreset::kSix}) {
    const tiles::TilesSettings wall = wallOf(preset);
    const std::vector<Image> tiles = painter.draw(wall);
    const bool six = preset == room::RoomPreset::kSix;
    // The presets list tiles in rows from the top, each row from the left.
    const Rectangle lower_left(wall.tiles[six ? 3 : 0]);
    const int rows = six ? 2 : 1;
    const Image one =
        painter.draw(oneTile(lower_left.part(0, 0, 3, rows), 3 * kWidth, rows * kHeight))[0];
    Count all;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const int column = static_cast<int>(i) % 3, row = static_cast<int>(i) / 3;
      add(all, comparePart(tiles[i], one, column * kWidth, row * kHeight));
    }
    EXPECT_LE(all.share(), kMostOff) << nameOf(preset);
    EXPECT_EQ(all.off_in_surfaces, 0);
    fmt::print(
        "{}: all tiles against one rendering of the wall: {} of {} pixels ({:.3f} %) differ "
        "by more than {} of 255\n",
        nameOf(preset), all.off, all.pixels, 100 * all.share(), kTolerance);
  }
}

// The pictures are 320 pixels wide; each shares 96 columns with its neighbour.
TEST(CoplanarPictures, ThatOverlapAreTogetherOneRendering) {
  Painter painter;
  room::RoomSettings room;
  room.preset.name = room::RoomPreset::kFlat;
  room.preset.overlap_m = 0.6;
  room.preset.width = kWidth;
  room.preset.height = kHeight;
  room.operator_width = room.operator_height = 0;
  const tiles::TilesSettings wall = *room::roomTiles(room, {});
  const std::vector<Image> tiles = painter.draw(wall);
  const Rectangle first(wall.tiles[0]);
  const Image one = painter.draw(oneTile(first.part(0, 0, 2.4, 1), 768, kHeight))[0];
  Count all;
  for (int i = 0; i < 3; ++i)
    add(all, comparePart(tiles[static_cast<std::size_t>(i)], one, 224 * i, 0));
  EXPECT_LE(all.share(), kMostOff);
  EXPECT_EQ(all.off_in_surfaces, 0);
}

}  // namespace
}  // namespace merlin::render
