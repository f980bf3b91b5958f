// On a machine with a GPU, the GPU must draw as the software renderer does, and correct as the CPU
// does. On other machines these tests are skipped. One command runs them: build/dev/bin/gpu_test
#include <future>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/dma_buf.h"
#include "render/correct/gpu/shader_pass.h"
#include "render/correct/output_correction.h"
#include "render/out/kms/drm_buffer.h"
#include "render/reduce/reduce.h"
#include "tests/support/corrections.h"
#include "tests/support/meshes.h"
#include "tests/support/model_frames.h"

namespace merlin::render {
namespace {

class GpuTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = frame::DrawContexts::make({});
    ASSERT_TRUE(made) << made.error().what;
    if ((*made)->own->info().software) {
      GTEST_SKIP() << "this machine has no GPU that EGL can use; " << (*made)->renderer()
                   << " would be compared with itself";
    }
    contexts_ = *std::move(made);
    fmt::print("GPU: {}, {}\n", contexts_->renderer(), contexts_->own->info().driver);
  }

  std::shared_ptr<const frame::DrawContexts> contexts_;
};

lod::Dendrogram coloured() {
  mesh::Mesh mesh = test::noisyGrid(120, 60, 0.3, 5);
  mesh::ensureNormals(mesh);
  mesh::Feature colour{"colour", 3, {}};
  for (const float x : mesh.features[0].values) colour.values.push_back(0.5F + 0.5F * x);
  mesh.features.push_back(std::move(colour));
  return lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
}

Eigen::Isometry3f viewOf(int k) {
  Eigen::Isometry3f T_eye_model(
      Eigen::Translation3f(0.1F, 0.05F, -1.2F - 0.2F * static_cast<float>(k)));
  T_eye_model.rotate(Eigen::AngleAxisf(0.3F * static_cast<float>(k), Eigen::Vector3f::UnitY()));
  return T_eye_model;
}

// Returns the number of pixels of which any channel differs by more than `most` of 255.
int pixelsBeyond(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int most) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    bool beyond = false;
    for (std::size_t c = 0; c < 3; ++c) beyond |= std::abs(int{a[i + c]} - int{b[i + c]}) > most;
    count += beyond ? 1 : 0;
  }
  return count;
}

using Frame = std::vector<std::uint8_t>;

// Returns four views, each at full detail and coarse, drawn by a thread with its own context.
std::vector<Frame> framesOf(const lod::Dendrogram& model, const gl::GlSettings& settings) {
  return std::async(std::launch::async,
                    [&] {
                      const auto plan = *tiles::planTiles({});
                      const SystemClock clock;
                      const auto renderer =
                          *test::rendererOf(model, plan, {.gl = settings}, 2.0, clock);
                      std::vector<Frame> frames;
                      for (int k = 0; k < 4; ++k) {
                        for (const std::size_t step : {std::size_t{0}, model.levelFor(2000)}) {
                          renderer->draw({.T_eye_content = viewOf(k), .step = step});
                          frames.emplace_back(renderer->pixels().begin(), renderer->pixels().end());
                        }
                      }
                      return frames;
                    })
      .get();
}

TEST_F(GpuTest, DrawsTheSoftwareRenderersPictures) {
  const lod::Dendrogram model = coloured();
  const auto gpu = framesOf(model, {}), software = framesOf(model, {.gpu = gl::kNoGpu});
  for (std::size_t i = 0; i < gpu.size(); ++i) {
    const double pixels = static_cast<double>(gpu[i].size()) / 4;
    const int beyond = pixelsBeyond(gpu[i], software[i], 2);
    EXPECT_LE(beyond, 0.001 * pixels) << "frame " << i;
    fmt::print("frame {}: {:.4f} % of the pixels differ by more than 2 of 255\n", i,
               100 * beyond / pixels);
  }
}

TEST_F(GpuTest, ReadsBackTheSamePixelsInBothWays) {
  const lod::Dendrogram model = coloured();
  EXPECT_TRUE(contexts_->asynchronous);
  EXPECT_EQ(contexts_->other, nullptr) << "one context is enough for a GPU";
  EXPECT_EQ(framesOf(model, {}), framesOf(model, {.read_back = gl::ReadBackMode::kDirect}));
}

TEST_F(GpuTest, CorrectsAsTheCpuDoesWithin1Of255) {
  correct::ShaderPass pass;
  ASSERT_TRUE(pass.begin(*contexts_->own));
  const auto map =
      correct::makeCorrectionMap(test::everything(), test::kWidth, test::kHeight, nullptr, 1);
  const auto picture = test::noise(test::kWidth, test::kHeight);
  std::vector<std::uint8_t> signal(picture.size());
  ASSERT_TRUE(pass.run(std::make_shared<const correct::CorrectionMap>(map), picture, signal))
      << pass.fault();
  correct::OutputCorrection cpu(map, 1);
  const auto expected = cpu.apply({test::kWidth, test::kHeight, picture});
  EXPECT_EQ(pixelsBeyond(signal, expected.pixels, 1), 0);
  pass.end();
}

// Returns the path of the GPU's own card, on which its displays are connected if it has any; empty
// if there is no card. Needs no display, and lights none.
std::string cardOf(const gl::RendererInfo& renderer) {
  const std::string device = deviceFolder(renderer.node);
  for (int i = 0; i < 16 && !device.empty(); ++i) {
    std::string card = fmt::format("/dev/dri/card{}", i);
    if (deviceFolder(card) == device) return card;
  }
  return {};
}

TEST_F(GpuTest, DrawsIntoTheMemoryThatItsDisplaysShow) {
  const std::string card = cardOf(contexts_->own->info());
  auto file = std::make_shared<out::kms::DeviceFile>(::open(card.c_str(), O_RDWR | O_CLOEXEC));
  if (!file->valid()) GTEST_SKIP() << "the GPU has no card that can be opened: " << card;
  constexpr int kLeft = 17, kTop = 9;
  const auto buffer = out::kms::makeDumbBuffer(file, test::kWidth + 40, test::kHeight + 30);
  ASSERT_TRUE(buffer) << buffer.error().what;
  correct::ShaderPass pass;
  ASSERT_TRUE(pass.begin(*contexts_->own));
  const auto map =
      correct::makeCorrectionMap(test::everything(), test::kWidth, test::kHeight, nullptr, 1);
  const auto picture = test::noise(test::kWidth, test::kHeight);
  const out::Signal source{test::kWidth, test::kHeight, picture};
  correct::OutputCorrection gpu(map, 1, &pass), cpu(map, 1);
  const out::DrawPlace places[] = {{(*buffer)->shared(), kLeft, kTop}};
  const bool drawn = gpu.draw(source, places).drawn;
  const std::string fault = pass.drawFault();
  pass.end();
  if (!drawn) GTEST_SKIP() << "outputs are copied on this GPU: " << fault;
  const auto bytes = (*buffer)->bytes();
  std::vector<std::uint8_t> shown;
  for (int y = 0; y < test::kHeight; ++y) {
    const auto row = static_cast<std::size_t>(y + kTop) * (*buffer)->pitch();
    for (int x = 0; x < test::kWidth; ++x) {
      const auto* const bgrx = &bytes[row + std::size_t{4} * static_cast<std::size_t>(x + kLeft)];
      shown.insert(shown.end(), {bgrx[2], bgrx[1], bgrx[0], 255});
    }
  }
  EXPECT_EQ(pixelsBeyond(shown, cpu.apply(source).pixels, 1), 0);
}

}  // namespace
}  // namespace merlin::render
