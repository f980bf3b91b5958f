// The wall follows the viewer's tracked head: while the head moves, frames are drawn in time; while
// it rests, the picture becomes finer.
#include <gtest/gtest.h>

#include "render/stereo/eye_tiles.h"
#include "tests/support/fake_wall.h"
#include "tests/support/told.h"

namespace merlin::wall {
namespace {

using Sentences = std::vector<std::string>;

class WallViewerTest : public FakeWall {
 protected:
  WallViewerTest() {
    render::stereo::StereoSettings stereo;
    stereo.head.station = 2;
    plan_ = *render::tiles::planTiles(render::stereo::eyeTiles(stereo, {}, {}, 2).tiles);
    feed_.pushed = false;
    viewer_place_.emplace(render::stereo::Head(stereo.head, {}, Eigen::Vector3d::Zero(), 0.15), 2,
                          plan_,
                          [this](const Event& event) { said_.push_back(test::told({event})[0]); });
    viewer_ = &*viewer_place_;
  }
  // Sets the head's place. The tracker's -y is the room's x. `right_m`: metres to the right of the
  // place for which the tiles are configured.
  void standAt(double right_m) {
    feed_.actions.head.emplace();
    feed_.actions.head->position_m[1] = static_cast<float>(-right_m);
    feed_.actions.head->orientation_wxyz[0] = 1;
  }
  double eyeIsAt() const {
    const render::tiles::Tile& t = plan_.tiles[1];
    return static_cast<double>(
        (-t.view.topLeftCorner<3, 3>().transpose() * t.view.block<3, 1>(0, 3)).x());
  }

  std::optional<ViewerPlace> viewer_place_;
  Sentences said_;
};

TEST_F(WallViewerTest, FollowsAHeadThatMovesInTimeAndRefinesWhenItRests) {
  const Timestamp start = clock_.now();
  double moved_until_s = 0;
  calibrated_ = true;
  run(4, [&](Timestamp now) {
    const double t = toSeconds(now - start);
    standAt(t < 1 ? 0.1 : std::min(0.1 + (t - 1) / 2, 0.35));  // half a metre a second
    if (stats_->read() && stats().moving) moved_until_s = t;
  });
  EXPECT_NEAR(eyeIsAt(), 0.35, 1e-5);
  EXPECT_GT(moved_until_s, 1.5);
  EXPECT_LT(moved_until_s, 1.8) << "still after 0.15 s";
  EXPECT_GE(painter_.drawn.size(), 15u);
  EXPECT_EQ(stats().full_detail, 1);
  EXPECT_EQ(stats().late, 0u);
  EXPECT_EQ(said_, Sentences{"the wall is drawn for the viewer's head, tracker station 2"});
}

TEST_F(WallViewerTest, DrawsNothingForTheJitterOfATrackerAtRest) {
  std::size_t drawn = 0;
  const Timestamp start = clock_.now();
  int k = 0;
  run(4, [&](Timestamp now) {
    standAt(0.1 + 0.002 * (k++ % 3));
    if (now - start < std::chrono::seconds(1)) drawn = painter_.drawn.size();
  });
  EXPECT_EQ(painter_.drawn.size(), drawn) << "once the first motion was over";
  EXPECT_EQ(stats().full_detail, 1);
}

TEST_F(WallViewerTest, ReturnsToTheConfiguredPlaceAndSaysSo) {
  const Timestamp start = clock_.now();
  double at_2_s = 0;
  run(4, [&](Timestamp now) {
    const double t = toSeconds(now - start);
    standAt(0.25);
    if (t > 1 && t < 3) feed_.actions.head.reset();
    if (t > 2 && t < 2.5) at_2_s = eyeIsAt();
  });
  EXPECT_EQ(at_2_s, 0);
  EXPECT_NEAR(eyeIsAt(), 0.25, 1e-5);
  EXPECT_EQ(
      said_,
      (Sentences{"the wall is drawn for the viewer's head, tracker station 2",
                 "fault: tracker station 2 on the viewer's head is missing: the wall is drawn for "
                 "the configured place of the viewer",
                 "the wall is drawn for the viewer's head, tracker station 2"}));
}

TEST_F(WallViewerTest, SaysThatAStationWasNeverThere) {
  run(2.9);
  EXPECT_EQ(said_, Sentences{}) << "a tracker may take a while to begin";
  stop_ = {};
  run(0.3);
  EXPECT_EQ(said_,
            Sentences{"fault: tracker station 2 on the viewer's head is missing: the wall is drawn "
                      "for the configured place of the viewer"});
}

TEST_F(WallViewerTest, KeepsTheLastPlaceBeforeAScreenAndSaysSoOnce) {
  const Timestamp start = clock_.now();
  run(4, [&](Timestamp now) {
    standAt(0.25);
    if (now - start > std::chrono::seconds(1))  // tracker x is away from the wall
      feed_.actions.head->position_m[0] = -5 + 0.1F * static_cast<float>(toSeconds(now - start));
  });
  EXPECT_NEAR(eyeIsAt(), 0.25, 1e-5);
  ASSERT_EQ(said_.size(), 2u);
  EXPECT_EQ(
      said_[1],
      "fault: tracker station 2 says that the viewer's eyes are on or behind a screen, or almost "
      "touch one: the wall is drawn for their position before that");
}

}  // namespace
}  // namespace merlin::wall
