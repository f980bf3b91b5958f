#include <array>

#include <linux/input-event-codes.h>

#include "drivers/evdev/device.h"
#include "drivers/osc/device.h"
#include "drivers/touch/device.h"
#include "drivers/tuio/device.h"
#include "drivers/vrpn/device.h"
#include "drivers/vrpn/pad_device.h"
#include "tests/bench/latency_kind.h"
#include "tests/support/evdev_records.h"
#include "tests/support/osc_packets.h"
#include "tests/support/vrpn_messages.h"

namespace merlin::bench {
namespace {

using Evdev = EvdevRecord::Kind;

std::string evdev(Evdev kind, int code = 0, std::int32_t value = 0) {
  return test::evdevRecord(kind, code, value, 0, 1000);
}

// Returns a position that differs from the one before.
std::int32_t place(std::uint32_t n) { return static_cast<std::int32_t>(100 + n % 800); }
float share(std::uint32_t n) { return static_cast<float>(place(n)) / 1000; }

std::string gamepad() { return evdev(Evdev::kAxis, ABS_X) + evdev(Evdev::kReady); }
std::string gamepadRecord(std::uint32_t n) {
  return evdev(Evdev::kMoved, ABS_X, place(n)) + evdev(Evdev::kReport);
}

std::string touchFrame() {
  std::string text;
  for (const int code : {ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y})
    text += evdev(Evdev::kAxis, code);
  return text + evdev(Evdev::kMoved, ABS_MT_TRACKING_ID, 1) + evdev(Evdev::kReady);
}
std::string touchRecord(std::uint32_t n) {
  return evdev(Evdev::kMoved, ABS_MT_POSITION_X, place(n)) + evdev(Evdev::kReport);
}

constexpr std::int32_t kDevice = 1, kMessage = 1;

std::string vrpnServer(const char* device, const char* type) {
  return vrpnCookie() + test::vrpnSender(0, kVrpnControl) + test::vrpnSender(kDevice, device) +
         test::vrpnType(kMessage, type);
}
std::string vrpnTrackerRecord(std::uint32_t n) {
  return test::vrpnMessage(
      kDevice, kMessage,
      merlin::vrpnPose(0, std::array{share(n), 0.F, 0.F}, std::array{1.F, 0.F, 0.F, 0.F}));
}
// The greeting ends with a first pose, for which the driver waits.
std::string vrpnTracker() { return vrpnServer("Tracker0", kVrpnPoseType) + vrpnTrackerRecord(0); }
std::string vrpnPad() { return vrpnServer("Joystick0", kVrpnChannelsType); }
std::string vrpnPadRecord(std::uint32_t n) {
  return test::vrpnMessage(kDevice, kMessage,
                           merlin::vrpnChannels(std::array{double{share(n)}, 0.0}));
}

std::string oscRecord(std::uint32_t n) {
  return test::datagram(
      test::oscMessage("/tracker/1/pose", {share(n), 0.F, 0.F, 0.F, 0.F, 0.F, 1.F}));
}
std::string oscSender() { return oscRecord(0); }  // a first pose, for which the driver waits
std::string nothing() { return {}; }
std::string tuioRecord(std::uint32_t n) {
  return test::datagram(test::tuioCursors(static_cast<int>(n), {{1, share(n), 0.5F}}));
}

}  // namespace

const Kind kGamepadKind = {
    "gamepad",
    nullptr,
    SampleKind::kBall,
    [](const Clock& clock, SampleSink& sink) { return evdev::makeDevice({}, clock, sink); },
    &gamepadRecord,
    &gamepad};
const Kind kTouchKind = {
    "touch",
    nullptr,
    SampleKind::kTouch,
    [](const Clock& clock, SampleSink& sink) { return touch::makeDevice({}, clock, sink); },
    &touchRecord,
    &touchFrame};
const Kind kVrpnTrackerKind = {"vrpn",
                               nullptr,
                               SampleKind::kTracker,
                               [](const Clock& clock, SampleSink& sink) {
                                 return vrpn::makeDevice(VrpnSettings{}, clock, sink);
                               },
                               &vrpnTrackerRecord,
                               &vrpnTracker};
const Kind kVrpnPadKind = {"vrpn_pad",
                           nullptr,
                           SampleKind::kBall,
                           [](const Clock& clock, SampleSink& sink) {
                             return vrpn::makeDevice(VrpnPadSettings{}, clock, sink);
                           },
                           &vrpnPadRecord,
                           &vrpnPad};
const Kind kOscKind = {
    "osc",
    nullptr,
    SampleKind::kTracker,
    [](const Clock& clock, SampleSink& sink) { return osc::makeDevice({}, clock, sink); },
    &oscRecord,
    &oscSender};
const Kind kTuioKind = {
    "tuio",
    nullptr,
    SampleKind::kTouch,
    [](const Clock& clock, SampleSink& sink) { return tuio::makeDevice({}, clock, sink); },
    &tuioRecord,
    &nothing};

}  // namespace merlin::bench
