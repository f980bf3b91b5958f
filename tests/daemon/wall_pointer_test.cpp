// The pointer's mark on a wall on a virtual clock: it moves while the picture stands.
#include <gtest/gtest.h>

#include "tests/support/fake_wall.h"

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
    feed_.hand->position_m[0] += 0.01F;  // some pixels a frame
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

TEST_F(WallPointerTest, SnapshotsAreTakenAndCounted) {
  bool asked = false;
  int taken = 0;
  on_snapshot_ = [&] { ++taken; };
  run(1, [&](Timestamp) {
    if (since() > milliseconds(500) && !std::exchange(asked, true)) feed_.actions.snapshot = 2;
  });
  EXPECT_EQ(taken, 2);
  EXPECT_EQ(interaction_->read()->snapshots, 2u);
}

}  // namespace
}  // namespace merlin::wall
