// A model whose full detail takes seconds to draw, on a virtual clock: soon after a standstill the
// wall shows finer detail, and motion is in time whenever it resumes.
#include <gtest/gtest.h>

#include "render/frame/replaceable_correction.h"
#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

// The costs are in proportion to those of a model of 10 million triangles on a software renderer:
// in motion, one triangle in 20 fits into a frame; full detail takes 3,000 slices, which are 9 s.
class BigModelTest : public FakeWall {
 protected:
  BigModelTest()
      : FakeWall(microseconds(100), 3000, {.min_triangles = 50, .first_triangles = 200}) {
    calibrated_ = true;
  }
  Duration since() const { return clock_.now() - feed_.begins.front(); }
};

// The ball may be released at any time within a period.
TEST_F(BigModelTest, IsFinerWithinAQuarterOfASecondOfStandstill) {
  for (int phase_ms = 0; phase_ms < 34; phase_ms += 3) {
    feed_.begins.clear();
    frames_.frames.clear();
    stop_ = std::stop_source();
    const Duration moves = milliseconds(2000 + phase_ms);
    std::optional<Timestamp> let_go;
    run(4, [&](Timestamp) {
      feed_.pushed = since() < moves;
      let_go = feed_.begins.front() + moves;
    });
    const auto moving = std::find_if(frames_.frames.rbegin(), frames_.frames.rend(),
                                     [&](auto& f) { return f.finished < *let_go; });
    const auto finer = std::find_if(frames_.frames.begin(), frames_.frames.end(), [&](auto& f) {
      return f.finished > *let_go && f.cost > 1.2 * moving->cost;
    });
    ASSERT_NE(finer, frames_.frames.end());
    EXPECT_LE(finer->finished - *let_go, milliseconds(250)) << phase_ms;
    EXPECT_GT(stats().still_to_first_s, 0.03F);
  }
}

TEST_F(BigModelTest, GetsFinerInStepsAndThenWhole) {
  run(16, [&](Timestamp) { feed_.pushed = since() < std::chrono::seconds(2); });
  std::vector<std::uint32_t> shown;
  for (const auto& f : frames_.frames) {
    if (shown.empty() || f.cost != shown.back()) shown.push_back(f.cost);
  }
  ASSERT_GE(shown.size(), 3u);
  EXPECT_EQ(shown.back(), model().triangleCount());
  EXPECT_TRUE(frames_.frames.back().full_detail);
  EXPECT_FALSE((frames_.frames.rbegin() + 1)->full_detail);
  // The slices take 9 s, and only a part of each period may be used for them.
  EXPECT_NEAR(stats().still_to_full_s, 10, 0.5);
  EXPECT_LE(stats().late, 1u);
}

// At whatever point of the refinement motion resumes, the first frame that begins after the input
// must meet its deadline, and the next one must be as fine as the last one in motion.
TEST_F(BigModelTest, MotionAfterAStillPictureIsInTime) {
  for (int still_ms = 160; still_ms < 2000; still_ms += 37) {
    feed_.begins.clear();
    frames_.frames.clear();
    painter_.steps_drawn.clear();
    stop_ = std::stop_source();
    std::optional<Timestamp> published;
    std::size_t level = 0, drawn = 0;
    run(5, [&](Timestamp now) {
      const Duration t = now - feed_.begins.front();
      feed_.pushed = t < std::chrono::seconds(2) || t > milliseconds(2150 + still_ms);
      if (!feed_.pushed && t < milliseconds(2100)) level = painter_.steps_drawn.back();
      if (feed_.pushed && t > std::chrono::seconds(2) && !published) {
        published = now;
        drawn = painter_.steps_drawn.size();
      }
    });
    const auto first = std::find_if(frames_.frames.begin(), frames_.frames.end(),
                                    [&](const auto& f) { return f.finished > *published; });
    ASSERT_NE(first, frames_.frames.end());
    EXPECT_LE(first->finished - *published, kPeriod) << still_ms;
    EXPECT_GT(painter_.steps_drawn[drawn], level)
        << "cores that slept are slow at first; " << still_ms;
    EXPECT_EQ(painter_.steps_drawn[drawn + 1], level) << still_ms;
    EXPECT_EQ(stats().resumed_late, 0u) << still_ms;
  }
}

// A model whose full detail takes 40 slices.
class FadingTest : public FakeWall {
 protected:
  FadingTest() {
    fade_frames_ = 3;
    painter_.pixels_.resize(4);
  }
};

TEST_F(FadingTest, FullDetailComesInThreeFramesAPeriodApart) {
  run(4, [&](Timestamp now) { feed_.pushed = now - feed_.begins.front() < milliseconds(2000); });
  const auto& f = frames_.frames;
  ASSERT_GT(f.size(), 10U);
  EXPECT_TRUE(f.back().full_detail);
  EXPECT_FALSE((f.end() - 2)->full_detail) << "it is not, until it is there";
  EXPECT_EQ((f.end() - 2)->cost, model().triangleCount());
  EXPECT_EQ(frames_.firsts.back(), FakePainter::kRefined);
  EXPECT_LT(*(frames_.firsts.end() - 2), FakePainter::kRefined);
  EXPECT_GT(*(frames_.firsts.end() - 2), *(frames_.firsts.end() - 3));
  const Duration apart = f.back().finished - (f.end() - 3)->finished;
  EXPECT_GT(apart, kPeriod);
  EXPECT_LT(apart, 3 * kPeriod);
  EXPECT_NEAR(stats().still_to_full_s,
              toSeconds(f.back().finished - (feed_.begins.front() + milliseconds(2000))), 0.2);
}

TEST_F(FadingTest, MotionEndsItAtOnce) {
  bool faded = false;
  run(4, [&](Timestamp now) {
    faded |= !frames_.firsts.empty() && frames_.firsts.back() > FakePainter::kMoving;
    feed_.pushed = faded || now - feed_.begins.front() < milliseconds(2000);
  });
  ASSERT_TRUE(faded);
  EXPECT_EQ(frames_.firsts.back(), FakePainter::kMoving);
  EXPECT_EQ(std::ranges::count_if(frames_.firsts, [](int byte) { return byte > 0; }), 1);
}

using WallStillTest = FakeWall;

// A correction whose signal is one pixel of this value.
struct OneValue final : render::frame::Correction {
  explicit OneValue(std::uint8_t value) : pixel{value, value, value, 255} {}
  render::out::Signal apply(const render::out::Signal&) override { return {1, 1, pixel}; }
  std::uint8_t pixel[4];
};

TEST_F(WallStillTest, ACorrectionThatIsReplacedIsShownInTheNextPeriodAndOnce) {
  feed_.pushed = false;
  auto made = std::make_unique<render::frame::ReplaceableCorrection>(std::make_unique<OneValue>(7));
  render::frame::ReplaceableCorrection& correction = *made;
  corrections_.push_back(std::move(made));
  std::size_t before = 0;
  run(6, [&](Timestamp) {
    if (feed_.begins.size() == 150) {
      before = frames_.frames.size();
      EXPECT_EQ(frames_.firsts.back(), 7);
      correction.replace(std::make_unique<OneValue>(8));
    }
    if (feed_.begins.size() != 151) return;
    EXPECT_EQ(frames_.firsts.back(), 8);
  });
  EXPECT_EQ(frames_.frames.size(), before + 1);
  EXPECT_TRUE(stats().full_detail) << "of the picture that stands";
}

TEST_F(WallStillTest, WhatBoundInputsMoveIsPassedOn) {
  std::vector<AlignInput> asked;
  on_align_ = [&](const AlignInput& input) { asked.push_back(input); };
  run(1, [&](Timestamp) {
    if (feed_.begins.size() == 10) feed_.actions.align.actions = {3, 3};
  });
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].actions, (std::vector<std::uint8_t>{3, 3}));
}

}  // namespace
}  // namespace merlin::wall
