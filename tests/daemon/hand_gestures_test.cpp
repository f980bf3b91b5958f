#include "daemon/devices/hand_gestures.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "drivers/hand/hand.h"
#include "drivers/hand/movement_recording.h"
#include "nn/io/gesture_file.h"
#include "tests/support/count_allocations.h"

namespace merlin::devices {
namespace {

constexpr std::size_t kGrab = actionIndex("grab"), kLamp = actionIndex("lamp_on"),
                      kReset = actionIndex("reset_view"), kNext = actionIndex("next_content");

nn::GestureModel shipped() {
  return nn::loadGestures(MERLIN_SOURCE_DIR "/config/gestures.json")->model;
}

class HandGesturesTest : public testing::Test {
 protected:
  HandGestures make(const std::optional<nn::GestureModel>& model) {
    return {model,
            {{}, {&glove_}},
            actions::ActionWriter({{"gesture.circle_clockwise", "next_content"},
                                   {"hand.gesture.push", "reset_view"},
                                   {"other.gesture.pull", "lamp_on"}},
                                  {"hand", std::nullopt, true}, 1, actions_),
            state_};
  }
  // Returns the poses of a synthetic person who makes each gesture once, with the intended
  // gestures.
  static hand::Performance performance() {
    return hand::makeGestures(hand::MovingPerson(7003), 1, 11);
  }
  static std::vector<HandSample> smooth(const hand::Performance& performance) {
    hand::Hand hand({});
    std::vector<HandSample> samples;
    for (const TrackerSample& sample : performance.samples)
      samples.push_back(hand.update(sample, std::nullopt));
    return samples;
  }
  void hold(std::size_t action, bool holds) {
    shm::ActionState state{};
    state.held[action] = holds ? 1 : 0;
    glove_.publish(state);
  }
  shm::ActionState begun() const { return actions_.read().value_or(shm::ActionState{}); }
  GestureState state() const { return state_.read().value_or(GestureState{}); }

  shm::SeqSlot<shm::ActionState> glove_, actions_;
  shm::SeqSlot<GestureState> state_;
};

TEST_F(HandGesturesTest, EachIsPublishedByNameAndBeginsItsActionOnce) {
  HandGestures gestures = make(shipped());
  const hand::Performance made = performance();
  std::map<std::string, int> seen;
  std::uint32_t before = 0;
  for (const HandSample& sample : smooth(made)) {
    gestures.update(sample);
    if (state().counter == before) continue;
    before = state().counter;
    ++seen[state().name];
    EXPECT_EQ(state().received_ns, sample.received_ns);
    EXPECT_LT(state().began_ns, sample.received_ns);
    EXPECT_GT(state().certainty, 0.0F);
  }
  std::map<std::string, int> meant;
  for (const hand::MadeGesture& gesture : made.made) ++meant[gesture.name];
  EXPECT_EQ(seen, meant);
  EXPECT_EQ(begun().begun[kNext], 1u);
  EXPECT_EQ(begun().begun[kReset], 1u);
  EXPECT_EQ(begun().begun[kLamp], 0u) << "another hand's";
  EXPECT_EQ(begun().sequence, 2u);
  EXPECT_EQ(state().passed_over, 0u);
}

TEST_F(HandGesturesTest, WhileThePersonHoldsTheModelThereAreNone) {
  for (const std::size_t action : {kGrab, actionIndex("fly"), actionIndex("point_at")}) {
    HandGestures gestures = make(shipped());
    hold(action, true);
    for (const HandSample& sample : smooth(performance())) gestures.update(sample);
    EXPECT_EQ(state().counter, 0u);
    EXPECT_GE(state().passed_over, 9u);
    EXPECT_EQ(begun().sequence, 0u);
  }
  HandGestures gestures = make(shipped());
  hold(actionIndex("align_push"), true);
  for (const HandSample& sample : smooth(performance())) gestures.update(sample);
  EXPECT_EQ(state().counter, 10u) << "which moves a corner, not the model";
}

// The model is released before the gesture ends, but the motion began as a movement of the model.
TEST_F(HandGesturesTest, AMotionThatBeganWhileTheModelWasHeldIsNone) {
  HandGestures gestures = make(shipped());
  const hand::Performance made = performance();
  const auto held = [&](std::int64_t at_ns) {
    return std::ranges::any_of(made.made, [&](const hand::MadeGesture& g) {
      return at_ns >= g.began_ns && at_ns < (g.began_ns + g.ended_ns) / 2;
    });
  };
  for (const HandSample& sample : smooth(made)) {
    hold(kGrab, held(sample.received_ns));
    gestures.update(sample);
  }
  EXPECT_EQ(state().counter, 0u) << state().name;
  EXPECT_EQ(begun().sequence, 0u);
}

TEST_F(HandGesturesTest, OrdinaryMotionInventsNone) {
  HandGestures gestures = make(shipped());
  for (const hand::Ordinary kind : {hand::Ordinary::kPointing, hand::Ordinary::kScratching})
    for (const HandSample& sample : smooth(hand::goAbout(hand::MovingPerson(7003), kind, 60, 5)))
      gestures.update(sample);
  EXPECT_EQ(state().counter, 0u) << state().name;
}

TEST_F(HandGesturesTest, WithoutAModelNoneIsPublished) {
  HandGestures gestures = make(std::nullopt);
  const auto samples = smooth(performance());
  for (const HandSample& sample : samples) gestures.update(sample);
  EXPECT_FALSE(state_.read());
  gestures.reload(shipped(), {{}, {&glove_}});
  for (const HandSample& sample : samples) gestures.update(sample);
  EXPECT_EQ(state().counter, 10u);
  gestures.reload(std::nullopt, {{}, {&glove_}});
  gestures.rebind({});
  for (const HandSample& sample : samples) gestures.update(sample);
  EXPECT_EQ(state().counter, 10u);
  gestures.reload(shipped(), {{}, {&glove_}});
  for (const HandSample& sample : samples) gestures.update(sample);
  EXPECT_EQ(state().counter, 20u) << "counts go on";
  EXPECT_EQ(begun().sequence, 2u) << "nothing is bound any more";
}

// The tracker hangs upside down, so right is left and up is down.
TEST_F(HandGesturesTest, TheTrackersAxesSayWhichWayIsWhich) {
  HandGestures gestures = make(std::nullopt);
  gestures.reload(shipped(), {*nn::WallAxes::of({2, 3, 1}), {}});
  const std::map<std::string, std::string> turned = {{"swipe_left", "swipe_right"},
                                                     {"swipe_right", "swipe_left"},
                                                     {"swipe_up", "swipe_down"},
                                                     {"swipe_down", "swipe_up"}};
  const hand::Performance made = performance();
  std::vector<std::string> expected, seen;
  for (const hand::MadeGesture& gesture : made.made)
    expected.push_back(turned.contains(gesture.name) ? turned.at(gesture.name) : gesture.name);
  for (const HandSample& sample : smooth(made)) {
    gestures.update(sample);
    if (state().counter > seen.size()) seen.emplace_back(state().name);
  }
  EXPECT_EQ(seen, expected);
}

TEST_F(HandGesturesTest, AllocatesNothing) {
  HandGestures gestures = make(shipped());
  const auto samples = smooth(performance());
  const long before = test::allocations;
  for (const HandSample& sample : samples) gestures.update(sample);
  EXPECT_EQ(test::allocations - before, 0);
  EXPECT_EQ(state().counter, 10u);
}

}  // namespace
}  // namespace merlin::devices
