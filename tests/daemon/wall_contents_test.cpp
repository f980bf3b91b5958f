// Several models on a wall, on a virtual clock: the wall changes to the next one at once, without
// late frames.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/fixed_text.h"
#include "daemon/wall/show_results.h"
#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

// A triangle of the second model costs four times as much as a triangle of the first one.
class WallContentsTest : public FakeWall {
 protected:
  WallContentsTest() {
    contents_.push_back({&detail_, &dear_});
    calibrated_ = true;
  }
  // Requests the next content after 2 s, and again after 4 s.
  void pressTwice(Timestamp) {
    const auto frame = static_cast<int>(feed_.begins.size());
    feed_.actions.next_content = frame == 60 || frame == 120 ? 1 : 0;
  }
  shm::WallInteraction interaction() const { return *interaction_->read(); }

  FakePainter dear_{clock_, microseconds(40), 40};
  FakePainter missing_{clock_, microseconds(10), 10};
};

TEST_F(WallContentsTest, TheNextOneIsInTimeFromItsFirstFrame) {
  run(6, [&](Timestamp now) { pressTwice(now); });
  EXPECT_EQ(stats().late, 0u);
  const std::size_t calibrating = 3;  // frames of the second model that were drawn for calibration
  EXPECT_NEAR(static_cast<double>(dear_.drawn.size() - calibrating), 60, 1);
  EXPECT_GT(painter_.drawn.back(), dear_.drawn.back()) << "after the last comes the first";
  const auto triangles = [](const FakePainter& p, std::size_t i) {
    return static_cast<double>(model().trianglesAt(p.steps_drawn[i]));
  };
  const double cheap = triangles(painter_, painter_.steps_drawn.size() - 1);
  EXPECT_NEAR(triangles(dear_, calibrating) / cheap, 0.25, 0.05) << "fed forward";
}

TEST_F(WallContentsTest, TheOneThatWasShownLastIsShownFirst) {
  first_content_ = 1;
  run(1, [&](Timestamp) {
    if (feed_.begins.size() < 2) return;
    EXPECT_EQ(interaction().content, 1u);
  });
  EXPECT_EQ(interaction().content, 1u);
  EXPECT_EQ(stats().late, 0u) << "its cost is fed forward";
}

TEST_F(WallContentsTest, AStillWallShowsTheNextOneWhole) {
  feed_.pushed = false;
  run(6, [&](Timestamp now) {
    pressTwice(now);
    if (feed_.begins.size() == 100) {
      EXPECT_EQ(interaction().content, 1u);
      EXPECT_TRUE(stats().full_detail);
    }
  });
  EXPECT_EQ(interaction().content, 0u);
  EXPECT_TRUE(stats().full_detail);
  EXPECT_FALSE(dear_.drawn.empty());
}

TEST_F(WallContentsTest, OneThatIsMissingIsPassedOver) {
  contents_[0].missing = true;
  contents_.push_back({&detail_, &missing_});
  contents_.back().missing = true;
  run(4, [&](Timestamp now) {
    pressTwice(now);
    if (feed_.begins.size() > 2) {
      EXPECT_EQ(interaction().content, 1u);
    }
  });
  EXPECT_TRUE(painter_.drawn.empty());
  EXPECT_TRUE(missing_.drawn.empty()) << "not even to be measured";
  EXPECT_EQ(stats().late, 0u);
}

// Offers another content for one place, once a test sets `due`.
class OneReplacement final : public ContentSource {
 public:
  OneReplacement(std::size_t place, ShownContent content) : fresh_({place, content}) {}
  std::optional<Replacement> take(bool, const Eigen::Isometry3f&) override {
    return due ? std::exchange(fresh_, std::nullopt) : std::nullopt;
  }
  bool due = false;

 private:
  std::optional<Replacement> fresh_;
};

TEST_F(WallContentsTest, WhereAllAreMissingTheFirstThatComesIsShown) {
  for (ShownContent& content : contents_) content.missing = true;
  OneReplacement fresh(1, {&detail_, &dear_});
  replacements_ = &fresh;
  std::vector<std::uint32_t> shown;
  run(3, [&](Timestamp) {
    fresh.due = feed_.begins.size() >= 30;
    if (feed_.begins.size() % 30 == 29) shown.push_back(interaction().content);
  });
  EXPECT_EQ(shown.front(), 0u);
  EXPECT_EQ(shown.back(), 1u);
}

// Two clients send requests at the same time: neither may take the other's answer for its own.
TEST_F(WallContentsTest, WhatBecameOfEachRequestIsPublishedForAWhile) {
  std::map<std::uint32_t, std::string> seen;
  run(2, [&](Timestamp) {
    if (feed_.begins.size() == 10) {
      loop_->finishRequest(2, "");
      loop_->finishRequest(1, "it is cut");
    }
    if (const auto content = content_->read(); content && content->finished > 0)
      seen[content->finished] = textIn(content->refused);
  });
  EXPECT_EQ(seen, (std::map<std::uint32_t, std::string>{{2, ""}, {1, "it is cut"}}));
}

TEST(ShowResults, EachStaysForATenthOfASecondAndTheLastOneForGood) {
  ShowResults results;
  Timestamp now{};
  EXPECT_EQ(results.current(now).number, 0u);
  results.add({7, "no"});
  EXPECT_EQ(results.current(now).number, 7u) << "at once";
  results.add({8, ""});
  now += milliseconds(99);
  EXPECT_EQ(results.current(now).refused, "no");
  now += milliseconds(1);
  EXPECT_EQ(results.current(now).number, 8u);
  now += std::chrono::hours(1);
  EXPECT_EQ(results.current(now).number, 8u);
  for (std::uint32_t n = 100; n < 200; ++n) results.add({n, ""});
  EXPECT_EQ(results.current(now).number, 160u) << "of a flood the oldest are dropped";
}

TEST_F(WallContentsTest, ACommandDoesTheSame) {
  run(3, [&](Timestamp) {
    if (feed_.begins.size() == 30) loop_->request(WallLoop::kNextContent);
  });
  EXPECT_EQ(interaction().content, 1u);
}

// After the two contents of the list there is a third one, which a person has shown.
TEST_F(WallContentsTest, ThePreviousOneIsTheOneThatTheNextOneCameFrom) {
  contents_.push_back({&detail_, &dear_});
  contents_.push_back({&detail_, &dear_});
  contents_[2].missing = true;
  listed_ = 3;
  std::vector<std::uint32_t> shown;
  run(7, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    feed_.actions.next_content = frame == 30 ? 1 : 0;
    feed_.actions.previous_content = frame == 60 || frame == 90 || frame == 150 ? 1 : 0;
    if (frame == 120) loop_->show(3);
    if (frame % 30 == 29 && shown.size() < 6) shown.push_back(interaction().content);
  });
  EXPECT_EQ(shown, (std::vector<std::uint32_t>{0, 1, 0, 1, 3, 1}))
      << "in a circle without the one that is missing; before the file comes what was shown before";
}

TEST_F(WallContentsTest, AReplacedOneIsDrawnFromTheNextFrameAndTheOldOneNeverAgain) {
  OneReplacement fresh(0, {&detail_, &dear_});
  replacements_ = &fresh;
  std::size_t old_frames = 0;
  run(4, [&](Timestamp) {
    if (feed_.begins.size() == 60) {
      fresh.due = true;
      old_frames = painter_.drawn.size() + 1;  // with the frame of this period
    }
  });
  EXPECT_EQ(painter_.drawn.size(), old_frames);
  EXPECT_GT(dear_.drawn.size(), 40u);
  EXPECT_GT(painter_.steps_drawn.back(), 0u);
}

TEST_F(WallContentsTest, AReplacedOneOfAStillWallIsShownWhole) {
  feed_.pushed = false;
  OneReplacement fresh(0, {&detail_, &dear_});
  replacements_ = &fresh;
  std::size_t before = 0;
  run(6, [&](Timestamp) {
    if (feed_.begins.size() != 100) return;
    fresh.due = true;
    EXPECT_TRUE(stats().full_detail);
    before = frames_.frames.size();
  });
  EXPECT_GT(frames_.frames.size(), before);
  EXPECT_TRUE(stats().full_detail);
}

TEST_F(WallContentsTest, AReplacedOneThatIsNotShownWaitsForItsTurn) {
  OneReplacement fresh(1, {&detail_, &painter_});
  fresh.due = true;
  replacements_ = &fresh;
  run(3);
  EXPECT_EQ(dear_.drawn.size(), 3u) << "measured before the first frame, and never again";
}

// Parts of the content are still being loaded while it is shown.
TEST_F(WallContentsTest, AStillWallWaitsForWhatIsBeingLoadedAndDrawsAgainWhenItHasCome) {
  using render::content::Pending;
  feed_.pushed = false;
  painter_.left_out = Pending::kLoading;
  int begun = 0;
  run(6, [&](Timestamp) {
    if (feed_.begins.size() == 90) {
      begun = painter_.refined;
      EXPECT_FALSE(stats().full_detail);
    }
    if (feed_.begins.size() == 100) {
      EXPECT_EQ(painter_.refined, begun) << "nothing is drawn in vain";
      painter_.left_out = Pending::kArrived;
    }
  });
  EXPECT_EQ(painter_.refined, begun + 1);
  EXPECT_TRUE(stats().full_detail);
}

// A tile that could not be read at first can be read later.
TEST_F(WallContentsTest, WhatComesAfterFullDetailIsDrawnToo) {
  using render::content::Pending;
  feed_.pushed = false;
  int begun = 0;
  run(6, [&](Timestamp) {
    if (feed_.begins.size() != 100) return;
    begun = painter_.refined;
    EXPECT_TRUE(stats().full_detail);
    painter_.left_out = Pending::kArrived;
  });
  EXPECT_EQ(painter_.refined, begun + 1);
  EXPECT_TRUE(stats().full_detail);
}

// The second content has two slides; the next slide comes when it is requested.
class Slides final : public ContentSource {
 public:
  explicit Slides(ShownContent content) : content_(content) {}
  std::optional<Replacement> take(bool, const Eigen::Isometry3f&) override {
    if (std::exchange(gone, false)) return Replacement{1, {}, false, 0, "it is gone", true};
    if (!std::exchange(due, false)) return std::nullopt;
    return Replacement{1, content_, true, 7, {}, false};
  }
  bool nextWithin(std::size_t place) override { return place == 1 && parts-- > 0; }
  bool previousWithin(std::size_t place) override { return place == 1 && parts_before-- > 0; }
  void prepare(std::size_t place) override { prepared.push_back(place); }

  int parts = 1, parts_before = 1;
  bool due = false, gone = false;
  std::vector<std::size_t> prepared;

 private:
  ShownContent content_;
};

TEST_F(WallContentsTest, SlidesComeOneAfterAnotherBeforeTheNextContent) {
  Slides slides({&detail_, &dear_});
  replacements_ = &slides;
  run(6, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    feed_.actions.next_content = frame == 30 || frame == 60 || frame == 120 ? 1 : 0;
    if (frame == 61) slides.due = true;
    if (frame == 110) {
      EXPECT_EQ(interaction().content, 1u) << "the second slide";
    }
  });
  EXPECT_EQ(interaction().content, 0u);
  EXPECT_EQ(slides.parts, -1) << "asked for the last time after the second slide";
  ASSERT_GE(slides.prepared.size(), 2u);
  EXPECT_EQ(slides.prepared.back(), 0u);
}

TEST_F(WallContentsTest, BackwardsAllSlidesComeBeforeThePreviousContent) {
  contents_.push_back({&detail_, &painter_});
  Slides slides({&detail_, &dear_});
  replacements_ = &slides;
  first_content_ = 1;
  run(4, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    feed_.actions.previous_content = frame == 30 || frame == 60 ? 1 : 0;
    if (frame == 31) slides.due = true;
    if (frame == 59) {
      EXPECT_EQ(interaction().content, 1u) << "the slide before";
    }
  });
  EXPECT_EQ(interaction().content, 0u);
  EXPECT_EQ(slides.parts_before, -1);
  EXPECT_EQ(slides.parts, 1) << "nobody went forwards";
}

TEST_F(WallContentsTest, WhereNoSlideBeforeCanBeShownThePreviousContentFollows) {
  contents_.push_back({&detail_, &painter_});
  Slides slides({&detail_, &dear_});
  replacements_ = &slides;
  first_content_ = 1;
  run(2, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    feed_.actions.previous_content = frame == 30 ? 1 : 0;
    if (frame == 31) slides.gone = true;
  });
  EXPECT_EQ(interaction().content, 0u);
}

TEST_F(WallContentsTest, WhereNoFurtherSlideCanBeShownTheNextContentFollows) {
  Slides slides({&detail_, &dear_});
  slides.parts = 100;
  replacements_ = &slides;
  run(6, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    feed_.actions.next_content = frame == 30 || frame == 60 || frame == 120 ? 1 : 0;
    if (frame == 61) slides.gone = true;
    if (frame == 61) {
      EXPECT_EQ(interaction().content, 1u);
    }
    if (frame == 65) {
      EXPECT_EQ(interaction().content, 0u) << "the folder is gone";
      slides.gone = true;  // a slide that arrives late changes nothing
    }
    if (frame == 110) {
      EXPECT_EQ(interaction().content, 0u);
    }
  });
  EXPECT_EQ(interaction().content, 1u) << "and has its turn again";
  EXPECT_EQ(slides.parts, 99);
}

// For `merlin show FILE`, there is one place after the contents of the list, for a file that is not
// in the list.
TEST_F(WallContentsTest, AContentThatIsAskedForIsShownAndTheListGoesOnAfterIt) {
  contents_.push_back({&detail_, &dear_});
  listed_ = 2;
  run(4, [&](Timestamp) {
    const auto frame = feed_.begins.size();
    if (frame == 30) loop_->show(2);
    if (frame == 31) loop_->show(99);  // no such content
    feed_.actions.next_content = frame == 60 ? 1 : 0;
    if (frame == 50) {
      EXPECT_EQ(interaction().content, 2u);
    }
  });
  EXPECT_EQ(interaction().content, 1u);
}

}  // namespace
}  // namespace merlin::wall
