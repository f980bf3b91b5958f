#include "drivers/hand/people.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "drivers/cyberglove/settings.h"
#include "drivers/hand/recording.h"

namespace merlin::hand {
namespace {

TEST(Shapes, ThirtyOneWithNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Shape& shape : allShapes()) names.insert(shape.name);
  EXPECT_EQ(names.size(), 31u);
  EXPECT_EQ(allShapes().size(), 31u);
  EXPECT_EQ(shapes().size(), 8u);
}

TEST(People, ACountIsWhatTheShippedCalibrationSays) {
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    if (slot == 7) continue;
    EXPECT_NEAR(kJointSpans[slot].rad_per_count, std::abs(kDefaultGloveSpans[slot].gain()), 1e-5)
        << slot;
  }
}

TEST(People, OneSeedIsOnePerson) {
  const Shape& fist = *findShape("fist");
  EXPECT_EQ(Person(3).pose(fist), Person(3).pose(fist));
  EXPECT_NE(Person(3).pose(fist), Person(4).pose(fist));
  EXPECT_EQ(Person(0).pose(fist), fist.angle_rad) << "the average person";
}

TEST(People, TheGloveSaysWholeCountsAndNothingOfSlotSeven) {
  Random random(1);
  const Angles sensed = Person(5).sense(findShape("claw")->angle_rad, random);
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    const double counts = double{sensed[slot]} / double{kJointSpans[slot].rad_per_count};
    EXPECT_NEAR(counts, std::round(counts), 1e-3) << slot;
  }
  EXPECT_EQ(sensed[7], 0.0F);
}

TEST(People, JointsStayWithinWhatAHandCanDo) {
  PeopleSettings quiet;
  quiet.fit = quiet.cross_talk = quiet.sensor_counts = 0;
  Random random(2);
  Angles far{};
  far.fill(9.0F);
  const Angles sensed = Person(1, quiet).sense(far, random);
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    const float high = slot == 7 ? 0 : kJointSpans[slot].high_rad;
    EXPECT_NEAR(sensed[slot], high, kJointSpans[slot].rad_per_count / 2 + 1e-5F) << slot;
  }
}

TEST(People, ASensorPicksUpItsNeighbours) {
  PeopleSettings loud;
  loud.fit = loud.tremor = loud.sensor_counts = loud.size = loud.joint = 0;
  loud.cross_talk = 0.5;
  Random random(3);
  Angles bent{};
  bent[5] = 1.0F;
  const Angles sensed = Person(1, loud).sense(bent, random);
  EXPECT_NE(sensed[4], 0.0F);
  EXPECT_NE(sensed[6], 0.0F);
  EXPECT_EQ(sensed[9], 0.0F);
}

TEST(Recording, HasEveryTakeOfEveryPersonOfEveryShape) {
  const auto shots = record(shapes(), {.people = 3, .takes = 2, .per_take = 4}, 1);
  ASSERT_EQ(shots.size(), 8u * 3 * 2 * 4);
  EXPECT_STREQ(shots[23].shape, "open");
  EXPECT_STREQ(shots[24].shape, "fist");
}

TEST(Recording, OneSeedGivesOneRecording) {
  const auto a = record(shapes(), {}, 1), b = record(shapes(), {}, 1), c = record(shapes(), {}, 2);
  for (std::size_t n = 0; n < a.size(); ++n) ASSERT_EQ(a[n].angle_rad, b[n].angle_rad);
  EXPECT_NE(a[0].angle_rad, c[0].angle_rad);
}

TEST(Recording, FingersGoOneAfterTheOtherAndAllArrive) {
  for (std::size_t slot = 0; slot < kGloveSlots; ++slot) {
    EXPECT_EQ(wayDone(slot, 0), 0);
    EXPECT_EQ(wayDone(slot, 1), 1);
  }
  EXPECT_GT(wayDone(4, 0.5), wayDone(16, 0.5));
}

TEST(Recording, AHandGoesFromShapeToShape) {
  const auto shots = goThrough(shapes(), Person(1), 10, 5, 1);
  ASSERT_EQ(shots.size(), 8u * 10 + 7u * 5);
  EXPECT_STREQ(shots[9].shape, "open");
  EXPECT_EQ(shots[10].shape, nullptr);
  EXPECT_STREQ(shots[15].shape, "fist");
}

}  // namespace
}  // namespace merlin::hand
