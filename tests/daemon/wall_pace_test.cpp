// How the wall holds its rate, and what it reports about that: calibration, feed-forward, the
// ladder, settings by hand; on a virtual clock.
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/wall/pace.h"
#include "tests/support/fake_wall.h"

namespace merlin::wall {
namespace {

class WallPaceTest : public FakeWall {
 protected:
  WallPaceTest() : FakeWall(microseconds(10), 40, {.min_triangles = 100}) {}
  // The detail steps of a picture. At each step the painter takes as long as for a fine model.
  struct PictureSteps final : render::content::DetailAxis {
    std::size_t steps() const noexcept override { return 9; }
    std::size_t costOf(std::size_t step) const noexcept override { return 4096U >> step; }
    std::size_t stepWithin(std::size_t budget) const noexcept override {
      std::size_t step = 0;
      while (step < 8 && costOf(step) > budget) ++step;
      return step;
    }
    std::size_t leastUseful() const noexcept override { return 16; }
    std::string_view unit() const noexcept override { return "kilotexels"; }
  };
  PictureSteps picture_;

  Duration since() const { return clock_.now() - feed_.begins.front(); }
};

// Without calibration, frames in the first second are late. With it, the first frame has as many
// triangles as fit, and is in time.
TEST_F(WallPaceTest, IsCalibratedBeforeTheFirstFrame) {
  calibrated_ = true;
  const Timestamp from = clock_.now();
  run(2);
  EXPECT_LE(feed_.begins.front() - from, std::chrono::seconds(1));
  EXPECT_EQ(stats().late, 0u);
  EXPECT_NEAR(stats().cost_exponent, 1, 0.02);
  EXPECT_NEAR(stats().cost_fixed_ms, 4, 0.01);
  EXPECT_NEAR(frames_.frames.front().cost, 2600, 80);  // (33.3 ms x 0.9 - 4 ms) / 10 us
}

// The view jumps back to the start view, where a triangle costs a quarter, so the next frame has
// four times as many triangles.
TEST_F(WallPaceTest, AJumpToAKnownViewIsFedForward) {
  calibrated_ = true;
  std::size_t at_reset = 0;
  run(3, [&](Timestamp) {
    painter_.slow = since() > milliseconds(500) && at_reset == 0 ? 4 : 1;
    if (since() > milliseconds(2000) && at_reset == 0) {
      at_reset = frames_.frames.size();
      painter_.slow = 1;
      loop_->request(WallLoop::kResetView);
    }
  });
  EXPECT_NEAR(frames_.frames[at_reset - 1].cost, 650, 60);
  EXPECT_NEAR(frames_.frames[at_reset + 1].cost, 2600, 200);
  EXPECT_LE(stats().longest_late, 4u);
}

// 100 triangles take 30 ms, and the tiles add 4 ms, or 1 ms at half size. Later 100 triangles take
// 1 ms again.
TEST_F(WallPaceTest, TheSizeGivesWayFirstAndComesBack) {
  std::uint32_t scale = 0;
  run(40, [&](Timestamp) {
    painter_.slow = since() < std::chrono::seconds(10) ? 30 : 1;
    if (since() > std::chrono::seconds(9) && scale == 0) {
      scale = stats().scale_divisor;
      EXPECT_EQ(painter_.divisor, 2);
      EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
    }
  });
  EXPECT_EQ(scale, 2u);
  EXPECT_EQ(stats().scale_divisor, 1u);
  EXPECT_EQ(painter_.divisor, 1);
  EXPECT_EQ(stats().rate_divisor, 1u);
  EXPECT_EQ(stats().ladder_steps, 2u);
}

// The coarsest detail takes 31 of 33 ms. When motion resumes after a quarter of the period, it does
// not fit, but must be drawn nevertheless.
TEST_F(WallPaceTest, MotionThatResumesNearTheLeastIsDrawn) {
  std::size_t resumed = 0, drawn = 0;
  run(8, [&](Timestamp) {
    painter_.slow = 27;
    feed_.pushed = since() < std::chrono::seconds(4) || since() > milliseconds(4500);
    if (feed_.pushed && since() > std::chrono::seconds(4)) {
      if (++resumed == 1) drawn = painter_.drawn.size();
      if (resumed == 3) {
        EXPECT_GE(painter_.drawn.size(), drawn + 2);
      }
    }
  });
  EXPECT_GT(resumed, 3u);
  EXPECT_EQ(stats().rate_divisor, 1u);
}

// 100 triangles take 44 ms, which is too long for 30 Hz but not for 15 Hz. Later they take 1 ms
// again.
TEST_F(WallPaceTest, TheRateGivesWayByHalvesAndComesBack) {
  std::uint32_t divisor = 0;
  double held = 0;
  run(60, [&](Timestamp) {
    painter_.slow = since() < std::chrono::seconds(10) ? 40 : 1;
    if (since() > std::chrono::seconds(9) && divisor == 0) {
      divisor = stats().rate_divisor;
      held = static_cast<double>(stats().rate_held_hz);
    }
  });
  EXPECT_EQ(divisor, 2u);
  EXPECT_NEAR(held, 15, 0.01);
  EXPECT_EQ(stats().rate_divisor, 1u);
  EXPECT_NEAR(stats().rate_held_hz, 30, 0.01);
  EXPECT_EQ(stats().ladder_steps, 4u) << "the size before it, and back";
  EXPECT_FLOAT_EQ(stats().rate_asked_hz, 30);
}

TEST_F(WallPaceTest, TheOperatorsViewThatGivesWayForLongIsToldOnce) {
  run(4, [&](Timestamp) { painter_.gives_way = since() < std::chrono::seconds(2); });
  EXPECT_EQ(stats().operator_coarser, 1u);
  EXPECT_EQ(stats().ladder_steps, 1u);
  EXPECT_EQ(stats().rate_divisor, 1u);
}

TEST_F(WallPaceTest, TrianglesAndRateAreSetByHandUntilTheyAreGivenBack) {
  std::uint32_t held = 0;
  double rate = 0;
  run(6, [&](Timestamp) {
    if (since() > std::chrono::seconds(1) && since() < std::chrono::seconds(3)) {
      loop_->hold(1000);
      loop_->setRate(20);
    } else if (since() > std::chrono::seconds(3)) {
      if (held == 0) {
        held = frames_.frames.back().cost;
        rate = static_cast<double>(stats().rate_held_hz);
        EXPECT_EQ(stats().held_cost, 1000u);
        EXPECT_FLOAT_EQ(stats().rate_asked_hz, 20);
      }
      loop_->hold(std::nullopt);
      loop_->setRate(std::nullopt);
    }
  });
  EXPECT_NEAR(held, 1000, 2);
  EXPECT_NEAR(rate, 20, 0.01);
  EXPECT_EQ(stats().held_cost, 0u);
  EXPECT_FLOAT_EQ(stats().rate_asked_hz, 30);
  EXPECT_GT(frames_.frames.back().cost, 2300u);
}

// Poses are predicted for the end of the frame, which comes later at a lower rate, whoever has set
// that rate.
TEST_F(WallPaceTest, PosesArePredictedForThePeriodInForce) {
  std::vector<Duration> ahead;
  run(4, [&](Timestamp) {
    if (ahead.size() == 4 || since() < std::chrono::seconds(static_cast<int>(ahead.size()))) return;
    ahead.push_back(feed_.ahead);
    if (ahead.size() == 1) loop_->setRate(60);
    if (ahead.size() == 2) loop_->setRate(20);
    if (ahead.size() == 3) loop_->setRate(std::nullopt);
  });
  EXPECT_EQ(ahead, (std::vector<Duration>{kPeriod, fromSeconds(1.0 / 60), fromSeconds(1.0 / 20),
                                          kPeriod}));
}

// 100 triangles take 44 ms: 15 Hz are held instead of 30.
TEST_F(WallPaceTest, PosesArePredictedForThePeriodThatTheWallWentDownTo) {
  painter_.slow = 40;
  run(5);
  EXPECT_EQ(stats().rate_divisor, 2u);
  EXPECT_EQ(feed_.ahead, fromSeconds(1.0 / 15));
}

// Returns the rates [Hz] to which a load that never fits makes the pace go down, step by step. Ten
// late frames in a row at a rate are one step.
std::vector<double> ratesWhileLate(const render::governor::GovernorSettings& settings,
                                   std::optional<double> by_hand = std::nullopt) {
  render::governor::Governor governor(settings);
  Pace pace(governor);
  pace.setRate(by_hand);
  std::vector<double> rates;
  for (int frame = 0; frame < 200; ++frame) {
    pace.update();
    const double hz = std::round(100 / toSeconds(pace.period())) / 100;
    if (rates.empty() || rates.back() != hz) rates.push_back(hz);
    pace.observe(true, true);
  }
  EXPECT_EQ(pace.sizeDivisor(), 2);
  return rates;
}

// According to [GOURLEY98] B.3, the rate must not fall below 10 frames a second, unless a person
// has set less.
TEST(Pace, GoesDownToTenHertzAndNotBelow) {
  using Rates = std::vector<double>;
  EXPECT_EQ(ratesWhileLate({}), (Rates{30, 15, 10}));
  EXPECT_EQ(ratesWhileLate({.rate_hz = 60}), (Rates{60, 30, 15}));
  EXPECT_EQ(ratesWhileLate({.rate_hz = 24}), (Rates{24, 12}));
  EXPECT_EQ(ratesWhileLate({.rate_hz = 20}), (Rates{20, 10}));
  EXPECT_EQ(ratesWhileLate({.rate_hz = 19}), (Rates{19}));
  EXPECT_EQ(ratesWhileLate({.rate_hz = 5}), (Rates{5}));
  EXPECT_EQ(ratesWhileLate({.min_rate_hz = 5}), (Rates{30, 15, 7.5}));
  EXPECT_EQ(ratesWhileLate({.min_rate_hz = 31}), (Rates{30}));
  EXPECT_EQ(ratesWhileLate({}, 25), (Rates{25, 12.5}));
}

TEST(Pace, LeavesTheStepsThatARateByHandDoesNotHave) {
  render::governor::Governor governor({});
  Pace pace(governor);
  for (int frame = 0; frame < 200; ++frame) {
    pace.update();
    pace.observe(true, true);
  }
  EXPECT_EQ(pace.rateDivisor(), 3);
  const std::uint32_t changes = pace.changes();
  pace.setRate(12);
  pace.update();
  EXPECT_EQ(pace.rateDivisor(), 1);
  EXPECT_EQ(pace.sizeDivisor(), 2);
  EXPECT_EQ(pace.changes(), changes + 1);
}

// The number of triangles that a person may set must be the number that is used.
TEST_F(WallPaceTest, TheLimitsOfTrianglesByHandAreThoseOfTheContent) {
  contents_.push_back({&picture_, &painter_});
  std::vector<std::size_t> least;
  run(4, [&](Timestamp) {
    if (since() < std::chrono::seconds(static_cast<int>(least.size()) + 1)) return;
    least.push_back(loop_->holdLimits().least);
    EXPECT_EQ(loop_->holdLimits().most, 4'000'000u);
    loop_->show(1);
  });
  least.resize(2);
  EXPECT_EQ(least, (std::vector<std::size_t>{100, 16})) << "of the model, and of the picture";
}

// A step of 100 kilotexels, as many units as the minimum of triangles, would be two steps finer.
TEST_F(WallPaceTest, APictureGetsAsCoarseAsItCan) {
  contents_.push_back({&picture_, &painter_});
  run(4, [&](Timestamp) {
    if (since() > std::chrono::seconds(1)) loop_->show(1);
    painter_.slow = since() > std::chrono::seconds(1) ? 2 : 1;
  });
  EXPECT_LT(stats().budget, 32u);
  EXPECT_EQ(painter_.steps_drawn.back(), 8u);
  EXPECT_EQ(stats().cost, 16u);
}

TEST_F(WallPaceTest, DetailByHandEndsWithTheUnitThatItIsIn) {
  contents_.push_back({&detail_, &painter_});
  contents_.push_back({&picture_, &painter_});
  std::vector<std::uint32_t> held;
  run(5.5, [&](Timestamp) {
    if (since() > std::chrono::seconds(static_cast<int>(held.size()) + 1)) {
      held.push_back(stats().held_cost);
      if (held.size() == 1) loop_->hold(1000);
      if (held.size() < 5) loop_->show(held.size() % 3);  // models 1, picture 2, models 0 and 1
    }
  });
  EXPECT_EQ(held, (std::vector<std::uint32_t>{0, 1000, 0, 0, 0}))
      << "another model keeps it, a picture does not, and it does not come back";
}

// The cost per triangle varies by two per cent, but the number of triangles must not change at all.
TEST_F(WallPaceTest, NothingPopsForAFewPerCent) {
  calibrated_ = true;
  run(2);
  const std::size_t level = painter_.steps_drawn.back();
  painter_.steps_drawn.clear();
  for (const Duration cost : {Duration(10'200), Duration(9'800)}) {
    painter_.setCost(cost);
    stop_ = std::stop_source();
    calibrated_ = false;
    run(5);
  }
  ASSERT_GT(painter_.steps_drawn.size(), 250u);
  for (const std::size_t l : painter_.steps_drawn) ASSERT_EQ(l, level);
}

TEST_F(WallPaceTest, SaysHowItsFramesWere) {
  run(10);
  const auto s = stats();
  std::uint32_t all = 0;
  for (const std::uint32_t n : s.work_histogram) all += n;
  EXPECT_NEAR(all, 300, 3);
  EXPECT_GT(s.work_histogram[13] + s.work_histogram[14], 250u);  // 81 to 94 per cent of the period
  EXPECT_EQ(s.oscillation, 0);
  EXPECT_GT(s.budget, 2300u);
}

const std::vector<shm::FrameTrace> all(const shm::Channel<shm::FrameTrace>& channel) {
  std::vector<shm::FrameTrace> frames;
  const std::uint64_t count = channel.count();
  for (std::uint64_t n = count > 256 ? count - 255 : 0; n < count; ++n) {
    if (const auto frame = channel.at(n)) frames.push_back(*frame);
  }
  return frames;
}

// The steps are input, scene, governor, cut, the tile, its pixels, present; they must be in this
// order and within the frame.
TEST_F(WallPaceTest, TellsEachStepOfEachFrame) {
  run(2, [&](Timestamp) { feed_.pushed = since() < std::chrono::seconds(1); });
  const auto frames = all(*trace_);
  ASSERT_GT(frames.size(), 50u);
  using shm::StepKind;
  const StepKind moving[] = {StepKind::kInput,  StepKind::kScene, StepKind::kGovernor,
                             StepKind::kCut,    StepKind::kDraw,  StepKind::kReadBack,
                             StepKind::kPresent};
  for (const shm::FrameTrace& f : frames) {
    std::uint32_t end = 0;
    for (std::uint32_t i = 0; i < f.count; ++i) {
      EXPECT_GE(f.steps[i].begin_ns, end);
      end = f.steps[i].begin_ns + f.steps[i].length_ns;
    }
    EXPECT_LE(f.begin_ns + end, f.end_ns);
    EXPECT_EQ(f.late, f.moving && f.end_ns > f.deadline_ns ? 1u : 0u);
    if (!f.moving || f.count <= 3) continue;  // or there was no time to draw a frame
    ASSERT_EQ(f.count, 7u);
    for (int i = 0; i < 7; ++i) EXPECT_EQ(f.steps[i].kind, moving[i]);
  }
  EXPECT_TRUE(std::any_of(frames.begin(), frames.end(), [](const shm::FrameTrace& f) {
    return f.moving == 0 && f.count >= 3 && f.steps[2].kind == StepKind::kRefine;
  }));
}

// Some frames take several periods, and later frames are then left out for lack of time. The charts
// must show as many late frames as the statistics count.
TEST_F(WallPaceTest, TellsEachDeadlineThatWasMissed) {
  calibrated_ = true;
  run(4, [&](Timestamp) {
    const auto tenths = since() / milliseconds(100);
    const bool begins = since() % milliseconds(100) < kPeriod;
    painter_.slow = begins && tenths % 10 == 5 ? 2 + static_cast<int>(tenths / 10) : 1;
  });
  const auto frames = all(*trace_);
  std::uint64_t late = 0, run_over = 0, left_out = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const shm::FrameTrace& f = frames[i];
    EXPECT_EQ(f.period, i);
    EXPECT_EQ(f.late, f.end_ns > f.deadline_ns ? 1U : 0U);
    late += f.late;
    left_out += f.count == 3 ? 1 : 0;
    if (f.count > 0) continue;
    ++run_over;
    EXPECT_EQ(f.begin_ns, frames[i - 1].deadline_ns);
    EXPECT_TRUE(f.moving && f.late);
  }
  EXPECT_GE(run_over, 2U);
  EXPECT_GE(left_out, 1U);
  EXPECT_EQ(late, stats().late);
  EXPECT_EQ(frames.size(), stats().deadlines);
}

}  // namespace
}  // namespace merlin::wall
