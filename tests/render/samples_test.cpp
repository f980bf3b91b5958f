// The sample content, the sample output and the sample reader must fulfil the contracts of their
// ports.
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "render/content/sample/chequers.h"
#include "render/frame/frame_renderer.h"
#include "render/mesh/io/sample/raw_triangles.h"
#include "render/out/sample/checksum_output.h"
#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

// Returns a plan with one tile of 64 x 64 pixels, which a plane of 2 x 2 m fills exactly.
tiles::TilePlan onePlane() {
  tiles::TilesSettings s;
  s.tile_width = s.tile_height = s.frame_width = s.frame_height = 64;
  s.field_of_view_deg = 90;
  s.tiles = {{"all", tiles::TileKind::kWall, 0, 0, 0}};
  return *tiles::planTiles(s);
}

class ChequersTest : public testing::Test {
 protected:
  std::uint8_t at(int x, int y) {
    return renderer_->pixels()[static_cast<std::size_t>(4 * (64 * y + x))];
  }

  SystemClock clock_;
  tiles::TilePlan plan_ = onePlane();
  Eigen::Isometry3f T_eye_content_{Eigen::Translation3f(0, 0, -1)};
  std::unique_ptr<frame::FrameRenderer> renderer_ = *frame::FrameRenderer::make(
      std::make_unique<content::Chequers>(), plan_, *frame::DrawContexts::make({}), clock_);
};

// At step 3 there are 8 x 8 squares of 8 pixels, at step 5 there are 2 x 2 squares of 32 pixels.
TEST_F(ChequersTest, IsDrawnAtAnyStep) {
  const content::DetailAxis& detail = renderer_->content().detail();
  EXPECT_EQ(detail.stepWithin(64), 3u);
  renderer_->draw({.T_eye_content = T_eye_content_, .step = 3});
  EXPECT_EQ(at(3, 3), at(11, 11));
  EXPECT_NE(at(3, 3), at(11, 3));
  EXPECT_EQ(detail.stepWithin(1), 5u) << "the coarsest";
  renderer_->draw({.T_eye_content = T_eye_content_, .step = 5});
  EXPECT_EQ(at(3, 3), at(28, 28));
  EXPECT_NE(at(3, 3), at(40, 3));
  EXPECT_EQ(at(40, 3), 255) << "the lower left square is bright, and so is the upper right one";
}

TEST_F(ChequersTest, RefinesInSlicesToWhatIsDrawnAtOnce) {
  renderer_->draw({.T_eye_content = T_eye_content_, .step = 0});
  const std::vector<std::uint8_t> whole(renderer_->pixels().begin(), renderer_->pixels().end());
  renderer_->draw({.T_eye_content = T_eye_content_, .step = 5});
  renderer_->beginRefining(T_eye_content_, 0);
  while (!renderer_->refine(clock_.now() + std::chrono::milliseconds(50))) continue;
  EXPECT_TRUE(std::ranges::equal(renderer_->pixels(), whole));
  EXPECT_TRUE(renderer_->sees(T_eye_content_));
  EXPECT_FALSE(renderer_->sees(Eigen::Isometry3f(Eigen::Translation3f(0, 0, 5))));
}

TEST(ChecksumOutput, WritesALineAFrameAndSaysWhatFails) {
  const test::TempDir folder;
  test::FakeClock clock;
  const std::vector<std::uint8_t> pixels = {'a'};
  out::ChecksumOutput output(folder / "sums", clock);
  const auto shown = output.present({1, 1, pixels}, {.sequence = 7});
  ASSERT_TRUE(shown);
  EXPECT_EQ(*shown, clock.now());
  EXPECT_EQ(test::readText(folder / "sums"), "7 af63dc4c8601ec8c\n");
  out::ChecksumOutput nowhere(folder / "none/sums", clock);
  const auto failed = nowhere.present({1, 1, pixels}, {});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, Errc::kIo);
}

TEST(RawTriangles, IsReadLikeAnyOtherFormat) {
  const test::TempDir dir;
  test::writeText(dir / "a.raw", "0 0 0 1 0 0 0 1 0\n\n0 0 1\t1 0 1 0 1 1\r\n");
  const auto loaded = mesh::readMeshAs(mesh::kRawTrianglesReader, dir / "a.raw");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangleCount(), 2u);
  EXPECT_EQ(loaded->mesh.positions[17], 1);
  test::writeText(dir / "b.raw", "0 0 0 1 0 0 0 1 0\n1 2 3\n");
  EXPECT_EQ(mesh::readMeshAs(mesh::kRawTrianglesReader, dir / "b.raw").error().what,
            dir / "b.raw" + ": line 2: has 3 of 9 numbers");
  EXPECT_EQ(mesh::readMesh(dir / "a.raw").error().code, Errc::kUnsupported) << "not in the table";
}

}  // namespace
}  // namespace merlin::render
