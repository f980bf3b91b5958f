// The governor in a closed loop with a fake renderer: where its budget settles, and how many frames
// are late meanwhile.
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "render/governor/governor.h"

namespace merlin::render {
namespace {

// A frame of T triangles takes a + c T^p; log-normal noise multiplies the part c T^p.
struct FakeRenderer {
  double fixed_s, full_s;  // full_s: time of 100,000 triangles without the fixed part
  double exponent;
  double noise = 0;  // standard deviation of the logarithm

  double drawing(std::size_t triangles) const {
    return full_s * std::pow(static_cast<double>(triangles) / 1e5, exponent);
  }
  governor::FrameCost draw(std::size_t triangles, Duration period, Random& random) const {
    const double work = fixed_s + drawing(triangles) * std::exp(noise * random.normal());
    return {triangles, fromSeconds(fixed_s), fromSeconds(work), fromSeconds(work) > period};
  }
};

struct Loop {
  governor::Governor governor{governor::GovernorSettings{}};
  Random random{1};
  std::size_t frames = 0, late = 0;
  double work_s = 0;

  void run(const FakeRenderer& renderer, int count) {
    frames = late = 0;
    work_s = 0;
    for (int i = 0; i < count; ++i) step(renderer);
  }
  // Draws one frame; returns whether it was late.
  bool step(const FakeRenderer& renderer) {
    const governor::FrameCost cost = renderer.draw(governor.budget(), governor.period(), random);
    governor.observe(cost);
    ++frames;
    late += cost.late ? 1U : 0U;
    work_s += toSeconds(cost.work);
    return cost.late;
  }
  double lateShare() const { return static_cast<double>(late) / static_cast<double>(frames); }
  double utilisation() const {  // as a share of the period
    return work_s / static_cast<double>(frames) / toSeconds(governor.period());
  }
};

class CostModels : public testing::TestWithParam<FakeRenderer> {};

// The target is 90 per cent of the period; a change of less than 3 per cent is not made.
TEST_P(CostModels, SettlesAtTheRateLessTheHeadRoom) {
  Loop loop;
  loop.run(GetParam(), 150);
  EXPECT_LE(loop.late, 10u) << "of the first: it starts with 10,000 and does not know";
  loop.run(GetParam(), 100);
  EXPECT_EQ(loop.late, 0u);
  EXPECT_GT(loop.utilisation(), 0.86);
  EXPECT_LT(loop.utilisation(), 0.94);
}

// With noise the head room grows a little: at most one frame in 50 is late, and less than a third
// of the period is unused.
TEST_P(CostModels, HoldsTheRateWithNoise) {
  FakeRenderer renderer = GetParam();
  renderer.noise = 0.06;
  Loop loop;
  loop.run(renderer, 500);
  loop.run(renderer, 3000);
  EXPECT_LT(loop.lateShare(), 0.02);
  EXPECT_GT(loop.utilisation(), 0.75);
  EXPECT_LT(loop.utilisation(), 0.92);
}

TEST_P(CostModels, FourTimesDearerIsRecoveredWithinThreeFrames) {
  Loop loop;
  loop.run(GetParam(), 200);
  FakeRenderer dearer = GetParam();
  dearer.full_s *= 4;
  loop.run(dearer, 2);
  EXPECT_LE(loop.late, 2u);
  int more = 0;
  while (more < 20 && loop.step(dearer)) ++more;
  EXPECT_LE(more, GetParam().exponent < 0.6 ? 2 : 1) << "late frames after the second";
  loop.run(dearer, 100);
  EXPECT_LE(loop.late, 2u);
}

TEST_P(CostModels, FourTimesCheaperIsUsedWithinThreeSeconds) {
  FakeRenderer dearer = GetParam();
  dearer.full_s *= 4;
  Loop loop;
  loop.run(dearer, 200);
  loop.run(GetParam(), 90);
  EXPECT_LE(loop.late, GetParam().exponent > 0.8 ? 2u : 0u) << "it takes p for 0.65";
  loop.run(GetParam(), 10);
  EXPECT_GT(loop.utilisation(), 0.84);
}

std::string nameOf(const testing::TestParamInfo<FakeRenderer>& info) {
  const auto whole = [](double x) { return std::to_string(std::lround(x)); };
  return "a" + whole(1e3 * info.param.fixed_s) + "ms_c" + whole(1e3 * info.param.full_s) + "ms_p" +
         whole(100 * info.param.exponent);
}

// Exponents p from fill-bound to geometry-bound, in models of 20,000 to 100,000 triangles.
const FakeRenderer kModels[] = {{0.000, 0.030, 0.50}, {0.004, 0.020, 0.62}, {0.004, 0.100, 0.65},
                                {0.010, 0.050, 0.75}, {0.002, 0.040, 0.88}, {0.001, 0.030, 1.00},
                                {0.012, 0.100, 1.00}};
INSTANTIATE_TEST_SUITE_P(Models, CostModels, testing::ValuesIn(kModels), nameOf);

// With this noise, the head room for each share of late frames lies within its bounds, so the
// governor can learn it: over 20,000 frames the share late is within a fifth of the requested one.
TEST(GovernorLateShare, IsTheOneAskedFor) {
  for (const double share : {0.005, 0.01, 0.02, 0.05}) {
    const FakeRenderer renderer{0.002, 0.050, 0.7, 0.10};
    Loop loop{governor::Governor({.late_share = share})};
    loop.run(renderer, 2000);
    loop.run(renderer, 20'000);
    EXPECT_NEAR(loop.lateShare(), share, 0.2 * share);
    EXPECT_GE(loop.governor.headRoom(), 0.10);
    EXPECT_LT(loop.governor.headRoom(), 0.30);
  }
}

TEST(GovernorLateShare, NoiseTakesHeadRoomAndQuietGivesItBack) {
  Loop loop;
  loop.run({0.002, 0.050, 0.7, 0.12}, 3000);
  EXPECT_GT(loop.governor.headRoom(), 0.18);
  loop.run({0.002, 0.050, 0.7, 0.0}, 2000);
  EXPECT_DOUBLE_EQ(loop.governor.headRoom(), 0.10);
  EXPECT_EQ(loop.late, 0u);
}

// The machine's speed changes by a factor of 1.35, each time for several seconds; only a few frames
// may be late at each change.
TEST(GovernorLoop, LivesWithAMachineThatChangesItsSpeed) {
  const FakeRenderer fast{0.004, 0.060, 0.62, 0.03};
  FakeRenderer slow = fast;
  slow.full_s *= 1.35;
  Loop loop;
  loop.run(fast, 300);
  std::size_t late = 0;
  for (int change = 0; change < 20; ++change) {
    loop.run(change % 2 == 0 ? slow : fast, 90);
    late += loop.late;
    EXPECT_GT(loop.utilisation(), 0.65);
  }
  EXPECT_LE(late, 40u);  // of 1,800 frames: two for each change
}

}  // namespace
}  // namespace merlin::render
