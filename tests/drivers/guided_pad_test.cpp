// Finds which axes of an input device a person means, from the axes that were moved at each
// request.
#include "drivers/port/guided_pad.h"

#include <gtest/gtest.h>

namespace merlin {
namespace {

using Readings = std::vector<AxisReading>;

// Returns the readings of a gamepad at rest: two sticks, one of which is slightly off-centre, and
// two triggers.
Readings atRest() { return {{"x", 0}, {"y", 0.04F}, {"z", -1}, {"rx", 0}, {"ry", 0}, {"rz", -1}}; }

// Returns the readings of the gamepad at rest, except for one axis.
Readings with(const std::string& name, float deflection) {
  Readings readings = atRest();
  for (AxisReading& reading : readings) {
    if (reading.name == name) reading.deflection = deflection;
  }
  return readings;
}

Result<PadAnswer> answer(GuidedPad& guided, std::size_t step, const std::vector<Readings>& all) {
  guided.begin(step);
  for (const Readings& readings : all) guided.add(readings);
  return guided.end();
}

GuidedPad rested() {
  GuidedPad guided;
  EXPECT_TRUE(answer(guided, 0, {atRest(), with("y", 0.06F)}));
  return guided;
}

TEST(GuidedPad, FindsSticksReversedOnesAndAPairOfTriggers) {
  GuidedPad guided = rested();
  EXPECT_EQ(answer(guided, 1, {atRest(), with("x", 1)})->source, "x");
  EXPECT_EQ(answer(guided, 2, {with("rz", 0.2F), with("rz", 1)})->source, "rz-z");
  EXPECT_EQ(answer(guided, 3, {with("y", -0.9F)})->source, "-y");
  EXPECT_EQ(answer(guided, 4, {atRest()})->source, "none") << "few devices have six axes";
  EXPECT_EQ(answer(guided, 5, {with("rx", 1)})->source, "rx");
  EXPECT_EQ(answer(guided, 6, {with("ry", 0.1F)})->source, "none") << "touched, not moved";
  const auto solved = guided.solve();
  ASSERT_TRUE(solved);
  EXPECT_EQ(solved->axes, (std::vector<std::string>{"x", "rz-z", "-y", "none", "rx", "none"}));
  EXPECT_DOUBLE_EQ(solved->dead_zone, 0.11) << "1.5 times the hanging 0.06, and 0.02";
}

TEST(GuidedPad, TriggersThatRestAtTheUpperEndMakeThePairTheOtherWayRound) {
  GuidedPad guided;
  ASSERT_TRUE(answer(guided, 0, {{{"gas", 1}, {"brake", 1}}}));
  EXPECT_EQ(answer(guided, 2, {{{"gas", -1}, {"brake", 1}}})->source, "brake-gas");
}

TEST(GuidedPad, SaysWhatCannotBeUsed) {
  GuidedPad guided;
  EXPECT_EQ(answer(guided, 0, {atRest(), with("x", 0.5F)}).error().what,
            "x moved by 0.25 (0.2 are taken for noise): was it touched?");
  guided = rested();
  EXPECT_EQ(answer(guided, 1, {with("x", 0.3F)}).error().what,
            "x moved the most, by 0.30 (0.5 are needed): move it further");
  Readings both = with("x", 1);
  both[4].deflection = -0.8F;
  EXPECT_EQ(answer(guided, 1, {both}).error().what,
            "two axes moved alike, x by 1.00 and ry by 0.80: move one only");
  ASSERT_TRUE(answer(guided, 1, {with("rz", 1)}));
  EXPECT_EQ(answer(guided, 2, {with("z", 1)}).error().what,
            "rz answered, as it did to \"right\": move something else, or nothing");
}

TEST(GuidedPad, ALonelyTriggerIsRefused) {
  GuidedPad guided;
  ASSERT_TRUE(answer(guided, 0, {{{"x", 0}, {"gas", -1}}}));
  EXPECT_EQ(answer(guided, 1, {{{"x", 0}, {"gas", 1}}}).error().what,
            "gas is a trigger, which rests at its end and needs another one that pulls the other "
            "way: there is none; move something else, or give --axes");
}

TEST(GuidedPad, NothingMovedIsNoResult) {
  GuidedPad guided = rested();
  for (std::size_t step = 1; step < padSteps().size(); ++step)
    ASSERT_TRUE(answer(guided, step, {atRest()}));
  EXPECT_FALSE(guided.solve());
}

// A VRPN server sends a channel when it changes, so the first value may arrive while a stick is
// deflected.
TEST(GuidedPad, AnAxisThatWasSilentAtRestRestsInTheMiddle) {
  GuidedPad guided;
  ASSERT_TRUE(answer(guided, 0, {}));
  EXPECT_EQ(answer(guided, 1, {{{"0", -1}, {"1", 0}}})->source, "-0");
}

}  // namespace
}  // namespace merlin
