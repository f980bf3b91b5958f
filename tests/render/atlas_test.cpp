// Several textures joined into one (render/mesh/atlas). All pictures are synthetic.
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/mesh/atlas/charts.h"
#include "render/mesh/atlas/corner_coordinates.h"
#include "render/mesh/atlas/join_textures.h"
#include "render/mesh/atlas/pack.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {
namespace {

using image::ImageFile;
using image::Wrap;
using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

// Returns a picture of waves with the given phase, in which a shift by a few pixels changes the
// colours.
ImageFile waves(int width, int height, double phase) {
  ImageFile picture{width, height, {}, {1, 2, 3}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const double turn : {0.0, 1.0, 2.0})
        picture.pixels.push_back(static_cast<std::uint8_t>(
            127.5 + 120 * std::sin(phase + turn + 6.28318 * x / width + 12.56636 * y / height)));
    }
  }
  return picture;
}

ImageFile plain(int width, int height, const Colour& colour) {
  ImageFile picture{width, height, {}, {}};
  for (int i = 0; i < width * height; ++i)
    picture.pixels.insert(picture.pixels.end(), colour.begin(), colour.end());
  return picture;
}

// Returns triangles that share no vertices; `uv` has two numbers for each corner.
Mesh trianglesWith(const Floats& uv) {
  Mesh mesh;
  for (std::uint32_t v = 0; v < uv.size() / 2; ++v) {
    mesh.positions.insert(mesh.positions.end(),
                          {static_cast<float>(v), static_cast<float>(v % 3 == 2), 0});
    mesh.triangles.push_back(v);
  }
  mesh.features.push_back({"texcoord", 2, uv});
  return mesh;
}

std::array<float, 2> within(const Mesh& mesh, std::size_t triangle,
                            const std::array<float, 3>& weights) {
  std::array<float, 2> uv{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh.triangles[3 * triangle + k];
    for (std::size_t i = 0; i < 2; ++i)
      uv[i] += weights[k] * mesh.find("texcoord")->values[2 * std::size_t{v} + i];
  }
  return uv;
}

ImageFile textureOf(const Mesh& mesh) {
  auto picture = image::decodeImage(mesh.texture);
  EXPECT_TRUE(picture) << picture.error().what;
  return picture ? *std::move(picture) : ImageFile{};
}

// Expects that the triangles have the same colours everywhere, whether taken from the textures
// before or from the atlas.
void expectSameColours(const Mesh& before, const Mesh& after, const SurfaceTextures& textures,
                       float tolerance) {
  const ImageFile atlas = textureOf(after);
  ASSERT_GT(atlas.width, 0);
  ASSERT_EQ(before.triangleCount(), after.triangleCount());
  Random random(7);
  for (std::size_t t = 0; t < before.triangleCount(); ++t) {
    if (textures.of_triangle[t] == kNoTexture) continue;
    const SurfaceTexture& texture = textures.textures[textures.of_triangle[t]];
    for (int i = 0; i < 200; ++i) {
      const auto a = static_cast<float>(random.uniform());
      const auto b = static_cast<float>(random.uniform()) * (1 - a);
      const std::array<float, 3> weights = {a, b, 1 - a - b};
      const auto [u, v] = within(before, t, weights);
      const auto [s, r] = within(after, t, weights);
      const auto expected = texture.picture->at(u, v, texture.wrap_u, texture.wrap_v);
      const auto seen = atlas.at(s, r, Wrap::kRepeat, Wrap::kRepeat);
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(seen[k], expected[k], tolerance)
            << "triangle " << t << " at " << u << ", " << v;
    }
  }
}

TEST(Atlas, ShowsEachTriangleWhatItsPictureShows) {
  const ImageFile a = waves(40, 24, 0), b = waves(17, 33, 1), c = waves(8, 8, 2);
  const SurfaceTextures textures{{{&a},
                                  {&b, Wrap::kClamp, Wrap::kClamp},
                                  {&c},
                                  {&a, Wrap::kMirror, Wrap::kRepeat},
                                  {&b, Wrap::kRepeat, Wrap::kClamp}},
                                 {0, 1, 2, 3, 4, 0}};
  Mesh mesh = trianglesWith({0,    0,    1,    0,  0,    1,      // the whole of a
                             -0.5, -0.5, 1.5,  0,  0,    1.5,    // beyond a clamped border
                             7.25, -3,   8.5,  -3, 7.25, -1.5,   // repeated, far from the origin
                             -0.5, 0.5,  2.25, 1,  0.5,  3,      // mirrored
                             -1.5, -1,   0.5,  2,  0.25, 0.25,   // one of each kind
                             5.25, 9.75, 5.75, 9,  5.5,  9.5});  // a part of a
  const Mesh before = mesh;
  const JoinedTextures joined = joinTextures(mesh, textures);
  EXPECT_EQ(joined.pictures, 5u) << "a and b once for each way to wrap";
  EXPECT_EQ(joined.colours, 0u);
  EXPECT_EQ(joined.scale, 1);
  EXPECT_EQ(joined.split + joined.mean_coloured + joined.reduced, 0u);
  EXPECT_EQ(mesh.positions, before.positions);
  EXPECT_EQ(mesh.triangles, before.triangles);
  for (const float x : mesh.find("texcoord")->values) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 1);
  }
  expectSameColours(before, mesh, textures, 1.5F / 255);
  Mesh again = before;
  joinTextures(again, textures);
  EXPECT_EQ(again.texture, mesh.texture) << "the same bytes";
  EXPECT_EQ(again.find("texcoord")->values, mesh.find("texcoord")->values);
}

// Returns the image at half its size, each pixel the mean of 2 x 2 texels, as a graphics card makes
// its mipmaps.
ImageFile halved(const ImageFile& image) {
  ImageFile half{image.width / 2, image.height / 2, {}, {}};
  const auto at = [&](int x, int y, int k) {
    const std::size_t texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x);
    return int{image.pixels[3 * texel + static_cast<std::size_t>(k)]};
  };
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      for (int k = 0; k < 3; ++k)
        half.pixels.push_back(
            static_cast<std::uint8_t>((at(2 * x, 2 * y, k) + at(2 * x + 1, 2 * y, k) +
                                       at(2 * x, 2 * y + 1, k) + at(2 * x + 1, 2 * y + 1, k) + 2) /
                                      4));
    }
  }
  return half;
}

TEST(Atlas, MipmapsDownToAnEighthMixNoTwoPictures) {
  const Colour colours[] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  const ImageFile pictures[] = {plain(13, 21, colours[0]), plain(30, 9, colours[1]),
                                plain(16, 16, colours[2])};
  const SurfaceTextures textures{{{&pictures[0]}, {&pictures[1]}, {&pictures[2]}}, {0, 1, 2}};
  Mesh mesh = trianglesWith({0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 1, 0, 1, 0, 0});
  joinTextures(mesh, textures);
  ImageFile level = textureOf(mesh);
  EXPECT_EQ(level.width % kGutter + level.height % kGutter, 0);
  for (int n = 0; n <= 3; ++n, level = halved(level)) {
    for (std::size_t v = 0; v < 9; ++v) {
      const float* const uv = &mesh.find("texcoord")->values[2 * v];
      const auto seen = level.at(uv[0], uv[1], Wrap::kRepeat, Wrap::kRepeat);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(seen[k], static_cast<float>(colours[v / 3][k]) / 255, 1e-3)
            << "level " << n << ", corner " << v;
    }
  }
}

TEST(Atlas, KeepsTheFileOfTheOnlyPicture) {
  const ImageFile a = waves(8, 8, 0);
  Mesh mesh = trianglesWith({0, 0, 9, 0, 0, 9});
  const Floats uv = mesh.find("texcoord")->values;
  const JoinedTextures joined = joinTextures(mesh, {{{&a}, {&a}}, {1}});
  EXPECT_EQ(joined.pictures, 0u);
  EXPECT_TRUE(joined.notes().empty());
  EXPECT_EQ(mesh.texture, a.file);
  EXPECT_EQ(mesh.find("texcoord")->values, uv);
  Mesh none = trianglesWith({0, 0, 1, 0, 0, 1});
  EXPECT_TRUE(joinTextures(none, {{{&a}}, {kNoTexture}}).notes().empty());
  EXPECT_TRUE(none.texture.empty());
}

TEST(Atlas, NamesPicturesThatNoTriangleHas) {
  const ImageFile a = waves(8, 8, 0), b = waves(8, 8, 1), c = waves(8, 8, 2), unread;
  Mesh mesh = trianglesWith({0, 0, 9, 0, 0, 9});
  const JoinedTextures kept = joinTextures(mesh, {{{&a}, {&b}, {&unread}, {nullptr}}, {0}});
  EXPECT_EQ(mesh.texture, a.file);
  EXPECT_EQ(kept.notes(),
            std::vector<std::string>{"the texture that is on all triangles is kept as it is; "
                                     "1 texture is on no triangle and is left out"});
  Mesh two = trianglesWith({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const SurfaceTextures textures{{{&a}, {&b}, {&c}, {&a, Wrap::kClamp, Wrap::kClamp}}, {0, 2}};
  const auto notes = joinTextures(two, textures).notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[1], "1 texture is on no triangle and is left out") << "b; a is on one";
}

TEST(Atlas, GivesTrianglesWithoutAPictureTheirColour) {
  const ImageFile a = waves(8, 8, 0);
  Mesh mesh = trianglesWith({0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, NAN, 0, 0, 0});
  Feature colour{"colour", 3, Floats(27, 0.0F)};
  for (const std::size_t v : {3u, 4u, 5u}) colour.values[3 * v + 1] = 1;
  for (const std::size_t v : {6u, 7u, 8u}) colour.values[3 * v + 2] = 0.5F;
  mesh.features.push_back(colour);
  const JoinedTextures joined = joinTextures(mesh, {{{&a}}, {0, kNoTexture, 0}});
  EXPECT_EQ(joined.colours, 2u);
  const auto atlas = textureOf(mesh);
  for (const float x : mesh.find("texcoord")->values) ASSERT_TRUE(std::isfinite(x));
  const auto seen = [&](std::size_t t) {
    const auto [u, v] = within(mesh, t, {0.2F, 0.3F, 0.5F});
    return atlas.at(u, v, Wrap::kRepeat, Wrap::kRepeat);
  };
  EXPECT_EQ(seen(1), (std::array{0.0F, 1.0F, 0.0F}));
  EXPECT_NEAR(seen(2)[2], 0.5, 0.01) << "a coordinate is not a number: as without a picture";
  EXPECT_EQ(joined.notes(), std::vector<std::string>{fmt::format(
                                "1 texture and 2 plain colours became one of {} x {} pixels",
                                joined.width, joined.height)});
}

TEST(Atlas, RoundsColoursWhereThereAreTooMany) {
  const ImageFile a = waves(8, 8, 0);
  Mesh mesh = trianglesWith(Floats(6 * 3001, 0.0F));
  Feature colour{"colour", 3, {}};
  for (int v = 0; v < 3 * 3001; ++v) {
    const int t = v / 3;
    colour.values.insert(colour.values.end(), {static_cast<float>(t % 251) / 255,
                                               static_cast<float>(t % 13) / 255, 0.5F});
  }
  mesh.features.push_back(colour);
  SurfaceTextures textures{{{&a}}, std::vector<std::uint32_t>(3001, kNoTexture)};
  textures.of_triangle[0] = 0;
  const JoinedTextures joined = joinTextures(mesh, textures);
  EXPECT_LE(joined.colours, 1024u);
  EXPECT_GT(joined.colours, 100u);
  EXPECT_GT(joined.rounded_colours, 2000u);
  EXPECT_NE(joined.notes().at(1).find("in rounded colours"), std::string::npos);
}

TEST(Atlas, GivesTheMeanColourWhereAPictureIsRepeatedTooOften) {
  const ImageFile a = plain(4, 4, {10, 20, 30}), b = waves(8, 8, 1);
  Mesh mesh = trianglesWith({0, 0, 16, 0, 0, 1, 0, 0, 17, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const JoinedTextures joined = joinTextures(mesh, {{{&a}, {&b}}, {0, 0, 1}});
  EXPECT_EQ(joined.mean_coloured, 1u) << "17 times; 16 are baked";
  EXPECT_EQ(joined.colours, 1u);
  const auto [u, v] = within(mesh, 1, {0.3F, 0.3F, 0.4F});
  EXPECT_NEAR(textureOf(mesh).at(u, v, Wrap::kRepeat, Wrap::kRepeat)[1], 20.0F / 255, 1e-3);
  EXPECT_NE(joined.notes().at(1).find("1 triangle has the mean colour"), std::string::npos);
}

TEST(Atlas, MakesAllPicturesSmallerWhereTheyDoNotFit) {
  const ImageFile a = waves(300, 200, 0), b = waves(256, 256, 1);
  const SurfaceTextures textures{{{&a}, {&b}}, {0, 1}};
  Mesh mesh = trianglesWith({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const Mesh before = mesh;
  const JoinedTextures joined = joinTextures(mesh, textures, {.most_side = 256});
  EXPECT_LE(joined.width, 256);
  EXPECT_LE(joined.height, 256);
  EXPECT_LT(joined.scale, 1);
  EXPECT_GT(joined.scale, 0.3);
  EXPECT_NE(joined.notes()[0].find("; each was made smaller, to "), std::string::npos);
  expectSameColours(before, mesh, textures, 0.05F);
  Mesh hopeless = before;
  const JoinedTextures failed = joinTextures(hopeless, textures, {.most_side = 16});
  EXPECT_TRUE(failed.baked);
  EXPECT_EQ(failed.notes().size(), 1u);
  EXPECT_TRUE(hopeless.texture.empty());
  EXPECT_EQ(hopeless.find("texcoord")->values, before.find("texcoord")->values);

  const ImageFile other = waves(8, 8, 2);
  const SurfaceTextures more{{{&a}, {&b}, {&other}}, {0, 1}};
  const std::vector<std::string> notes = joinTextures(hopeless, more, {.most_side = 16}).notes();
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[1], "1 texture is on no triangle and is left out");
}

TEST(Atlas, MakesAPictureSmallerThatIsRepeatedOften) {
  const ImageFile a = waves(100, 100, 0), b = waves(64, 64, 1);
  const SurfaceTextures textures{{{&a}, {&b}}, {0, 1}};
  Mesh mesh = trianglesWith({0, 0, 8, 0, 0, 8, 0, 0, 1, 0, 0, 1});
  const Mesh before = mesh;
  const JoinedTextures joined = joinTextures(mesh, textures, {.most_chart_side = 400});
  EXPECT_EQ(joined.reduced, 1u);
  EXPECT_EQ(joined.scale, 1);
  EXPECT_LT(joined.width, 600);
  expectSameColours(before, mesh, textures, 0.06F);
}

// Returns two triangles of the vertices 0, 1, 2, 3; vertices 1 and 2 belong to both.
Mesh twoTriangles(const Floats& uv) {
  Mesh mesh{{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {{"texcoord", 2, uv}}, {0, 1, 2, 1, 3, 2}};
  mesh.features.push_back({"heat", 1, {1, 2, 3, 4}});
  return mesh;
}

TEST(Atlas, SplitsVerticesBetweenPicturesAndNowhereElse) {
  const ImageFile a = waves(8, 8, 0), b = waves(8, 8, 1);
  Mesh two = twoTriangles({0, 0, 1, 0, 0, 1, 1, 1});
  EXPECT_EQ(joinTextures(two, {{{&a}, {&b}}, {0, 1}}).split, 2u);
  EXPECT_EQ(two.triangles, (Indices{0, 1, 2, 4, 3, 5}));
  EXPECT_EQ(two.find("heat")->values, (Floats{1, 2, 3, 4, 2, 3}));
  EXPECT_EQ((Floats{two.positions.begin() + 12, two.positions.end()}), (Floats{1, 0, 0, 0, 1, 0}));
  Mesh one = twoTriangles({0.25F, 0, 1.5F, 0, 1.25F, 1, 3.5F, 1});
  EXPECT_EQ(joinTextures(one, {{{&a, Wrap::kRepeat, Wrap::kClamp}}, {0, 0}}).split, 0u)
      << "up to four repeats stay connected";
}

TEST(Atlas, MovesTrianglesOneByOneWhereTheyRepeatTogether) {
  const ImageFile a = waves(8, 8, 0);
  const SurfaceTextures textures{{{&a, Wrap::kRepeat, Wrap::kClamp}}, {0, 0}};
  Mesh mesh = twoTriangles({-20, 0, -12, 0, -13, 1, -4, 1});
  const Mesh before = mesh;
  const JoinedTextures joined = joinTextures(mesh, textures);
  EXPECT_EQ(joined.mean_coloured, 0u) << "8 and 9 repeats, 16 together";
  EXPECT_EQ(joined.split, 2u);
  expectSameColours(before, mesh, textures, 1.5F / 255);
}

TEST(Atlas, CornersOfAFileSplitVertices) {
  Mesh mesh = twoTriangles({});
  setCornerCoordinates(mesh, {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0.5F, 1}});
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 2, 1, 3, 4}));
  EXPECT_EQ(mesh.find("texcoord")->values, (Floats{0, 0, 1, 0, 0, 1, 1, 1, 0.5F, 1}));
  EXPECT_EQ(mesh.find("heat")->values, (Floats{1, 2, 3, 4, 3}));
  EXPECT_TRUE(validate(mesh));
}

TEST(AtlasPack, PlacesRectanglesBesideEachOther) {
  Random random(3);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<RectangleSize> sizes;
    for (int i = 0; i < 1 + 7 * trial; ++i)
      sizes.push_back(
          {1 + static_cast<int>(random.below(12)), 1 + static_cast<int>(random.below(20))});
    const auto packing = pack(sizes, 200);
    ASSERT_TRUE(packing);
    std::set<std::pair<int, int>> taken;
    std::size_t area = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const auto [x, y] = packing->places[i];
      EXPECT_LE(x + sizes[i].width, packing->size.width);
      EXPECT_LE(y + sizes[i].height, packing->size.height);
      for (int dx = 0; dx < sizes[i].width; ++dx) {
        for (int dy = 0; dy < sizes[i].height; ++dy) taken.emplace(x + dx, y + dy);
      }
      area += static_cast<std::size_t>(sizes[i].width * sizes[i].height);
    }
    EXPECT_EQ(taken.size(), area) << "two overlap, trial " << trial;
    EXPECT_LE(packing->size.width, 200);
    EXPECT_LE(packing->size.height, 200);
    const int whole = packing->size.width * packing->size.height;
    EXPECT_GT((trial > 10 ? 2 : 1000) * area, static_cast<std::size_t>(whole)) << trial;
  }
  EXPECT_FALSE(pack(std::vector<RectangleSize>(5, {5, 5}), 10)) << "four fit";
  EXPECT_TRUE(pack(std::vector<RectangleSize>(4, {5, 5}), 10));
  EXPECT_FALSE(pack(std::vector<RectangleSize>{{11, 1}}, 10));
}

}  // namespace
}  // namespace merlin::render::mesh
