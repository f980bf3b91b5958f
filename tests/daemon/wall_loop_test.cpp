// The pace of the wall's frames on a virtual clock; the painter's frames take a simulated time.
#include "daemon/wall/wall_loop.h"

#include <gtest/gtest.h>

#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

class WallLoopTest : public FakeWall {};

TEST_F(WallLoopTest, HoldsTheRateWhileItMoves) {
  run(10);
  EXPECT_EQ(first_frames_, 1);
  EXPECT_NEAR(static_cast<double>(frames_.frames.size()), 300, 2);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
  EXPECT_LE(stats().late, 3u);  // the first frame tries to draw more than there is time for
  EXPECT_GT(stats().utilisation, 0.80F);
  EXPECT_EQ(stats().moving, 1u);
  EXPECT_FLOAT_EQ(stats().input_age_ms, 7);
}

TEST_F(WallLoopTest, EachPeriodBeginsOnTheGrid) {
  run(3);
  const Timestamp start = feed_.begins.front();
  for (std::size_t i = 10; i < feed_.begins.size(); ++i) {
    EXPECT_EQ((feed_.begins[i] - start) % kPeriod, Duration::zero()) << i;
  }
}

TEST_F(WallLoopTest, EveryDeadlineThatALongFrameMissesCounts) {
  run(4, [&](Timestamp now) {
    painter_.slow = now - feed_.begins.front() > milliseconds(2000) &&
                            now - feed_.begins.front() < milliseconds(2034)
                        ? 5
                        : 1;
  });
  // One frame of about 30 ms became one of about 130 ms: it misses four deadlines, and no frame
  // after it.
  EXPECT_GE(stats().longest_late, 3u);
  EXPECT_LE(stats().longest_late, 5u);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
}

TEST_F(WallLoopTest, ShowsFullDetailWithinHalfASecondOfStandstill) {
  std::optional<Timestamp> let_go;
  run(4, [&](Timestamp now) {
    feed_.pushed = now - feed_.begins.front() < std::chrono::seconds(2);
    if (!feed_.pushed && !let_go) let_go = now;
  });
  ASSERT_TRUE(let_go);
  const auto full = std::find_if(frames_.frames.begin(), frames_.frames.end(), [&](const auto& f) {
    return f.full_detail && f.finished > *let_go;
  });
  ASSERT_NE(full, frames_.frames.end());
  EXPECT_EQ(full->cost, model().triangleCount());
  EXPECT_LE(full->finished - *let_go, milliseconds(500));
  EXPECT_EQ(full + 1, frames_.frames.end()) << "a picture that stands is not drawn again";
  EXPECT_EQ(stats().full_detail, 1u);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
}

// Whenever motion resumes, during refinement or not, the first frame that begins afterwards must
// meet its own deadline.
TEST_F(WallLoopTest, TheFirstFrameAfterMotionResumesIsInTime) {
  std::optional<Timestamp> resumed;
  for (int still_periods = 5; still_periods < 40; ++still_periods) {
    feed_.begins.clear();
    frames_.frames.clear();
    resumed.reset();
    stop_ = std::stop_source();
    run(4, [&](Timestamp now) {
      const auto k = (now - feed_.begins.front()) / kPeriod;
      feed_.pushed = k < 60 || k >= 60 + still_periods;
      if (k >= 60 + still_periods && !resumed) resumed = now;
    });
    ASSERT_TRUE(resumed);
    const auto first = std::find_if(frames_.frames.begin(), frames_.frames.end(),
                                    [&](const auto& f) { return f.finished > *resumed; });
    ASSERT_NE(first, frames_.frames.end());
    EXPECT_LE(first->finished - *resumed, kPeriod) << still_periods;
    EXPECT_FALSE(first->full_detail) << still_periods;
    EXPECT_EQ(stats().resumed, 1u);
    EXPECT_EQ(stats().resumed_late, 0u);
  }
}

// The first frame of the content is twice as slow, since its data are in no cache; three frames
// later the content has full detail.
TEST_F(WallLoopTest, TheFirstFrameOfAnotherContentIsInTime) {
  contents_.push_back({&detail_, &painter_});
  calibrated_ = true;
  std::size_t at_change = 0;
  run(4, [&](Timestamp now) {
    if (at_change == 0 && now - feed_.begins.front() > std::chrono::seconds(3)) {
      at_change = frames_.frames.size() + 1;  // the content is requested while a frame begins
      loop_->show(1);
    }
    painter_.slow = at_change > 0 && frames_.frames.size() == at_change ? 2 : 1;
  });
  EXPECT_EQ(stats().late, 0u);
  const auto costOf = [&](std::size_t frame) { return frames_.frames.at(frame).cost; };
  EXPECT_LT(costOf(at_change), 0.5 * costOf(at_change - 1));
  EXPECT_GT(costOf(at_change + 1), costOf(at_change));
  EXPECT_EQ(costOf(at_change + 3), costOf(at_change - 1));
}

// Otherwise the text over the frame (the operator's plates) would name the previous content.
TEST_F(WallLoopTest, TheFirstFrameOfAnotherContentFindsItsNamePublished) {
  contents_.push_back({&detail_, &painter_});
  contents_[0].name = "first";
  contents_[1].name = "second";
  std::vector<std::string> published;  // the published name, at each time that a frame was drawn
  painter_.on_draw = [&] {
    const auto content = content_->read();
    published.emplace_back(content ? content->name : "");
  };
  std::size_t at_change = 0;
  run(1, [&](Timestamp) {
    if (at_change > 0 || published.size() < 5) return;
    at_change = published.size() + 1;  // the content is requested while a frame begins
    loop_->show(1);
  });
  ASSERT_GT(at_change, 0u);
  EXPECT_EQ(published.at(at_change - 1), "first");
  EXPECT_EQ(published.at(at_change), "second");
}

TEST_F(WallLoopTest, ARequestIsDoneBeforeTheNextFrame) {
  feed_.pushed = false;
  Progress progress;
  WallParts with_progress = parts();
  with_progress.progress = &progress;
  WallLoop loop(with_progress);
  feed_.on_begin = [&](Timestamp) {
    if (feed_.begins.size() == 3) loop.request(WallLoop::kNextMode);
    if (feed_.begins.size() == 5) stop_.request_stop();
  };
  loop.run(stop_.get_token(), [] {});
  EXPECT_STREQ(stats().mode, "fly");
  EXPECT_GE(progress.count(), 5u);
}

TEST_F(WallLoopTest, StepsOfOneFrameAddUpAndAreDoneOnce) {
  feed_.pushed = false;
  WallParts all = parts();
  WallLoop loop(all);
  const Eigen::Vector3f start = all.scene.view().T_eye_model.translation();
  feed_.on_begin = [&](Timestamp) {
    if (feed_.begins.size() == 3) {
      loop.move({{0.25F, 0, 0}, Eigen::Vector3f::Zero()});
      loop.move({{0.25F, 0.5F, 0}, Eigen::Vector3f::Zero()});
    }
    if (feed_.begins.size() == 6) stop_.request_stop();
  };
  loop.run(stop_.get_token(), [] {});
  const Eigen::Vector3f way = all.scene.view().T_eye_model.translation() - start;
  EXPECT_TRUE(way.isApprox(Eigen::Vector3f(0.5F, 0.5F, 0))) << way.transpose();
}

TEST_F(WallLoopTest, StopsAtOnce) {
  stop_.request_stop();
  WallLoop loop(parts());
  loop.run(stop_.get_token(), [] {});
  EXPECT_TRUE(frames_.frames.empty());
}

}  // namespace
}  // namespace merlin::wall
