// An output's correction: its geometry, its light, and the resulting pixels.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/thread_team.h"
#include "render/correct/blend.h"
#include "render/correct/output_correction.h"
#include "render/frame/correction_chain.h"
#include "render/frame/tile_arrangement.h"
#include "render/out/settings.h"
#include "tests/support/corrections.h"

namespace merlin::render {
namespace {

using test::bent;
using test::everything;
using test::grey;
using test::kHeight;
using test::kWidth;
using test::noise;

std::vector<std::uint8_t> corrected(const correct::CorrectionSettings& s,
                                    const std::vector<std::uint8_t>& picture) {
  correct::OutputCorrection correction(correct::makeCorrectionMap(s, kWidth, kHeight, nullptr, 1),
                                       1);
  const out::Signal signal = correction.apply({kWidth, kHeight, picture});
  return {signal.pixels.begin(), signal.pixels.end()};
}

// Returns a part of an RGBA picture whose rows have `width` pixels.
std::vector<std::uint8_t> partOf(const std::vector<std::uint8_t>& picture, int width,
                                 const out::Rectangle& part) {
  std::vector<std::uint8_t> pixels;
  for (int y = part.y; y < part.y + part.height; ++y) {
    const auto first = picture.begin() + 4 * (std::ptrdiff_t{y} * width + part.x);
    pixels.insert(pixels.end(), first, first + 4 * std::ptrdiff_t{part.width});
  }
  return pixels;
}

// Computes the formula of correction_map.h in double precision; the result, 0..255, is not yet
// rounded.
std::array<double, 3> byFormula(const correct::CorrectionMap& map,
                                const std::vector<std::uint8_t>& picture, int x, int y) {
  const auto entry = static_cast<std::size_t>(y * map.stride + x);
  const double at_x = map.source_x[entry] / 256.0, at_y = map.source_y[entry] / 256.0;
  const double a = std::pow(map.gain[entry] / 65535.0, 2), s = map.black[entry] / 65535.0;
  std::array<double, 3> light{}, signal{};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        const int column = static_cast<int>(at_x) + i, row = static_cast<int>(at_y) + j;
        const double weight =
            std::max(0.0, 1 - std::abs(at_x - column)) * std::max(0.0, 1 - std::abs(at_y - row));
        if (weight > 0)
          sum +=
              weight * picture[static_cast<std::size_t>(4 * (row * map.source_width + column)) + c];
      }
    }
    light[c] = std::pow(sum / 255, static_cast<double>(map.light.gamma));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    double l = 0;
    for (std::size_t k = 0; k < 3; ++k)
      l += static_cast<double>(map.light.matrix[3 * c + k]) * light[k];
    l = std::min(1.0, std::max(0.0, l) * static_cast<double>(map.light.gain[c]));
    const double black = s * static_cast<double>(map.light.black[c]);
    const double headroom = std::max(s, static_cast<double>(map.light.least_headroom));
    l = l * a * (1 - headroom * static_cast<double>(map.light.black[c])) + black;
    signal[c] = 255 * std::pow(std::min(1.0, l), static_cast<double>(map.light.encode[c]));
  }
  return signal;
}

// --- geometry ------------------------------------------------------------------------------------

void expectEachPixelLooksWhereItIsLandedFrom(const correct::CorrectionSettings& s) {
  const correct::Warp warp(s, kWidth, kHeight);
  const auto places = warp.places(1);
  int looked = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const correct::Place p = places[static_cast<std::size_t>(y * kWidth + x)];
      if (std::isnan(p.u)) continue;
      ++looked;
      const auto lands = warp.land({static_cast<double>(p.u), static_cast<double>(p.v)});
      ASSERT_TRUE(lands);
      ASSERT_NEAR(lands->x, x + 0.5, 0.001) << x << " " << y;
      ASSERT_NEAR(lands->y, y + 0.5, 0.001) << x << " " << y;
    }
  }
  EXPECT_GT(looked, kWidth * kHeight / 2);
  // Every pixel inside the warped image must have a source.
  for (int j = 0; j <= 100; ++j) {
    for (int i = 0; i <= 100; ++i) {
      const correct::Point at = *warp.land({i / 100.0, j / 100.0});
      const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
      if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
      EXPECT_FALSE(std::isnan(places[static_cast<std::size_t>(y * kWidth + x)].u)) << x << " " << y;
    }
  }
}

TEST(Correct, EachPixelLooksWhereItIsLandedFrom) {
  correct::CorrectionSettings pinned;
  pinned.corners = {30, 7, -20, 13, 5, -9, -50, -30};
  expectEachPixelLooksWhereItIsLandedFrom(pinned);
  expectEachPixelLooksWhereItIsLandedFrom(bent(correct::MeshInterpolation::kBicubic));
  expectEachPixelLooksWhereItIsLandedFrom(bent(correct::MeshInterpolation::kBilinear));
  expectEachPixelLooksWhereItIsLandedFrom(bent(correct::MeshInterpolation::kBicubic, 2, 2));
  expectEachPixelLooksWhereItIsLandedFrom(bent(correct::MeshInterpolation::kBicubic, 64, 64));
}

TEST(Correct, ThePictureStandsOnItsFourCorners) {
  correct::CorrectionSettings s;
  s.corners = {30, 7, -20, 13, 5, -9, -50, -30};
  const correct::Warp warp(s, kWidth, kHeight);
  const auto expect = [&](double u, double v, double x, double y) {
    const correct::Point at = *warp.land({u, v});
    EXPECT_NEAR(at.x, x, 1e-9);
    EXPECT_NEAR(at.y, y, 1e-9);
  };
  expect(0, 0, 30, 7);
  expect(1, 0, kWidth - 20, 13);
  expect(0, 1, 5, kHeight - 9);
  expect(1, 1, kWidth - 50, kHeight - 30);
}

TEST(Correct, TheMeshGoesThroughItsPoints) {
  for (const auto between :
       {correct::MeshInterpolation::kBicubic, correct::MeshInterpolation::kBilinear}) {
    correct::CorrectionSettings s = bent(between);
    s.corners = {};
    const correct::Warp warp(s, kWidth, kHeight);
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 5; ++i) {
        const correct::Point at = *warp.land({i / 4.0, j / 3.0});
        const correct::MeshPoint p = s.mesh.points[static_cast<std::size_t>(5 * j + i)];
        EXPECT_NEAR(at.x, p.x * kWidth, 1e-9);
        EXPECT_NEAR(at.y, p.y * kHeight, 1e-9);
      }
    }
  }
}

// A mesh whose points lie on a sine curve: bicubic interpolation follows the curve closely,
// bilinear does not.
TEST(Correct, ASmoothMeshFollowsACurveBetweenItsPoints) {
  const auto error = [](correct::MeshInterpolation between) {
    correct::CorrectionSettings s;
    s.mesh.columns = 9;
    s.mesh.rows = 2;
    s.mesh.interpolation = between;
    const auto curve = [](double u) { return 0.1 * std::sin(3 * u); };
    for (const double v : {0.0, 0.7}) {
      for (int i = 0; i < 9; ++i) s.mesh.points.push_back({i / 8.0, v + curve(i / 8.0)});
    }
    const correct::Warp warp(s, kWidth, kHeight);
    double worst = 0;
    for (double u = 0.125; u < 0.875; u += 0.01)
      worst = std::max(worst, std::abs(warp.land({u, 0})->y - kHeight * curve(u)));
    return worst;
  };
  EXPECT_LT(error(correct::MeshInterpolation::kBicubic), 0.02);
  EXPECT_GT(error(correct::MeshInterpolation::kBilinear), 0.2);
}

TEST(Correct, AMapIsTheSameForAnyNumberOfThreads) {
  ThreadTeam team;
  const correct::CorrectionMap one =
      correct::makeCorrectionMap(everything(), kWidth, kHeight, nullptr, 1);
  const correct::CorrectionMap three =
      correct::makeCorrectionMap(everything(), kWidth, kHeight, nullptr, Threads(3, team));
  EXPECT_EQ(one.source_x, three.source_x);
  EXPECT_EQ(one.source_y, three.source_y);
  EXPECT_EQ(one.gain, three.gain);
  EXPECT_EQ(one.black, three.black);
}

// --- pixels --------------------------------------------------------------------------------------

TEST(Correct, WhatNothingChangesKeepsEveryBit) {
  correct::CorrectionSettings s;
  s.blend.left = 32;
  const auto picture = noise(kWidth, kHeight);
  const auto signal = corrected(s, picture);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 40; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * kWidth + x));
      ASSERT_EQ(std::memcmp(&signal[at], &picture[at], 3), 0) << x << " " << y;
      ASSERT_EQ(signal[at + 3], 255);
    }
  }
}

TEST(Correct, WholePixelsThatAreMovedKeepEveryBit) {
  correct::CorrectionSettings s;
  s.corners = {3, 2, 3, 2, 3, 2, 3, 2};
  const auto picture = noise(kWidth, kHeight);
  const auto signal = corrected(s, picture);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * kWidth + x));
      if (x < 3 || y < 2)
        ASSERT_EQ(signal[at] + signal[at + 1] + signal[at + 2], 0) << x << " " << y;
      else
        ASSERT_EQ(std::memcmp(&signal[at], &picture[at - 4 * (2 * kWidth + 3)], 3), 0) << x;
    }
  }
}

void expectTheFormula(const correct::CorrectionSettings& s) {
  const auto picture = noise(kWidth, kHeight);
  const correct::CorrectionMap map = correct::makeCorrectionMap(s, kWidth, kHeight, nullptr, 1);
  const auto signal = corrected(s, picture);
  int counted = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto expected = byFormula(map, picture, x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const double is = signal[static_cast<std::size_t>(4 * (y * kWidth + x)) + c];
        ASSERT_NEAR(is, expected[c], 0.56) << x << " " << y << " channel " << c;
        counted += is > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(counted, kWidth * kHeight);
}

TEST(Correct, EveryPixelIsThatOfTheFormula) {
  correct::CorrectionSettings blend, colour, black;
  blend.blend = {100, 0, 0, 60, 2.2};
  colour.colour.gamma = {0.5, 1, 2};
  black.blend = {50, 50, 50, 50, 1.8};
  black.black.level = {0.5, 0, 0.001};
  for (const auto& s :
       {blend, colour, black, bent(correct::MeshInterpolation::kBilinear), everything()})
    expectTheFormula(s);
}

TEST(Correct, EveryProcessorMakesTheSameBits) {
  const correct::CorrectionMap map =
      correct::makeCorrectionMap(everything(), kWidth, kHeight, nullptr, 1);
  const auto picture = noise(kWidth, kHeight);
  auto one = grey(kWidth, kHeight, 1), other = grey(kWidth, kHeight, 2);
  correct::portableRowCorrector()(map, picture.data(), one.data(), 0, kHeight);
  correct::rowCorrector()(map, picture.data(), other.data(), 0, kHeight);
  EXPECT_EQ(one, other);
}

// The last pixels of a row are fewer than eight; nothing may be written beyond the last row.
TEST(Correct, AWidthThatIsNoMultipleOfEightIsWhole) {
  correct::CorrectionSettings s;
  s.blend = {5, 3, 0, 2, 2};
  const int width = 13, height = 5;
  const correct::CorrectionMap map = correct::makeCorrectionMap(s, width, height, nullptr, 1);
  EXPECT_EQ(map.stride, 16);
  const auto picture = noise(width, height);
  auto signal = grey(width, height + 1, 7);
  correct::rowCorrector()(map, picture.data(), signal.data(), 0, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(signal[static_cast<std::size_t>(4 * (y * width + x)) + c],
                    byFormula(map, picture, x, y)[c], 0.56);
      }
    }
  }
  for (std::size_t i = 4 * width * height; i < signal.size(); ++i) ASSERT_EQ(signal[i], 7);
}

TEST(Correct, ThePicturesBorderIsSmooth) {
  correct::CorrectionSettings s;
  s.corners = {20.25, 0, 0, 0, 20.25, 0, 0, 0};
  const auto signal = corrected(s, grey(kWidth, kHeight, 255));
  const auto light = [&](int x) {
    return std::pow(signal[static_cast<std::size_t>(4 * (100 * kWidth + x))] / 255.0, 2.2);
  };
  EXPECT_EQ(light(18), 0);
  EXPECT_NEAR(light(19) + light(20), 0.75, 0.05) << "pixel 20 is covered by 0.75 of its area";
  EXPECT_EQ(light(22), 1);
}

// --- light ---------------------------------------------------------------------------------------

TEST(Correct, TwoNeighboursRampsSumToOne) {
  EXPECT_EQ(correct::ramp(0), 0);
  EXPECT_EQ(correct::ramp(1), 1);
  for (double t = 0; t <= 1; t += 0.01)
    EXPECT_NEAR(correct::ramp(t) + correct::ramp(1 - t), 1, 1e-12);
}

// Two projectors share an image and overlap by 80 pixels; each emits some light even for a black
// signal.
TEST(Correct, LightAndBlackOfTwoProjectorsAreEvenOverTheSeam) {
  constexpr double kGamma = 2.4, kLeak = 0.02;
  constexpr int kOverlap = 80;
  correct::CorrectionSettings left, right;
  left.blend = {0, kOverlap, 0, 0, kGamma};
  right.blend = {kOverlap, 0, 0, 0, kGamma};
  // The light of a projector is leak + (1 - leak) * signal ^ gamma.
  left.black.level.fill(kLeak / (1 - kLeak));
  right.black.level = left.black.level;
  for (const int level : {0, 40, 128, 255}) {
    const auto picture = grey(kWidth, kHeight, static_cast<std::uint8_t>(level));
    const auto a = corrected(left, picture), b = corrected(right, picture);
    std::vector<double> light(2 * kWidth - kOverlap);
    for (std::size_t x = 0; x < kWidth; ++x) {
      const auto thrown = [&](const std::vector<std::uint8_t>& signal) {
        return kLeak + (1 - kLeak) * std::pow(signal[4 * (100 * kWidth + x)] / 255.0, kGamma);
      };
      light[x] += thrown(a);
      light[x + kWidth - kOverlap] += thrown(b);
    }
    // With 8 bits, one step of the signal is up to 1 % of the light.
    const auto [least, most] = std::minmax_element(light.begin(), light.end());
    EXPECT_LT((*most - *least) / *most, level > 100 ? 0.02 : 0.06) << level;
    EXPECT_NEAR(*most, 2 * kLeak + (1 - 2 * kLeak) * std::pow(level / 255.0, kGamma), 0.02);
  }
}

TEST(Correct, BlackIsLiftedByWhatLacksToTheMostProjectors) {
  const correct::BlendSettings both{20, 20, 10, 10, 2.2};
  EXPECT_EQ(correct::blackShare(both, 100, 50, 200, 100), 1) << "one projector of four";
  EXPECT_NEAR(correct::blackShare(both, 5, 50, 200, 100), 2.0 / 3, 1e-12) << "two";
  EXPECT_EQ(correct::blackShare(both, 5, 5, 200, 100), 0) << "four";
  const correct::BlendSettings side{20, 0, 0, 0, 2.2};
  EXPECT_EQ(correct::blackShare(side, 25, 50, 200, 100), 1);
  EXPECT_EQ(correct::blackShare(side, 15, 50, 200, 100), 0);
}

// At the end of a ramp this wide, the gain rounds to 1 and the black share to 0. Such pixels still
// need the same processing as those beside them, since the black level is raised.
TEST(Correct, EveryPixelOfALiftedPictureGoesThroughTheLight) {
  correct::CorrectionSettings s;
  s.blend.left = 4000;
  s.black.level.fill(0.1);
  const correct::CorrectionMap map = correct::makeCorrectionMap(s, 4096, 2, nullptr, 1);
  EXPECT_EQ(std::ranges::count(map.runs, correct::RunKind::kGeometry), 0);
}

TEST(Correct, ColourIsMixedInLightAndEncodedForEachChannelsGamma) {
  correct::CorrectionSettings s;
  s.colour.matrix = {0, 1, 0, 1, 0, 0, 0, 0, 1};  // swaps red and green
  s.colour.gain = {1, 0.5, 1};
  s.colour.gamma = {1, 1, 2};
  std::vector<std::uint8_t> picture = grey(kWidth, kHeight, 255);
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    picture[i] = 200;
    picture[i + 1] = 100;
    picture[i + 2] = 64;
  }
  const auto signal = corrected(s, picture);
  EXPECT_EQ(signal[0], 100);
  EXPECT_EQ(signal[1], std::lround(200 * std::pow(0.5, 1 / 2.2)));
  EXPECT_EQ(signal[2], std::lround(255 * std::sqrt(64 / 255.0)));
}

// --- in the wall ---------------------------------------------------------------------------------

TEST(Correct, AChainCorrectsThePictureThatTheTilesMake) {
  tiles::TilesSettings settings;
  settings.tile_width = kWidth;
  settings.tile_height = kHeight;
  settings.frame_width = 2 * kWidth;
  settings.frame_height = kHeight;
  settings.tiles = {{"a", tiles::TileKind::kWall, 0, 0, 0},
                    {"b", tiles::TileKind::kWall, kWidth, 0, -1}};
  const tiles::TilePlan plan = *tiles::planTiles(settings);
  const auto canvas = noise(2 * kWidth, kHeight);
  const std::vector<out::PlacedTile> tiles = {{"b", 0, 0, out::Mirror::kHorizontal}};
  frame::TileArrangement arranged(plan, tiles);
  const out::Signal meant = arranged.apply({2 * kWidth, kHeight, canvas});
  const auto expected = corrected(everything(), {meant.pixels.begin(), meant.pixels.end()});

  std::vector<std::unique_ptr<frame::Correction>> links;
  links.push_back(std::make_unique<frame::TileArrangement>(plan, tiles));
  links.push_back(std::make_unique<correct::OutputCorrection>(
      correct::makeCorrectionMap(everything(), kWidth, kHeight, nullptr, 1), 1));
  frame::CorrectionChain chain(std::move(links));
  const out::Signal signal = chain.apply({2 * kWidth, kHeight, canvas});
  EXPECT_EQ(signal.width, kWidth);
  EXPECT_TRUE(std::ranges::equal(signal.pixels, expected));
}

// A signal contains the pictures of both eyes: each must be corrected like the picture of an output
// of its own.
TEST(CorrectionMap, EachPartOfASignalHasTheWholeCorrection) {
  const std::vector<std::uint8_t> picture = noise(kWidth, kHeight);
  for (const correct::SignalParts parts : {correct::SignalParts{2, 1}, {1, 2}}) {
    const int width = kWidth / parts.columns, height = kHeight / parts.rows;
    correct::OutputCorrection both(
        correct::makeCorrectionMap(everything(), kWidth, kHeight, nullptr, 1, parts), 1);
    const auto whole = both.apply({kWidth, kHeight, picture}).pixels;
    const std::vector<std::uint8_t> signal(whole.begin(), whole.end());
    correct::CorrectionSettings squeezed = everything();
    for (std::size_t k = 0; k < 8; ++k)
      squeezed.corners[k] /= k % 2 == 0 ? parts.columns : parts.rows;
    squeezed.blend.left /= parts.columns, squeezed.blend.right /= parts.columns;
    squeezed.blend.top /= parts.rows, squeezed.blend.bottom /= parts.rows;
    correct::OutputCorrection alone(correct::makeCorrectionMap(squeezed, width, height, nullptr, 1),
                                    1);
    for (const int part : {0, 1}) {
      const out::Rectangle at{part * (kWidth - width), part * (kHeight - height), width, height};
      const auto expected = alone.apply({width, height, partOf(picture, kWidth, at)}).pixels;
      EXPECT_TRUE(std::ranges::equal(partOf(signal, kWidth, at), expected))
          << parts.columns << " x " << parts.rows << ", part " << part;
    }
  }
}

}  // namespace
}  // namespace merlin::render
