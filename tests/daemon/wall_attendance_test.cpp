// A wall that is black, frozen, or controlled by its playlist, on a virtual clock.
#include <gtest/gtest.h>

#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

constexpr float kRadian = 0.01745329F;

class WallAttendanceTest : public FakeWall {
 protected:
  WallAttendanceTest() {
    painter_.pixels_.assign(8, 0);
    contents_.push_back({&detail_, &other_});
    feed_.pushed = false;
    calibrated_ = true;
  }
  // Runs for `seconds` and calls `on_frame` with the number of each frame, counted from 1.
  void frames(double seconds, const std::function<void(std::size_t)>& on_frame) {
    run(seconds, [&](Timestamp) { on_frame(feed_.begins.size()); });
  }
  void setPlaylist(double after_s, double hold_s, double turn_deg_per_s) {
    playlist_.after_s = after_s;
    playlist_.hold_s = hold_s;
    playlist_.turn_deg_per_s = turn_deg_per_s;
  }
  shm::WallInteraction interaction() const { return *interaction_->read(); }
  Eigen::Isometry3f pose() const { return scene_.view().T_eye_model; }
  // Returns the angle by which the content has turned about the vertical axis since the initial
  // view [degrees].
  float turned() const {
    const Eigen::Matrix3f R = pose().linear();
    return std::atan2(R(0, 2), R(0, 0)) / kRadian;
  }

  FakePainter other_{clock_, microseconds(10), 40};
};

TEST_F(WallAttendanceTest, BlankIsBlackWithinThePeriodAndASecondCallShowsThePictureAgain) {
  std::size_t shown = 0;
  frames(6, [&](std::size_t frame) {
    if (frame == 90) {
      ASSERT_EQ(frames_.firsts.back(), FakePainter::kRefined);
      shown = frames_.frames.size();
      attendance_->toggleBlank();
    }
    if (frame == 91) {
      EXPECT_EQ(frames_.frames.size(), shown + 1);
      EXPECT_EQ(frames_.firsts.back(), 0);
      EXPECT_EQ(interaction().shown, shm::WallInteraction::kBlank);
      EXPECT_EQ(interaction().light, 0);
    }
    if (frame == 120) {
      EXPECT_EQ(frames_.frames.size(), shown + 1) << "black is not drawn again";
      attendance_->toggleBlank();
    }
    if (frame == 121) {
      EXPECT_EQ(frames_.firsts.back(), FakePainter::kRefined);
      EXPECT_EQ(interaction().shown, shm::WallInteraction::kPicture);
      EXPECT_EQ(interaction().light, 1);
    }
  });
  EXPECT_EQ(painter_.pixels_[0], FakePainter::kRefined) << "the canvas itself is never black";
}

TEST_F(WallAttendanceTest, ATouchShowsThePictureAgainAndMovesItAsEver) {
  float before = 0;
  std::vector<float> steps;  // of the first frames in which the ball is pushed
  frames(6, [&](std::size_t frame) {
    if (frame == 60) attendance_->toggleBlank();
    feed_.pushed = frame >= 120 && frame < 124;
    if (frame > 120 && frame <= 124) steps.push_back(turned() - before);
    before = turned();
    if (frame == 121) {
      EXPECT_EQ(interaction().shown, shm::WallInteraction::kPicture);
    }
  });
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_NEAR(steps[0], steps[2], 1e-3);
  EXPECT_GT(steps[0], 0.1F);
  EXPECT_EQ(interaction().light, 1);
}

TEST_F(WallAttendanceTest, AFrozenSceneDoesNotMoveUntilTheNextTouch) {
  Eigen::Isometry3f frozen = pose();
  frames(8, [&](std::size_t frame) {
    feed_.pushed = frame < 90 || frame >= 150;
    if (frame == 30) attendance_->toggleFreeze();
    if (frame == 31) frozen = pose();
    if (frame > 31 && frame <= 150) {
      ASSERT_TRUE(pose().isApprox(frozen, 0)) << frame;
    }
    if (frame == 90) {
      EXPECT_EQ(interaction().shown, shm::WallInteraction::kFrozen);
      EXPECT_TRUE(stats().full_detail) << "it is still, so it is sharp";
    }
  });
  EXPECT_FALSE(pose().isApprox(frozen, 1e-3F));
  EXPECT_EQ(interaction().shown, shm::WallInteraction::kPicture);
}

TEST_F(WallAttendanceTest, ACommandThatChangesWhatIsShownEndsIt) {
  const std::function<void()> commands[] = {[&] { loop_->request(WallLoop::kResetView); },
                                            [&] { loop_->request(WallLoop::kNextContent); },
                                            [&] { loop_->show(1); },
                                            [&] {
                                              loop_->move({{0.1F, 0, 0}, Eigen::Vector3f::Zero()});
                                            }};
  for (const auto& command : commands) {
    feed_.begins.clear();
    stop_ = std::stop_source();
    frames(2, [&](std::size_t frame) {
      if (frame == 10) attendance_->toggleFreeze();
      if (frame == 20) {
        EXPECT_EQ(interaction().shown, shm::WallInteraction::kFrozen);
        command();
      }
    });
    EXPECT_EQ(interaction().shown, shm::WallInteraction::kPicture);
  }
}

TEST_F(WallAttendanceTest, AModelThatIsReplacedWhileItIsFrozenIsShownAfterwards) {
  class Fresh final : public ContentSource {
   public:
    std::optional<Replacement> take(bool, const Eigen::Isometry3f&) override {
      ++taken;
      return std::nullopt;
    }
    int taken = 0;
  } fresh;
  replacements_ = &fresh;
  int before = 0;
  frames(3, [&](std::size_t frame) {
    if (frame == 10) attendance_->toggleFreeze();
    if (frame == 11) before = fresh.taken;
    if (frame == 60) {
      EXPECT_EQ(fresh.taken, before);
      attendance_->toggleFreeze();
    }
  });
  EXPECT_GT(fresh.taken, before);
}

// After 2 seconds without a touch, the content turns by 30 degrees a second; each content is shown
// for 3 seconds.
TEST_F(WallAttendanceTest, ThePlaylistTurnsAtTheRateAndYieldsAtTheFirstTouch) {
  setPlaylist(2, 3, 30);
  float yielded = 0;
  frames(10, [&](std::size_t frame) {
    if (frame == 60) {
      EXPECT_EQ(turned(), 0);
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistWaiting);
    }
    if (frame == 121) {
      EXPECT_NEAR(turned(), 60, 3) << "two seconds";
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistRunning);
      EXPECT_EQ(interaction().content, 0u);
      EXPECT_EQ(stats().moving, 1u);
    }
    if (frame == 181) {
      EXPECT_EQ(interaction().content, 1u);
      EXPECT_NEAR(turned(), 30, 3) << "from its initial view";
    }
    feed_.pushed = frame == 200;
    if (frame == 201) yielded = turned();
    if (frame == 250) {
      EXPECT_NEAR(turned(), yielded, 1e-3) << "from where it stands";
      EXPECT_EQ(interaction().content, 1u);
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistWaiting);
      EXPECT_TRUE(stats().full_detail);
    }
  });
  EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistRunning) << "it comes back";
  EXPECT_EQ(stats().late, 0u);
}

TEST_F(WallAttendanceTest, ThePlaylistBeginsWithTheInitialViewOfAContentOfItsList) {
  setPlaylist(2, 100, 0);
  for (const std::size_t place : {std::size_t{0}, std::size_t{1}}) {
    playlist_places_ = {place};
    feed_.begins.clear();
    stop_ = std::stop_source();
    frames(4, [&](std::size_t frame) {
      feed_.pushed = frame < 20;
      if (frame == 70) {
        EXPECT_GT(turned(), 5);
        EXPECT_EQ(interaction().content, 0u);
      }
    });
    EXPECT_EQ(interaction().content, place);
    EXPECT_NEAR(turned(), 0, 1e-3);
  }
}

// `merlin show FILE` on a wall with two contents: the file becomes the third one.
TEST_F(WallAttendanceTest, WhatAPersonHasShownIsTheFirstOfThePlaylistForAsLongAsEach) {
  contents_.push_back({&detail_, &painter_});
  listed_ = 2;
  setPlaylist(2, 3, 0);
  frames(7, [&](std::size_t frame) {
    if (frame == 30) loop_->show(2);  // the playlist begins 2 seconds later, with frame 91
    if (frame == 89) {
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistWaiting);
    }
    if (frame == 178) {
      EXPECT_EQ(interaction().content, 2u);
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistRunning);
    }
    if (frame == 185) {
      EXPECT_EQ(interaction().content, 1u) << "the list goes on";
    }
  });
}

TEST_F(WallAttendanceTest, AContentThatIsNotInThePlaylistIsShownFirstIfAPersonChoseIt) {
  setPlaylist(1, 2, 0);
  playlist_places_ = {0};
  const std::function<void()> choices[] = {
      [&] { loop_->show(1); },
      [&] { loop_->request(WallLoop::kNextContent); },
      [&] { loop_->request(WallLoop::kPreviousContent); },
      [&] { feed_.actions.next_content = 1; },
      [&] { feed_.actions.previous_content = 1; },
  };
  for (const auto& choose : choices) {
    feed_.begins.clear();
    stop_ = std::stop_source();
    frames(4, [&](std::size_t frame) {
      if (frame == 10) choose();
      if (frame == 95) {
        EXPECT_EQ(interaction().content, 1u);
        EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistRunning);
      }
    });
    EXPECT_EQ(interaction().content, 0u) << "for its time, and then no more";
  }
}

// A model that takes long to read arrives while the playlist is already running.
TEST_F(WallAttendanceTest, WhatComesLateIsShownAsLongAsWhatComesAtOnce) {
  class Late final : public ContentSource {
   public:
    explicit Late(ShownContent content) : content_(content) {}
    std::optional<Replacement> take(bool, const Eigen::Isometry3f&) override {
      if (!std::exchange(due, false)) return std::nullopt;
      return Replacement{2, content_, true, 7, {}, false};
    }
    bool due = false;

   private:
    ShownContent content_;
  } late({&detail_, &painter_});
  contents_.push_back({&detail_, &painter_});
  listed_ = 2;
  replacements_ = &late;
  setPlaylist(1, 2, 0);
  frames(7, [&](std::size_t frame) {
    late.due = frame == 85;  // just before the next content is due, after 3 seconds
    if (frame == 87 || frame == 172) {
      EXPECT_EQ(interaction().content, 2u) << frame;
    }
    if (frame == 87) {
      EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistWaiting);
    }
  });
  EXPECT_NE(interaction().content, 2u);
}

TEST_F(WallAttendanceTest, APlaylistOfOneContentTurnsItOnWithoutAJump) {
  setPlaylist(1, 1, 10);
  playlist_places_ = {0};
  frames(6, [](std::size_t) {});
  EXPECT_NEAR(turned(), 50, 3);
  EXPECT_EQ(interaction().content, 0u);
}

TEST_F(WallAttendanceTest, APictureStandsStillAndSharpWhileThePlaylistShowsIt) {
  contents_[0].navigation = render::content::Navigation::kPlane;
  setPlaylist(1, 100, 30);
  frames(6, [](std::size_t) {});
  EXPECT_EQ(interaction().playlist, shm::WallInteraction::kPlaylistRunning);
  EXPECT_TRUE(stats().full_detail);
  EXPECT_EQ(stats().moving, 0u);
}

TEST_F(WallAttendanceTest, APlaylistOfNamesShowsAllSlidesBeforeTheNextContent) {
  class TwoSlides final : public ContentSource {
   public:
    std::optional<Replacement> take(bool, const Eigen::Isometry3f&) override {
      return std::nullopt;
    }
    bool nextWithin(std::size_t place) override { return place == 0 && parts-- > 0; }
    int parts = 1;
  } slides;
  replacements_ = &slides;
  setPlaylist(1, 2, 0);
  playlist_places_ = {0, 1};
  frames(6.5, [&](std::size_t frame) {
    if (frame == 130) {
      EXPECT_EQ(interaction().content, 0u) << "the second slide";
    }
  });
  EXPECT_EQ(interaction().content, 1u);
}

TEST_F(WallAttendanceTest, ADimmedPictureIsBrightAgainAtTheFirstTouch) {
  playlist_.dim_after_s = 2;
  playlist_.dim_to = 0.25;
  frames(8, [&](std::size_t frame) {
    feed_.pushed = frame == 200;
    if (frame == 59) {
      EXPECT_EQ(frames_.firsts.back(), FakePainter::kRefined);
    }
    if (frame == 199) {
      EXPECT_NEAR(frames_.firsts.back(), 48, 1) << "90 * 0.25 ^ (1 / 2.2)";
      EXPECT_EQ(interaction().light, 0.25F);
    }
    if (frame == 201) {
      EXPECT_EQ(interaction().light, 1);
    }
  });
  EXPECT_EQ(frames_.firsts.back(), FakePainter::kRefined);
}

}  // namespace
}  // namespace merlin::wall
