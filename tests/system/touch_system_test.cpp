// Touch surfaces and a tracker over the network at a real merlind: a touch frame whose records come
// over a pseudo-terminal, TUIO and OSC packed by Python's standard library, and OSC from liblo's
// oscsend; all also recorded and replayed. Whether the kernel gives such records for real devices
// is tested in the virtual machine (tests/vm).
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/commands.h"
#include "daemon/base/unique_fd.h"
#include "drivers/io/pty_master.h"
#include "tests/support/evdev_records.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

// Returns a UDP port that the system has just assigned to a socket that is closed again.
std::string freeUdpPort() {
  const UniqueFd probe(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(probe.get(), reinterpret_cast<sockaddr*>(&address), size) != 0) return "";
  ::getsockname(probe.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return std::to_string(ntohs(address.sin_port));
}

std::vector<std::string> sender(const std::string& what, const std::string& port) {
  return {"python3", "-B", kSource + "/tests/support/send_osc.py", what, port};
}

MerlindOptions devicesAlone(const nlohmann::json& entry) {
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = onlyDevice(entry);
  return options;
}

std::optional<TouchSample> newestTouch(Merlind& merlind, const std::string& name) {
  const auto* const devices = merlind.devices();
  const auto* const touch = devices ? devices->touch(name) : nullptr;
  return touch ? touch->samples->newest() : std::nullopt;
}

bool fingersAre(Merlind& merlind, const std::string& name, std::uint32_t fingers) {
  return eventually([&] {
    const auto touch = newestTouch(merlind, name);
    return touch && touch->fingers == fingers;
  });
}

std::optional<TrackerSample> newestPose(Merlind& merlind, std::size_t station) {
  const auto* const devices = merlind.devices();
  return devices ? devices->tracker()->stations[station - 1]->newest() : std::nullopt;
}

// The device's end of a touch frame's pseudo-terminal.
class FrameLine {
 public:
  explicit FrameLine(const std::string& link) : line_(io::PtyMaster::open(link)) {
    EXPECT_TRUE(line_);
  }
  void say(const std::string& bytes) const {
    (void)!::write(line_->fd(), bytes.data(), bytes.size());  // nobody may have opened the line yet
  }
  // Sends the description repeatedly until merlind's device works.
  bool opens(Merlind& merlind, const std::string& device, const std::string& description) const {
    return eventually([&] {
      say(description);
      const auto health = merlind.health(device);
      return health && health->state == HealthState::kOk;
    });
  }

 private:
  Result<io::PtyMaster> line_;
};

TEST(TouchSystem, AFrameOfTheKernelTouches) {
  const TempDir dir;
  const FrameLine line(dir / "frame");
  const auto say = [&](const std::string& bytes) { line.say(bytes); };
  std::string description;
  for (const auto& [code, high] : {std::pair{ABS_MT_SLOT, 9},
                                   {ABS_MT_TRACKING_ID, 65535},
                                   {ABS_MT_POSITION_X, 1000},
                                   {ABS_MT_POSITION_Y, 500}})
    description += evdevRecord(EvdevRecord::kAxis, code, 0, 0, high);
  description += evdevRecord(EvdevRecord::kReady);
  Merlind merlind(dir, "", "frame",
                  devicesAlone(deviceEntry("frame", "touch", "pty:" + dir / "frame")));
  EXPECT_TRUE(line.opens(merlind, "frame", description)) << merlind.process().output();
  const auto moved = [](int code, int value) {
    return evdevRecord(EvdevRecord::kMoved, code, value);
  };
  say(moved(ABS_MT_SLOT, 0) + moved(ABS_MT_TRACKING_ID, 1) + moved(ABS_MT_POSITION_X, 250) +
      moved(ABS_MT_POSITION_Y, 250) + moved(ABS_MT_SLOT, 1) + moved(ABS_MT_TRACKING_ID, 2) +
      moved(ABS_MT_POSITION_X, 750) + moved(ABS_MT_POSITION_Y, 250) +
      evdevRecord(EvdevRecord::kReport));
  EXPECT_TRUE(fingersAre(merlind, "frame", 2));
  EXPECT_FLOAT_EQ(newestTouch(merlind, "frame")->position[1][0], 0.75F);
  EXPECT_FLOAT_EQ(newestTouch(merlind, "frame")->aspect, 2);
  say(moved(ABS_MT_TRACKING_ID, -1) + evdevRecord(EvdevRecord::kReport));
  EXPECT_TRUE(fingersAre(merlind, "frame", 1));
}

TEST(TouchSystem, FingersThatMoveTogetherAreAnInput) {
  const TempDir dir;
  const FrameLine line(dir / "frame");
  const auto say = [&](const std::string& bytes) { line.say(bytes); };
  std::string description;
  for (const int code : {ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y})
    description += evdevRecord(EvdevRecord::kAxis, code, 0, 0, code == ABS_MT_SLOT ? 9 : 1000);
  description += evdevRecord(EvdevRecord::kReady);
  MerlindOptions options = devicesAlone(deviceEntry("touch", "touch", "pty:" + dir / "frame"));
  options.also["bindings"] = {{{"input", "touch.pinch"}, {"action", "reset_view"}},
                              {{"input", "touch.spread"}, {"action", "next_mode"}}};
  Merlind merlind(dir, "", "pinch", options);
  EXPECT_TRUE(line.opens(merlind, "touch", description)) << merlind.process().output();
  const auto finger = [](int slot, int id, int x) {
    return evdevRecord(EvdevRecord::kMoved, ABS_MT_SLOT, slot) +
           evdevRecord(EvdevRecord::kMoved, ABS_MT_TRACKING_ID, id) +
           evdevRecord(EvdevRecord::kMoved, ABS_MT_POSITION_X, x) +
           evdevRecord(EvdevRecord::kMoved, ABS_MT_POSITION_Y, 500);
  };
  const auto begun = [&](std::uint32_t together, std::uint32_t apart) {
    return eventually([&] {
      const auto actions = merlind.actions("touch");
      return actions && actions->begun[actionIndex("reset_view")] == together &&
             actions->begun[actionIndex("next_mode")] == apart;
    });
  };
  const std::string report = evdevRecord(EvdevRecord::kReport);
  say(finger(0, 1, 300) + finger(1, 2, 700) + report);
  EXPECT_TRUE(fingersAre(merlind, "touch", 2));
  say(finger(0, 1, 450) + finger(1, 2, 550) + report);
  EXPECT_TRUE(begun(1, 0));
  say(finger(1, -1, 550) + report);
  EXPECT_TRUE(fingersAre(merlind, "touch", 1));
  say(finger(1, 3, 550) + report + finger(1, 3, 900) + report);
  EXPECT_TRUE(begun(1, 1));
}

TEST(TouchSystem, AMousesWheelMovesTheModelAndItsRightButtonActs) {
  const TempDir dir;
  const auto line = io::PtyMaster::open(dir / "mouse");
  ASSERT_TRUE(line);
  const auto say = [&](const std::string& bytes) {
    (void)!::write(line->fd(), bytes.data(), bytes.size());  // nobody may receive yet
  };
  MerlindOptions options;
  options.emulate = false;
  options.also = onlyDevice(deviceEntry("mouse", "touch", "pty:" + dir / "mouse"));
  options.also["bindings"] = {{{"input", "mouse.button.right"}, {"action", "next_mode"}}};
  Merlind merlind(dir, makeModel(dir, 5), "mouse", options);
  EXPECT_TRUE(eventually([&] {
    say(evdevRecord(EvdevRecord::kRelative, REL_X) + evdevRecord(EvdevRecord::kRelative, REL_Y) +
        evdevRecord(EvdevRecord::kKey, BTN_LEFT) + evdevRecord(EvdevRecord::kReady));
    const auto health = merlind.health("mouse");
    return health && health->state == HealthState::kOk;
  })) << merlind.process().output();
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(eventually([&] { return merlind.wall().moving == 0; }));
  const std::uint32_t resumed = merlind.wall().resumed;
  say(evdevRecord(EvdevRecord::kShifted, REL_WHEEL, 1) + evdevRecord(EvdevRecord::kReport));
  EXPECT_TRUE(eventually([&] { return merlind.wall().resumed > resumed; }));
  say(evdevRecord(EvdevRecord::kPressed, BTN_RIGHT, 1) + evdevRecord(EvdevRecord::kReport));
  EXPECT_TRUE(eventually([&] {
    const auto actions = merlind.actions("mouse");
    return actions && actions->begun[actionIndex("next_mode")] == 1;
  }));
}

TEST(TouchSystem, FingersOfATuioTrackerTouchUntilItIsSilent) {
  const TempDir dir;
  const std::string port = freeUdpPort();
  Merlind merlind(dir, "", "tuio", devicesAlone(deviceEntry("table", "tuio", "udp:" + port)));
  ASSERT_TRUE(merlind.healthIs("table", HealthState::kOk)) << merlind.process().output();
  EXPECT_TRUE(eventually([&] {
    return std::string_view(merlind.health("table")->reason) == "no TUIO frame has come yet";
  }));
  Process tracker(sender("tuio", port));
  EXPECT_TRUE(fingersAre(merlind, "table", 2)) << tracker.output();
  const auto touch = newestTouch(merlind, "table");
  EXPECT_FLOAT_EQ(touch->position[0][1], 0.25F);
  EXPECT_FLOAT_EQ(touch->position[1][1], 0.75F);
  EXPECT_NEAR(touch->position[0][0] + touch->position[1][0], 1, 1e-5);
  const std::uint32_t id = touch->id[0];
  EXPECT_TRUE(eventually([&] { return newestTouch(merlind, "table")->counter > 20; }));
  EXPECT_EQ(newestTouch(merlind, "table")->id[0], id);
  EXPECT_EQ(merlind.health("table")->bad_packets, 0u);
  tracker.kill(SIGKILL);
  EXPECT_TRUE(fingersAre(merlind, "table", 0));
  EXPECT_TRUE(eventually(
      [&] { return std::string_view(merlind.health("table")->reason).starts_with("silent"); }));
  EXPECT_EQ(merlind.health("table")->state, HealthState::kOk);
}

TEST(TouchSystem, WhatATuioTrackerSentIsRecordedAndReplayed) {
  const TempDir dir;
  const std::string port = freeUdpPort();
  Process tracker(sender("tuio", port));
  const Outcome recorded = run({kMerlin, "record", "udp:" + port, "--device", "tuio", "--seconds",
                                "1", "-o", dir / "table.bytes"});
  ASSERT_EQ(recorded.status, 0) << recorded.output;
  Merlind merlind(dir, "", "again",
                  devicesAlone(deviceEntry("table", "tuio", "replay:" + dir / "table.bytes")));
  EXPECT_TRUE(fingersAre(merlind, "table", 2)) << merlind.process().output();
}

TEST(TouchSystem, PosesByOscAreTheTrackerAndTheirEndIsSaid) {
  const TempDir dir;
  const std::string port = freeUdpPort();
  Merlind merlind(dir, "", "osc",
                  devicesAlone(deviceEntry("tracker", "osc", "udp:" + port, {{"scale", 0.001}})));
  EXPECT_TRUE(eventually([&] {
    const auto health = merlind.health("tracker");
    return health && std::string_view(health->reason) == "no OSC message comes to the port";
  }));
  Process tracker(sender("osc", port));
  ASSERT_TRUE(merlind.healthIs("tracker", HealthState::kOk)) << tracker.output();
  const auto pose = newestPose(merlind, 1);
  ASSERT_TRUE(pose);
  EXPECT_FLOAT_EQ(pose->position_m[1], 0.5F);
  EXPECT_FLOAT_EQ(pose->orientation_wxyz[0], 0.8F);
  EXPECT_FLOAT_EQ(pose->orientation_wxyz[2], 0.6F);
  EXPECT_TRUE(eventually([&] { return newestPose(merlind, 1)->counter > pose->counter + 20; }));
  tracker.kill(SIGKILL);
  EXPECT_TRUE(merlind.healthIs("tracker", HealthState::kFailed));
}

TEST(TouchSystem, PosesOfLiblosSenderAreRead) {
  if (run({"which", "oscsend"}).status != 0)
    GTEST_SKIP() << "oscsend (package liblo-tools) is not installed";
  const TempDir dir;
  const std::string port = freeUdpPort();
  Merlind merlind(dir, "", "liblo", devicesAlone(deviceEntry("tracker", "osc", "udp:" + port)));
  EXPECT_TRUE(eventually([&] {
    EXPECT_EQ(run({"oscsend", "127.0.0.1", port, "/tracker/3/pose", "fffdddd", "1.5", "-0.5", "2",
                   "0", "0", "0", "1"})
                  .status,
              0);
    return newestPose(merlind, 3).has_value();
  })) << merlind.process().output();
  EXPECT_FLOAT_EQ(newestPose(merlind, 3)->position_m[0], 1.5F);
  EXPECT_FLOAT_EQ(newestPose(merlind, 3)->position_m[2], 2);
  EXPECT_FLOAT_EQ(newestPose(merlind, 3)->orientation_wxyz[0], 1);
}

}  // namespace
}  // namespace merlin::test
