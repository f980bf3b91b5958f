// Corrections by a shader, with EGL and with OSMesa: the picture has to equal that of the CPU.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/correct/gpu/shader_pass.h"
#include "render/correct/output_correction.h"
#include "render/gl/gl_context.h"
#include "tests/support/corrections.h"

namespace merlin::render {
namespace {

using correct::CorrectionMap;
using correct::CorrectionSettings;
using test::kHeight;
using test::kWidth;
using test::noise;

CorrectionMap mapOf(const CorrectionSettings& s, int width = kWidth, int height = kHeight,
                    const correct::MeasuredCorrection* measured = nullptr) {
  return correct::makeCorrectionMap(s, width, height, measured, 1);
}

std::vector<std::uint8_t> signalOf(correct::OutputCorrection& correction,
                                   const std::vector<std::uint8_t>& picture) {
  const CorrectionMap& map = correction.map();
  const out::Signal signal = correction.apply({map.source_width, map.source_height, picture});
  return {signal.pixels.begin(), signal.pixels.end()};
}

// The difference between two pictures.
struct Difference {
  int largest = 0;   // of 255
  double share = 0;  // share of the channels that differ at all
};

Difference differenceOf(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  Difference d;
  EXPECT_EQ(a.size(), b.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    d.largest = std::max(d.largest, std::abs(int{a[i]} - int{b[i]}));
    if (a[i] != b[i]) ++differing;
  }
  d.share = static_cast<double>(differing) / static_cast<double>(a.size());
  return d;
}

class ShaderOf : public ::testing::TestWithParam<gl::GlBackend> {
 protected:
  void SetUp() override {
    auto made = gl::makeGlContext(GetParam());
    ASSERT_TRUE(made) << made.error().what;
    context_ = *std::move(made);
    const auto begun = pass_.begin(*context_);
    ASSERT_TRUE(begun) << begun.error().what;
  }
  void TearDown() override { pass_.end(); }

  void expectTheCpusPicture(const std::string& name, const CorrectionMap& map) {
    const auto picture = noise(map.source_width, map.source_height);
    correct::OutputCorrection cpu(map, 1), gpu(map, 1, &pass_);
    // Asserts that the pass runs, so that a pass that refuses is not taken for one that agrees.
    auto shared = std::make_shared<const CorrectionMap>(map);
    std::vector<std::uint8_t> there(static_cast<std::size_t>(4 * map.width * map.height));
    ASSERT_TRUE(pass_.run(shared, picture, there)) << name << ": " << pass_.fault();
    const auto expected = signalOf(cpu, picture);
    EXPECT_EQ(signalOf(gpu, picture), there) << name;
    const Difference d = differenceOf(there, expected);
    EXPECT_LE(d.largest, 1) << name;
    RecordProperty(name, fmt::format("{} of 255, {:.2f} % of channels", d.largest, 100 * d.share));
    fmt::print("{:12} {} of 255 at most; {:.2f} % of the channels differ\n", name, d.largest,
               100 * d.share);
  }

  std::unique_ptr<gl::GlContext> context_;
  correct::ShaderPass pass_;
};

TEST_P(ShaderOf, EachCorrectionIsTheCpusWithin1Of255) {
  CorrectionSettings pin, blend, matrix, channels, steep, black;
  pin.corners = {12.3, 7, -20, 3.6, 5, -9, -2, -30};
  blend.blend = {100, 0, 0, 60, 2.2};
  matrix.colour.matrix = {0.9, 0.1, 0, 0.05, 1, -0.05, 0, 0.1, 0.85};
  channels.colour.gain = {1, 0.5, 1.2};
  channels.colour.gamma = {0.5, 1, 2};
  steep.blend.gamma = 4;
  steep.colour.gamma = {4, 0.25, 1.5};
  black.blend = {50, 50, 50, 50, 1.8};
  black.black.level = {0.5, 0, 0.001};
  const auto mesh = test::bent(correct::MeshInterpolation::kBicubic);
  const std::pair<const char*, CorrectionSettings> all[] = {
      {"pin", pin},           {"mesh", mesh},
      {"blend", blend},       {"matrix", matrix},
      {"channels", channels}, {"steep", steep},
      {"black", black},       {"everything", test::everything()}};
  for (const auto& [name, settings] : all) {
    ASSERT_TRUE(validate(settings, kWidth, kHeight).empty()) << name;
    expectTheCpusPicture(name, mapOf(settings));
  }
}

// The alpha and beta maps of an MPCDI file have no headroom rule.
TEST_P(ShaderOf, AMeasuredCorrectionIsTheCpusWithin1Of255) {
  correct::MeasuredCorrection measured;
  measured.warp = {2, 2, {{0.05, 0.02}, {0.97, 0}, {0, 1}, {1, 0.95}}};
  measured.alpha = correct::MeasuredShares{3, 2, {1, 0.5F, 0, 0.25F, 1, 0.75F}};
  measured.beta = correct::MeasuredShares{2, 2, {0, 0.2F, 1, 0.4F}};
  measured.beta_level = {0.1, 0.2, 0.05};
  expectTheCpusPicture("measured", mapOf({}, kWidth, kHeight, &measured));
}

TEST_P(ShaderOf, WhatIsOnlyMovedKeepsEveryBit) {
  CorrectionSettings s;
  s.corners = {3, 2, 3, 2, 3, 2, 3, 2};
  s.blend.left = 16;
  const CorrectionMap map = mapOf(s);
  const auto picture = noise(kWidth, kHeight);
  correct::OutputCorrection correction(map, 1, &pass_);
  const auto signal = signalOf(correction, picture);
  for (int y = 2; y < kHeight; ++y) {
    for (int x = 32; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * kWidth + x));
      ASSERT_TRUE(std::equal(&signal[at], &signal[at + 3], &picture[at - 4 * (2 * kWidth + 3)]))
          << x << " " << y;
      ASSERT_EQ(signal[at + 3], 255);
    }
  }
}

TEST_P(ShaderOf, AWidthThatIsNoMultipleOfEightIsWhole) {
  CorrectionSettings s;
  s.blend = {5, 3, 0, 2, 2};
  expectTheCpusPicture("13 x 5", mapOf(s, 13, 5));
}

// Outputs of different sizes in turn, as in each frame of a wall; then one of them gets another
// correction.
TEST_P(ShaderOf, ServesSeveralOutputsAndMapsThatAreReplaced) {
  CorrectionSettings s;
  s.corners[0] = 7;
  const CorrectionMap small = mapOf(s, 64, 48);
  const auto picture = noise(kWidth, kHeight), small_picture = noise(64, 48);
  correct::OutputCorrection one(mapOf(test::everything()), 1, &pass_), two(small, 1, &pass_);
  const auto first = signalOf(one, picture), second = signalOf(two, small_picture);
  EXPECT_EQ(signalOf(one, picture), first);
  EXPECT_EQ(signalOf(two, small_picture), second);
  for (int k = 0; k < 3; ++k) {
    s.corners[0] += 5;
    two = correct::OutputCorrection(mapOf(s, 64, 48), 1, &pass_);
    EXPECT_NE(signalOf(two, small_picture), second);
  }
  EXPECT_EQ(signalOf(one, picture), first);
}

TEST_P(ShaderOf, WhatItCannotDoTheCpuDoes) {
  GLint most = 0;
  context_->gl().GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  CorrectionSettings s;
  s.blend.left = 4;
  const CorrectionMap map = mapOf(s, most + 8, 2);
  const auto picture = noise(most + 8, 2);
  correct::OutputCorrection cpu(map, 1), asked(map, 1, &pass_);
  EXPECT_TRUE(pass_.fault().empty());
  for (int frame = 0; frame < 2; ++frame)
    EXPECT_EQ(signalOf(asked, picture), signalOf(cpu, picture));
  EXPECT_NE(pass_.fault().find(std::to_string(most + 8)), std::string::npos) << pass_.fault();
}

TEST_P(ShaderOf, IsOffBeforeAndAfter) {
  pass_.end();
  const auto map = std::make_shared<const CorrectionMap>(mapOf(test::everything()));
  const auto picture = noise(kWidth, kHeight);
  std::vector<std::uint8_t> signal(picture.size(), 7);
  EXPECT_FALSE(pass_.run(map, picture, signal));
  EXPECT_TRUE(std::ranges::all_of(signal, [](std::uint8_t p) { return p == 7; }));
  ASSERT_TRUE(pass_.begin(*context_));
  EXPECT_TRUE(pass_.run(map, picture, signal));
}

INSTANTIATE_TEST_SUITE_P(Backends, ShaderOf,
                         ::testing::Values(gl::GlBackend::kEgl, gl::GlBackend::kOsmesa),
                         [](const auto& backend) {
                           return backend.param == gl::GlBackend::kEgl ? "Egl" : "Osmesa";
                         });

}  // namespace
}  // namespace merlin::render
