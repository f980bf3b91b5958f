// The pointer's mark on a wall, on a virtual clock: it moves while the picture stands still.
#include <filesystem>

#include <gtest/gtest.h>

#include "daemon/wall/snapshot_writer.h"
#include "tests/support/eventually.h"
#include "tests/support/fake_wall.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

class WallPointerTest : public FakeWall {
 protected:
  WallPointerTest() {
    render::scene::SceneSettings settings;
    settings.tracker_axes = {1, 2, 3};
    scene_ = *render::scene::Scene::make(settings);
    painter_.pixels_.assign(4 * 1280 * 960, 90);
    marker_ = &made_;
    feed_.pushed = false;
    feed_.hand.emplace();
    feed_.hand->orientation_wxyz[0] = 1;
  }
  Duration since() const { return clock_.now() - feed_.begins.front(); }

  render::frame::PointerMarker made_{plan_};
};

TEST_F(WallPointerTest, EveryPlaceOfTheMarkIsShownWhileThePictureStands) {
  std::size_t standing = 0, drawn = 0;
  run(4, [&](Timestamp) {
    if (since() < std::chrono::seconds(2)) {
      standing = frames_.frames.size();
      drawn = painter_.drawn.size();
      return;
    }
    feed_.actions.scene.point_at = true;
    feed_.hand->position_m[0] += 0.01F;  // a few pixels a frame
  });
  ASSERT_GT(standing, 0u);
  EXPECT_NEAR(static_cast<double>(frames_.frames.size() - standing), 60, 2);
  EXPECT_EQ(painter_.drawn.size(), drawn) << "no triangle is drawn for it";
  EXPECT_TRUE(frames_.frames.back().full_detail);
  EXPECT_EQ(painter_.pixels_, std::vector<std::uint8_t>(4 * 1280 * 960, 90)) << "put back";
  EXPECT_EQ(interaction_->read()->pointing, shm::WallInteraction::kAtModel);
}

TEST_F(WallPointerTest, AMarkThatStandsIsShownOnceAndItsEndToo) {
  std::size_t pointing = 0, standing = 0;
  run(4, [&](Timestamp) {
    if (since() < std::chrono::seconds(2)) standing = frames_.frames.size();
    bool& point = feed_.actions.scene.point_at;
    point = since() > std::chrono::seconds(2) && since() < std::chrono::seconds(3);
    if (point) pointing = frames_.frames.size();
  });
  EXPECT_EQ(pointing, standing + 1);
  EXPECT_EQ(frames_.frames.size(), standing + 2);
  EXPECT_EQ(interaction_->read()->pointing, shm::WallInteraction::kNone);
  EXPECT_EQ(interaction_->read()->pixel[0], -1);
}

// The count includes the snapshots that the panel and the command requested.
TEST_F(WallPointerTest, SnapshotsAreTakenAndThoseThatWereWrittenAreCounted) {
  bool asked = false;
  int taken = 0;
  on_snapshot_ = [&] { ++taken; };
  snapshots_written_ = [] { return 7U; };
  run(1, [&](Timestamp) {
    if (since() > milliseconds(500) && !std::exchange(asked, true)) feed_.actions.snapshot = 2;
  });
  EXPECT_EQ(taken, 2);
  EXPECT_EQ(interaction_->read()->snapshots, 7u);
}

TEST_F(WallPointerTest, TheWriterOfSnapshotsCountsThoseThatAreThere) {
  const test::TempDir dir;
  const std::string name = "/" + test::privateName("snapshots");
  const auto output = render::out::SharedFrameOutput::make(name, plan_, 1, clock_);
  ASSERT_TRUE(output) << output.error().what;
  const std::vector<std::uint8_t> pixels(4 * 1280 * 960, 90);
  ASSERT_TRUE((*output)->present({1280, 960, pixels}, {1, clock_.now(), 1, true}));
  ThreadWatch watch;
  SnapshotWriter writer(name, DatedFiles(dir / "shots", "wall", ".png", 5), watch);
  EXPECT_EQ(writer.written(), 0u);
  writer.take();
  EXPECT_TRUE(test::eventually([&] { return writer.written() == 1; }));
  EXPECT_FALSE(std::filesystem::is_empty(dir / "shots"));
}

}  // namespace
}  // namespace merlin::wall
