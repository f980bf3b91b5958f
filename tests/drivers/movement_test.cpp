#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "drivers/hand/movement_recording.h"

namespace merlin::hand {
namespace {

double speedOf(const TrackerSample& a, const TrackerSample& b) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double step = static_cast<double>(b.position_m[i]) - static_cast<double>(a.position_m[i]);
    square += step * step;
  }
  return std::sqrt(square) / (static_cast<double>(b.received_ns - a.received_ns) * 1e-9);
}

TEST(Movement, AMoveIsDoneAtItsEndAndFastestInItsMiddle) {
  Movement movement({});
  Move move;
  move.seconds = 2;
  move.way.position_m = {0.4, 0, 0};
  movement.add(move);
  EXPECT_EQ(movement.at(0).position_m[0], 0);
  EXPECT_NEAR(movement.at(1).position_m[0], 0.2, 1e-12);
  EXPECT_NEAR(movement.at(1.01).position_m[0] - movement.at(1).position_m[0],
              1.875 * 0.4 / 2 * 0.01, 1e-5)
      << "the greatest speed of a minimum-jerk move is 1.875 times its mean";
  EXPECT_NEAR(movement.at(3).position_m[0], 0.4, 1e-12);
  EXPECT_NEAR(movement.end().position_m[0], 0.4, 1e-12);
}

TEST(Movement, OverlappingMovesAddUp) {
  Movement movement({});
  Move there, back;
  there.way.position_m = {0.3, 0, 0};
  back.begin_s = 0.5;
  back.way.position_m = {-0.3, 0.1, 0};
  movement.add(there);
  movement.add(back);
  EXPECT_NEAR(movement.at(0.75).position_m[0], 0.3 * (minimumJerk(0.75) - minimumJerk(0.25)),
              1e-12);
  EXPECT_NEAR(movement.at(2).position_m[0], 0, 1e-12);
  EXPECT_NEAR(movement.at(2).position_m[1], 0.1, 1e-12);
}

TEST(Movement, ACircleGoesRoundToWhereItBegan) {
  Movement movement({});
  Move circle;
  circle.radius_m = {0.1, 0.1};
  circle.turns = 1;
  movement.add(circle);
  EXPECT_NEAR(movement.at(0.5).position_m[0], 0, 1e-9);
  EXPECT_NEAR(movement.at(0.5).position_m[1], -0.2, 1e-9) << "it began at the top";
  EXPECT_NEAR(movement.at(1).position_m[1], 0, 1e-9);
  Movement early({});
  early.add(circle);
  EXPECT_GT(early.at(0.25).position_m[0], 0.05) << "clockwise: to the right first";
}

TEST(MovingPeople, AreTheSameForTheSameSeedAndDifferForOthers) {
  const auto one = makeGestures(MovingPerson(3), 1, 7), again = makeGestures(MovingPerson(3), 1, 7);
  ASSERT_EQ(one.samples.size(), again.samples.size());
  for (std::size_t n = 0; n < one.samples.size(); ++n) {
    EXPECT_EQ(one.samples[n].received_ns, again.samples[n].received_ns);
    EXPECT_EQ(one.samples[n].position_m[0], again.samples[n].position_m[0]);
  }
  EXPECT_NE(MovingPerson(3).tempo(), MovingPerson(4).tempo());
  EXPECT_EQ(MovingPerson(0).tempo(), 1);
}

TEST(MovingPeople, MakeEachGestureInItsDirection) {
  std::set<std::string> names;
  for (const MovingGesture& gesture : movingGestures()) names.insert(gesture.name);
  EXPECT_EQ(names.size(), 10u);
  // The average person swipes to the right along the transmitter's -y.
  const auto made = makeGestures(MovingPerson(0), 1, 1);
  ASSERT_EQ(made.made.size(), 10u);
  for (const MadeGesture& gesture : made.made) {
    if (std::string(gesture.name) != "swipe_right") continue;
    const TrackerSample *first = nullptr, *last = nullptr;
    for (const TrackerSample& s : made.samples) {
      if (s.received_ns < gesture.began_ns || s.received_ns > gesture.ended_ns) continue;
      if (!first) first = &s;
      last = &s;
    }
    ASSERT_TRUE(first && last);
    EXPECT_NEAR(static_cast<double>(last->position_m[1] - first->position_m[1]), -0.48, 0.05);
  }
}

// The tracker's positions must not jump, and no hand may be faster than a person's can be.
TEST(MovingPeople, MoveAsHandsCan) {
  for (std::uint64_t person = 1; person <= 10; ++person) {
    const auto walked = goAbout(MovingPerson(person), 60, person);
    EXPECT_TRUE(walked.made.empty());
    EXPECT_GE(walked.samples.back().received_ns - walked.samples.front().received_ns,
              55'000'000'000);
    for (std::size_t n = 1; n < walked.samples.size(); ++n) {
      ASSERT_GT(walked.samples[n].received_ns, walked.samples[n - 1].received_ns);
      if (walked.samples[n].received_ns - walked.samples[n - 1].received_ns < 5'000'000) continue;
      ASSERT_LT(speedOf(walked.samples[n - 1], walked.samples[n]), 6) << person;
    }
  }
}

}  // namespace
}  // namespace merlin::hand
