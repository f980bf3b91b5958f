// Corrections by a shader, with EGL and with OSMesa: the shader's picture has to equal the CPU's.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
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

// How two pictures differ.
struct Difference {
  int largest = 0;   // of 255
  double share = 0;  // share of the channels that differ
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
    // Asserts that the pass runs; otherwise a pass that refuses, so that the CPU computes both
    // pictures, would seem to agree.
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

// Outputs of different sizes use the pass in turn, as in each frame of a wall; then one of them
// gets another correction.
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
  asked = correct::OutputCorrection(mapOf(s, kWidth, kHeight), 1, &pass_);
  signalOf(asked, noise(kWidth, kHeight));
  EXPECT_EQ(pass_.fault(), "") << "nobody holds the map that was refused";
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

// A context that lends ordinary memory of the renderer in place of a display's memory, since a
// software renderer without a card has no other. Imports by real drivers are tested in the virtual
// machine.
class LendingContext final : public gl::GlContext {
 public:
  explicit LendingContext(const gl::GlContext& real) {
    api_ = real.gl();
    info_ = real.info();
    forward = api_.DeleteRenderbuffers;
    api_.DeleteRenderbuffers = [](GLsizei count, const GLuint* which) {
      deleted.insert(which, which + count);
      forward(count, which);
    };
    deleted.clear();
    get_integers = api_.GetIntegerv;
    draw_arrays = api_.DrawArrays;
    draws_nothing_at_x = 0;
    api_.DrawArrays = [](GLenum kind, GLint first, GLsizei count) {
      GLint viewport[4] = {};
      get_integers(GL_VIEWPORT, viewport);
      if (draws_nothing_at_x == 0 || viewport[0] != draws_nothing_at_x)
        draw_arrays(kind, first, count);
    };
    reset_status = GL_NO_ERROR;
    api_.GetGraphicsResetStatus = []() -> GLenum {
      return std::exchange(reset_status, GL_NO_ERROR);  // a reset is reported once
    };
  }
  Result<std::unique_ptr<GlContext>> makeFurther() const override {
    return Error{Errc::kUnsupported, "one is enough"};
  }
  // Returns a target whose memory is filled with blue.
  Result<gl::RenderTarget> importTarget(const DmaBuf& buffer) const override {
    ++imports;
    if (refuses) return Error{Errc::kUnsupported, "another GPU's memory"};
    GLuint& name = names[&buffer];
    api_.GenRenderbuffers(1, &name);
    api_.BindRenderbuffer(GL_RENDERBUFFER, name);
    api_.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, buffer.width, buffer.height);
    auto target = gl::RenderTarget::makeOf(api_, name, buffer.width, buffer.height);
    if (!target) return target;
    target->bind();
    api_.ClearColor(0, 0, blue, 1);
    api_.Clear(GL_COLOR_BUFFER_BIT);
    return target;
  }
  // Returns the content of a buffer's memory.
  std::vector<std::uint8_t> pixels(const DmaBuf& buffer) const {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * buffer.width * buffer.height));
    GLuint frame = 0;
    api_.GenFramebuffers(1, &frame);
    api_.BindFramebuffer(GL_FRAMEBUFFER, frame);
    api_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                 names.at(&buffer));
    api_.PixelStorei(GL_PACK_ROW_LENGTH, 0);
    api_.ReadPixels(0, 0, buffer.width, buffer.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    api_.DeleteFramebuffers(1, &frame);
    return pixels;
  }

  bool refuses = false;
  float blue = 1;
  mutable int imports = 0;
  mutable std::map<const DmaBuf*, GLuint> names;  // names of the renderbuffers
  static inline std::set<GLuint> deleted;
  static inline GLenum reset_status = GL_NO_ERROR;
  static inline int draws_nothing_at_x = 0;  // column of signals that drawing skips

 private:
  static inline PFNGLDELETERENDERBUFFERSPROC forward = nullptr;
  static inline PFNGLGETINTEGERVPROC get_integers = nullptr;
  static inline PFNGLDRAWARRAYSPROC draw_arrays = nullptr;
};

class ShaderInto : public ShaderOf {
 protected:
  void SetUp() override {
    ShaderOf::SetUp();
    pass_.end();
    lending_ = std::make_unique<LendingContext>(*context_);
    ASSERT_TRUE(pass_.begin(*lending_));
  }
  static std::shared_ptr<const DmaBuf> memory(int width, int height) {
    auto buffer = std::make_shared<DmaBuf>();
    buffer->width = width;
    buffer->height = height;
    return buffer;
  }
  // Returns the part of the memory in which a signal was drawn. Expects that everything around it
  // is still blue.
  std::vector<std::uint8_t> partOf(const DmaBuf& buffer, int left, int top) {
    const auto all = lending_->pixels(buffer);
    std::vector<std::uint8_t> part;
    for (int y = 0; y < buffer.height; ++y) {
      for (int x = 0; x < buffer.width; ++x) {
        const auto* const pixel = &all[static_cast<std::size_t>(4 * (y * buffer.width + x))];
        const bool inside = x >= left && x < left + kWidth && y >= top && y < top + kHeight;
        if (inside)
          part.insert(part.end(), pixel, pixel + 4);
        else
          EXPECT_TRUE(pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 255) << x << " " << y;
      }
    }
    return part;
  }

  std::unique_ptr<LendingContext> lending_;
  const std::vector<std::uint8_t> picture_ = noise(kWidth, kHeight);
  const out::Signal source_{kWidth, kHeight, picture_};
};

TEST_P(ShaderInto, DrawsIntoEachPlaceWhatItWouldReturn) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  const auto expected = signalOf(correction, picture_);
  const out::DrawPlace places[] = {{memory(kWidth, kHeight), 0, 0},
                                   {memory(kWidth + 40, kHeight + 30), 17, 9}};
  ASSERT_TRUE(correction.canDraw());
  const out::Signal signal = correction.draw(source_, places);
  EXPECT_TRUE(signal.drawn);
  EXPECT_EQ(partOf(*places[0].buffer, 0, 0), expected);
  EXPECT_EQ(partOf(*places[1].buffer, 17, 9), expected);
  EXPECT_EQ(pass_.drawFault(), "");
}

// The picture is judged by these rows, which are read from the memory that the display shows.
TEST_P(ShaderInto, TheRowsThatAreReadBackMakeTheSignalsDigest) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  const auto digest = [](const std::vector<std::uint8_t>& pixels) {
    return out::digestOf({kWidth, kHeight, pixels, std::size_t{4} * kWidth});
  };
  const auto expected = digest(signalOf(correction, picture_));
  correction.apply({kWidth, kHeight, test::grey(kWidth, kHeight, 9)});
  const out::DrawPlace places[] = {{memory(kWidth + 40, kHeight + 30), 17, 9}};
  const out::Signal signal = correction.draw(source_, places);
  EXPECT_EQ(digest({signal.pixels.begin(), signal.pixels.end()}), expected);
}

TEST_P(ShaderInto, ImportsABufferOnceAndReleasesItWhenNobodyHasIt) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  std::vector<out::DrawPlace> ring;
  for (int i = 0; i < 3; ++i) ring.push_back({memory(kWidth, kHeight), 0, 0});
  for (std::size_t n = 0; n < 9; ++n)
    EXPECT_TRUE(correction.draw(source_, std::span(ring).subspan(n % 3, 1)).drawn);
  EXPECT_EQ(lending_->imports, 3);
  std::set<GLuint> old;
  for (const auto& [buffer, name] : lending_->names) old.insert(name);
  ring.assign(1, {memory(kWidth, kHeight), 0, 0});  // the display has another mode
  EXPECT_TRUE(correction.draw(source_, ring).drawn);
  EXPECT_EQ(lending_->imports, 4);
  EXPECT_TRUE(std::ranges::includes(LendingContext::deleted, old));
}

TEST_P(ShaderInto, ReleasesABufferAlsoIfAllSignalsAreCopiedFromThenOn) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  std::vector<out::DrawPlace> place(1, {memory(kWidth, kHeight), 0, 0});
  EXPECT_TRUE(correction.draw(source_, place).drawn);
  const GLuint name = lending_->names.begin()->second;
  place.clear();
  EXPECT_EQ(LendingContext::deleted.count(name), 0U);
  correction.apply(source_);
  EXPECT_EQ(LendingContext::deleted.count(name), 1U);
}

TEST_P(ShaderInto, WhatItCannotDrawIntoIsCopiedAndTheReasonTold) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  const auto expected = signalOf(correction, picture_);
  lending_->refuses = true;
  const out::DrawPlace places[] = {{memory(kWidth, kHeight), 0, 0}};
  for (int frame = 0; frame < 3; ++frame) {
    const out::Signal signal = correction.draw(source_, places);
    EXPECT_FALSE(signal.drawn);
    EXPECT_EQ(std::vector(signal.pixels.begin(), signal.pixels.end()), expected);
  }
  EXPECT_EQ(lending_->imports, 1) << "it is not tried again";
  EXPECT_EQ(pass_.drawFault(), "another GPU's memory");
  const out::DrawPlace unshared[] = {{nullptr, 0, 0}};
  EXPECT_FALSE(correction.draw(source_, unshared).drawn);
}

TEST_P(ShaderInto, AFaultIsToldAsLongAsTheDisplayHasTheMemoryThatWasRefused) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  std::vector<out::DrawPlace> first(1, {memory(kWidth, kHeight), 0, 0});
  const out::DrawPlace second[] = {{memory(kWidth, kHeight), 0, 0}};
  lending_->refuses = true;
  EXPECT_FALSE(correction.draw(source_, first).drawn);
  lending_->refuses = false;
  EXPECT_TRUE(correction.draw(source_, second).drawn);
  EXPECT_EQ(pass_.drawFault(), "another GPU's memory") << "the first display is still copied to";
  first.assign(1, {memory(kWidth, kHeight), 0, 0});
  EXPECT_TRUE(correction.draw(source_, first).drawn);
  EXPECT_EQ(pass_.drawFault(), "");

  lending_->refuses = true;
  first.assign(1, {memory(kWidth, kHeight), 0, 0});
  EXPECT_FALSE(correction.draw(source_, first).drawn);
  EXPECT_NE(pass_.drawFault(), "");
  pass_.end();
  EXPECT_EQ(pass_.drawFault(), "");
}

// The rows that are read back cannot reveal the fault, since they come from the wrong memory, too.
TEST_P(ShaderInto, AnotherPictureThanWasDrawnIsNotShown) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  const auto expected = signalOf(correction, picture_);
  const out::DrawPlace right = {memory(kWidth + 40, kHeight + 30), 16, 9};
  const out::DrawPlace wrong = {memory(kWidth + 40, kHeight + 30), 17, 9};
  LendingContext::draws_nothing_at_x = 17;
  EXPECT_TRUE(correction.draw(source_, {&right, 1}).drawn);
  const out::DrawPlace both[] = {right, wrong};
  for (int frame = 0; frame < 2; ++frame) {
    const out::Signal signal = correction.draw(source_, both);
    EXPECT_FALSE(signal.drawn);
    EXPECT_EQ(std::vector(signal.pixels.begin(), signal.pixels.end()), expected);
  }
  EXPECT_NE(pass_.drawFault().find("another picture"), std::string::npos);
  EXPECT_EQ(lending_->imports, 2) << "it is not tried again";
  EXPECT_TRUE(correction.draw(source_, {&right, 1}).drawn) << "the other display is right";
}

TEST_P(ShaderInto, ABlackPictureDoesNotProveThatTheDriverDraws) {
  CorrectionSettings s;
  s.corners[0] = 7;
  correct::OutputCorrection correction(mapOf(s), 1, &pass_);
  lending_->blue = 0;
  LendingContext::draws_nothing_at_x = 17;
  const out::DrawPlace places[] = {{memory(kWidth + 40, kHeight + 30), 17, 9}};
  const auto black = test::grey(kWidth, kHeight, 0);
  EXPECT_TRUE(correction.draw({kWidth, kHeight, black}, places).drawn);
  EXPECT_FALSE(correction.draw(source_, places).drawn);
}

// After a reset no call fails, but none has an effect: the memory keeps its content.
TEST_P(ShaderInto, AfterAResetOfTheGpuTheCpuComputesTheSignal) {
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  correct::OutputCorrection cpu(mapOf(test::everything()), 1);
  const auto expected = signalOf(cpu, picture_);
  const out::DrawPlace places[] = {{memory(kWidth, kHeight), 0, 0}};
  ASSERT_TRUE(correction.draw(source_, places).drawn);
  LendingContext::reset_status = GL_INNOCENT_CONTEXT_RESET;
  const out::Signal signal = correction.draw(source_, places);
  EXPECT_FALSE(signal.drawn);
  EXPECT_EQ(std::vector(signal.pixels.begin(), signal.pixels.end()), expected);
  const auto map = std::make_shared<const CorrectionMap>(mapOf(test::everything()));
  std::vector<std::uint8_t> there(picture_.size());
  EXPECT_FALSE(pass_.run(map, picture_, there));
  EXPECT_TRUE(lending_->wasReset()) << "the wall, which asks later, ends its process";
}

TEST_P(ShaderInto, NothingIsDrawnIntoADisplaysMemoryUnlessAllowed) {
  pass_.end();
  ASSERT_TRUE(pass_.begin(*lending_, false));
  correct::OutputCorrection correction(mapOf(test::everything()), 1, &pass_);
  EXPECT_FALSE(correction.canDraw());
  const out::DrawPlace places[] = {{memory(kWidth, kHeight), 0, 0}};
  EXPECT_FALSE(correction.draw(source_, places).drawn);
  EXPECT_EQ(lending_->imports, 0);
  EXPECT_EQ(pass_.drawFault(), "");
  correct::OutputCorrection on_cpu(mapOf(test::everything()), 1);
  EXPECT_FALSE(on_cpu.canDraw());
}

// Mesa's software renderer claims that it can draw into a display's memory, and would crash.
TEST_P(ShaderOf, ASoftwareContextTakesNoDisplaysMemory) {
  if (!context_->info().software) GTEST_SKIP() << "a GPU draws";
  const auto refused = context_->importTarget(DmaBuf{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kUnsupported);
  EXPECT_EQ(refused.error().what, GetParam() == gl::GlBackend::kEgl
                                      ? "the CPU draws, not the display's GPU"
                                      : "OSMesa draws only into memory of its own");
}

INSTANTIATE_TEST_SUITE_P(Backends, ShaderInto,
                         ::testing::Values(gl::GlBackend::kEgl, gl::GlBackend::kOsmesa),
                         [](const auto& backend) {
                           return backend.param == gl::GlBackend::kEgl ? "Egl" : "Osmesa";
                         });
INSTANTIATE_TEST_SUITE_P(Backends, ShaderOf,
                         ::testing::Values(gl::GlBackend::kEgl, gl::GlBackend::kOsmesa),
                         [](const auto& backend) {
                           return backend.param == gl::GlBackend::kEgl ? "Egl" : "Osmesa";
                         });

}  // namespace
}  // namespace merlin::render
