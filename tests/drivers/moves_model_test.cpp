// Each kind of present-day input must move the model where a person expects it: from the bytes on a
// line (a space mouse through spacenavd, a space mouse and a gamepad of the kernel, a Spaceball, a
// VRPN pad; trackers of VRPN and OSC; a touch frame, a mouse, TUIO) through the real driver to the
// pose of the scene. The program `moves_model_test` prints the trace of each input
// (drivers/README.md).
#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "drivers/registry.h"
#include "drivers/spaceball/protocol.h"
#include "drivers/spacenav/protocol.h"
#include "render/scene/scene.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/osc_packets.h"
#include "tests/support/recording_sink.h"
#include "tests/support/vrpn_messages.h"

namespace merlin {
namespace {

using Eigen::Vector3f;
using test::evdevRecord;
using Kind = EvdevRecord::Kind;

// A driver at the end of a fake line, and a scene that its newest samples move.
class Trace {
 public:
  // `hello`: the bytes that the device sends first.
  Trace(const char* driver, const std::string& hello, const DriverSettings& own = {},
        const render::scene::SceneSettings& scene = {.tracker_axes = {1, 2, 3}})
      : name_(driver),
        device_(findDriver(driver)->make(own, clock_, sink_)),
        scene_(*render::scene::Scene::make(scene)) {
    line_.feed(hello);
    const auto opened = device_->open(line_);
    EXPECT_TRUE(opened) << driver << ": " << (opened ? "" : opened.error().what);
    update(false);
    start_ = scene_.view().T_eye_model;
  }

  // Feeds these bytes from the device; then the scene continues for half a second.
  void say(const std::string& what, const std::string& bytes) {
    line_.feed(bytes);
    while (line_.pending()) ASSERT_TRUE(device_->poll(line_)) << name_;
    for (int i = 0; i < 25; ++i) update(!sink_.tracker.empty());
    fmt::print(
        "{:10} {:34} moved {:6.2f} {:6.2f} {:6.2f} m, turned {:6.1f} {:6.1f} {:6.1f} degrees\n",
        name_, what, moved().x(), moved().y(), moved().z(), turned().x(), turned().y(),
        turned().z());
  }
  // Returns how far the model has moved since the beginning.
  Vector3f moved() const { return scene_.view().T_eye_model.translation() - start_.translation(); }
  // Returns how the model has turned since the beginning: axis times angle, in degrees.
  Vector3f turned() const {
    const Eigen::AngleAxisf turn(scene_.view().T_eye_model.linear() * start_.linear().transpose());
    return turn.axis() * turn.angle() * 180 / 3.14159265F;
  }

 private:
  void update(bool grab) {
    clock_.advance(std::chrono::milliseconds(20));
    render::scene::SceneInput input;
    if (!sink_.ball.empty()) input.ball = sink_.ball.back();
    if (!sink_.tracker.empty()) input.hand = sink_.tracker.back();
    if (!sink_.touch.empty()) input.touch = fingers_.update(&sink_.touch.back());
    input.grab = grab;
    (void)scene_.update(input, clock_.now());
  }

  std::string name_;
  test::FakeClock clock_;
  test::RecordingSink sink_;
  test::FakeStream line_{clock_, nullptr};
  std::unique_ptr<Device> device_;
  render::scene::Scene scene_;
  render::scene::TouchFollower fingers_;
  Eigen::Isometry3f start_ = Eigen::Isometry3f::Identity();
};

// Expects that `got` points along `want`, and has at least a tenth of its length.
void expectAlong(const Vector3f& got, const Vector3f& want) {
  EXPECT_GT(got.norm(), 0.1F * want.norm()) << got.transpose();
  EXPECT_GT(got.normalized().dot(want.normalized()), 0.99F)
      << got.transpose() << ", not along " << want.transpose();
}

const Vector3f kX = Vector3f::UnitX(), kY = Vector3f::UnitY(), kZ = Vector3f::UnitZ();
constexpr float kDegrees = 45;  // angle by which the model turns in half a second

// What the device sends, and how the model then moves or turns.
struct Step {
  const char* what;
  std::string bytes;
  Vector3f moves, turns;
};
const Vector3f kNot = Vector3f::Zero();

// Sends each step to a driver of its own, so that each step begins at the start view.
void expectSteps(const char* driver, const std::string& hello, const std::vector<Step>& steps,
                 const DriverSettings& own = {}) {
  for (const Step& step : steps) {
    SCOPED_TRACE(fmt::format("{}: {}", driver, step.what));
    Trace trace(driver, hello, own);
    trace.say(step.what, step.bytes);
    if (step.moves != kNot)
      expectAlong(trace.moved(), step.moves);
    else
      EXPECT_LT(trace.moved().norm(), 1e-3F);
    if (step.turns != kNot)
      expectAlong(trace.turned(), kDegrees * step.turns);
    else
      EXPECT_LT(trace.turned().norm(), 0.1F);
  }
}

std::string axes(std::initializer_list<int> codes, std::int32_t low, std::int32_t high) {
  std::string text;
  for (const int code : codes) text += evdevRecord(Kind::kAxis, code, 0, low, high);
  return text;
}
std::string moves(int code, std::int32_t value) {
  return evdevRecord(Kind::kMoved, code, value) + evdevRecord(Kind::kReport);
}

TEST(MovesTheModel, AGamepadsSticksAndTriggers) {
  const std::string hello =
      axes({ABS_X, ABS_Y, ABS_RX, ABS_RY}, -1000, 1000) + axes({ABS_Z, ABS_RZ}, 0, 255) +
      test::evdevNamed(Kind::kKey, BTN_GAMEPAD, "SOUTH") + evdevRecord(Kind::kReady);
  expectSteps("evdev", hello,
              {{"left stick to the right", moves(ABS_X, 1000), kX, kNot},
               {"left stick back", moves(ABS_Y, 1000), kZ, kNot},
               {"right trigger", moves(ABS_RZ, 255), kY, kNot},
               {"left trigger", moves(ABS_Z, 255), -kY, kNot},
               {"right stick to the right", moves(ABS_RX, 1000), kNot, kY},
               {"right stick back", moves(ABS_RY, 1000), kNot, kX}});
}

// Of the kernel's axes, y points towards the person and z down.
TEST(MovesTheModel, ASpaceMouseOfTheKernel) {
  const std::string hello =
      axes({ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ}, -350, 350) + evdevRecord(Kind::kReady);
  expectSteps("evdev", hello,
              {{"space mouse to the right", moves(ABS_X, 350), kX, kNot},
               {"space mouse towards the person", moves(ABS_Y, 350), kZ, kNot},
               {"space mouse lifted", moves(ABS_Z, -350), kY, kNot},
               {"space mouse turned to the right", moves(ABS_RZ, -350), kNot, kY}});
}

// spacenavd's axes: x right, y up, z away from the person.
TEST(MovesTheModel, ASpaceMouseThroughSpacenavd) {
  const auto motion = [](std::size_t axis, std::int32_t count) {
    spacenav::Frame frame{spacenav::kMotion};
    frame[1 + axis] = count;
    return spacenav::encode(frame);
  };
  const spacenav::Frame name{spacenav::kDeviceName, 0x65, 0, 0, 0, 0, 0, 1};
  expectSteps("spacenav", spacenav::encodeWord(spacenav::kHello) + spacenav::encode(name),
              {{"space mouse to the right", motion(0, 500), kX, kNot},
               {"space mouse lifted", motion(1, 500), kY, kNot},
               {"space mouse away", motion(2, 500), -kZ, kNot},
               {"space mouse turned to the right", motion(4, 500), kNot, kY}});
}

// The Spaceball's own z points away from the person.
TEST(MovesTheModel, ASpaceball) {
  const auto pushed = [](std::size_t axis, std::int16_t count) {
    spaceball::Displacement d;
    d.axes[axis] = count;
    d.period = 800;  // 50 ms
    return spaceball::encode(d);
  };
  expectSteps("spaceball", "@2 Firmware version 2.13 created on 29-Oct-1991.\r",
              {{"ball to the right", pushed(0, 2000), kX, kNot},
               {"ball lifted", pushed(1, 2000), kY, kNot},
               {"ball away", pushed(2, 2000), -kZ, kNot},
               {"ball turned to the right", pushed(4, 2000), kNot, kY}});
}

TEST(MovesTheModel, ThePadOfAVrpnServer) {
  const auto channel = [](std::size_t at, double value) {
    std::array<double, 6> channels{};
    channels[at] = value;
    return test::vrpnMessage(0, 5, vrpnChannels(channels));
  };
  const std::string hello = vrpnCookie() + test::vrpnSender(0, VrpnPadSettings{}.device) +
                            test::vrpnType(5, kVrpnChannelsType);
  expectSteps("vrpn_pad", hello,
              {{"channel 0 pushed", channel(0, 1), kX, kNot},
               {"channel 1 pushed", channel(1, 1), kY, kNot},
               {"channel 2 pushed", channel(2, 1), kZ, kNot},
               {"channel 4 pushed back", channel(4, -1), kNot, -kY}});
}

// The hand has grabbed the model, which then moves three times as far as the hand, and turns as the
// hand does.
template <typename Pose>
void expectHandCarries(const char* driver, const std::string& hello, const Pose& pose) {
  const float half = std::sqrt(0.5F);
  for (const auto& [what, place, turn] : {std::tuple{"hand to the right", kX, kNot},
                                          {"hand up", kY, kNot},
                                          {"hand towards the person", kZ, kNot},
                                          {"hand turned to the left about y", kNot, kY}}) {
    SCOPED_TRACE(fmt::format("{}: {}", driver, what));
    Trace trace(driver, hello + pose(Vector3f(0, 0, 0), Eigen::Quaternionf::Identity()));
    trace.say("grabbed", pose(Vector3f(0, 0, 0), Eigen::Quaternionf::Identity()));
    const Vector3f axis = half * turn;
    const Eigen::Quaternionf turned(turn == kNot ? 1 : half, axis.x(), axis.y(), axis.z());
    trace.say(what, pose(0.2F * place, turned));
    if (place != kNot) expectAlong(trace.moved(), 0.6F * place);
    if (turn != kNot) expectAlong(trace.turned(), 90 * turn);
  }
}

TEST(MovesTheModel, ATrackerOfAVrpnServer) {
  const auto pose = [](const Vector3f& p, const Eigen::Quaternionf& q) {
    const float wxyz[] = {q.w(), q.x(), q.y(), q.z()};
    return test::vrpnMessage(0, 5, vrpnPose(0, std::span(p.data(), 3), wxyz));
  };
  expectHandCarries(
      "vrpn",
      vrpnCookie() + test::vrpnSender(0, VrpnSettings{}.device) + test::vrpnType(5, kVrpnPoseType),
      pose);
}

TEST(MovesTheModel, ATrackerByOsc) {
  const auto pose = [](const Vector3f& p, const Eigen::Quaternionf& q) {
    return test::datagram(
        test::oscMessage("/tracker/1/pose", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}));
  };
  expectHandCarries("osc", "", pose);
}

std::string finger(int slot, int id, int x, int y) {
  return evdevRecord(Kind::kMoved, ABS_MT_SLOT, slot) +
         evdevRecord(Kind::kMoved, ABS_MT_TRACKING_ID, id) +
         evdevRecord(Kind::kMoved, ABS_MT_POSITION_X, x) +
         evdevRecord(Kind::kMoved, ABS_MT_POSITION_Y, y);
}

TEST(MovesTheModel, FingersOnATouchFrame) {
  const std::string hello = axes({ABS_MT_SLOT}, 0, 9) + axes({ABS_MT_TRACKING_ID}, 0, 65535) +
                            axes({ABS_MT_POSITION_X, ABS_MT_POSITION_Y}, 0, 1000) +
                            evdevRecord(Kind::kReady);
  const std::string report = evdevRecord(Kind::kReport);
  Trace one("touch", hello);
  one.say("a finger touches", finger(0, 1, 400, 500) + report);
  one.say("it moves to the right", finger(0, 1, 600, 500) + report);
  expectAlong(one.turned(), kDegrees * kY);
  Trace two("touch", hello);
  two.say("two fingers touch", finger(0, 1, 400, 500) + finger(1, 2, 600, 500) + report);
  two.say("they move up", finger(0, 1, 400, 300) + finger(1, 2, 600, 300) + report);
  expectAlong(two.moved(), kY);
  two.say("and apart", finger(0, 1, 300, 300) + finger(1, 2, 700, 300) + report);
  EXPECT_GT(two.moved().z(), 0.5F) << "nearer";
}

TEST(MovesTheModel, AMousesWheelAndADragOfIt) {
  const std::string hello =
      evdevRecord(Kind::kRelative, REL_X) + evdevRecord(Kind::kRelative, REL_Y) +
      test::evdevNamed(Kind::kKey, BTN_LEFT, "LEFT") + evdevRecord(Kind::kReady);
  const std::string report = evdevRecord(Kind::kReport);
  Trace wheel("touch", hello);
  wheel.say("the wheel turns away", evdevRecord(Kind::kShifted, REL_WHEEL, 5) + report);
  expectAlong(wheel.moved(), kZ);
  Trace drag("touch", hello);
  drag.say("the left button is pressed", evdevRecord(Kind::kPressed, BTN_LEFT, 1) + report);
  drag.say("the mouse moves to the left", evdevRecord(Kind::kShifted, REL_X, -300) + report);
  expectAlong(drag.turned(), -kDegrees * kY);
}

TEST(MovesTheModel, AFingerOfTuio) {
  Trace trace("tuio", "");
  trace.say("a finger touches", test::datagram(test::tuioCursors(1, {{1, 0.4F, 0.5F}})));
  trace.say("it moves to the right", test::datagram(test::tuioCursors(2, {{1, 0.6F, 0.5F}})));
  expectAlong(trace.turned(), kDegrees * kY);
}

}  // namespace
}  // namespace merlin
