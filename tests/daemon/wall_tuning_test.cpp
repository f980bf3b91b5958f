// Changes of settings that a running wall takes over, on a virtual clock.
#include <gtest/gtest.h>

#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

class WallTuningTest : public FakeWall {
 protected:
  // Tunes the loop once, after half a second.
  void runAndTune(double seconds, const WallTuning& tuning) {
    run(seconds, [&](Timestamp now) {
      // In the frame in which the settings change, the view has not moved yet.
      if (tuned_ && !before_) before_ = scene_.view();
      if (tuned_ || now - feed_.begins.front() < milliseconds(500)) return;
      tuned_ = true;
      loop_->tune(tuning);
    });
  }
  bool tuned_ = false;
  std::optional<render::scene::SceneView> before_;
};

TEST_F(WallTuningTest, TheRateIsTheNewOneUnlessAPersonSetAnother) {
  WallTuning tuning;
  tuning.governor = render::governor::GovernorSettings{.rate_hz = 60, .max_triangles = 20'000};
  runAndTune(3, tuning);
  EXPECT_NEAR(stats().rate_asked_hz, 60, 0.01);
  EXPECT_NEAR(stats().rate_held_hz, 60, 0.5);
}

TEST_F(WallTuningTest, ARateByHandStays) {
  WallTuning tuning;
  tuning.governor = render::governor::GovernorSettings{.rate_hz = 60};
  run(3, [&](Timestamp now) {
    if (feed_.begins.size() == 1) loop_->setRate(20);
    if (now - feed_.begins.front() > milliseconds(500) && !std::exchange(tuned_, true))
      loop_->tune(tuning);
  });
  EXPECT_NEAR(stats().rate_asked_hz, 20, 0.01);
}

TEST_F(WallTuningTest, TheLimitsOfTheTrianglesHoldAtOnce) {
  WallTuning tuning;
  tuning.governor = render::governor::GovernorSettings{
      .min_triangles = 100, .max_triangles = 300, .first_triangles = 200};
  runAndTune(2, tuning);
  EXPECT_GT(frames_.frames.front().cost, 300u);
  EXPECT_LE(frames_.frames.back().cost, 300u);
}

// The model's place must not change; from now on, the ball turns it at the new speed.
TEST_F(WallTuningTest, TheViewStaysAndTheBallIsFaster) {
  WallTuning tuning;
  tuning.scene = render::scene::SceneSettings{};
  tuning.scene->ball_turn_deg_s = {0, 0, 0};
  tuning.scene->return_after_s = 0;
  runAndTune(2, tuning);
  EXPECT_TRUE(scene_.view().T_eye_model.isApprox(before_->T_eye_model, 1e-4F));
  EXPECT_FALSE(scene_.view().T_eye_model.linear().isApprox(Eigen::Matrix3f::Identity(), 0.1F))
      << "it was turned before";
}

TEST_F(WallTuningTest, ThePlaylistTakesItsNewTimes) {
  feed_.pushed = false;
  WallTuning tuning;
  tuning.playlist.emplace();
  tuning.playlist->after_s = tuning.playlist->dim_after_s = 1;
  tuning.playlist->dim_to = 0.5;
  runAndTune(6, tuning);
  EXPECT_EQ(attendance_->playlist(), Playlist::State::kRunning);
  EXPECT_NEAR(attendance_->light(), 0.5F, 0.01F);
}

TEST_F(WallTuningTest, TheFeedIsToldOfHandAndTimes) {
  struct : InputFeed {
    WallInput read(Timestamp) override { return {}; }
    Duration age() const noexcept override { return {}; }
    void configure(const FeedSettings& settings) override { told.push_back(settings); }
    std::vector<FeedSettings> told;
  } feed;
  WallParts p{contents_,
              scene_,
              governor_,
              feed,
              *((void)parts(), delivery_),
              {*stats_, trace_.get(), interaction_.get(), output_stats_.get()},
              clock_,
              frame_clock_,
              *attendance_};
  WallLoop loop(std::move(p));
  WallTuning first, second;
  first.feed.emplace().hands = {{"hand", "", "", {"", 2}}};
  first.feed->stale_after = milliseconds(300);
  second.feed.emplace().hands = {{"hand", "", "", {"", 3}}};
  loop.tune(first);
  loop.tune(second);
  loop.run(stop_.get_token(), [&] { stop_.request_stop(); });
  ASSERT_EQ(feed.told.size(), 2u) << "none is lost, and none comes twice";
  EXPECT_EQ(feed.told[1].hands[0].place.station, 3);
  EXPECT_EQ(feed.told[0].stale_after, milliseconds(300));
}

}  // namespace
}  // namespace merlin::wall
