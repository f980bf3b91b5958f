// The devices of today at a real merlind: a space mouse through the real spacenavd, a gamepad whose
// records come over a pseudo-terminal, and the tracker of a VRPN server, which is another merlind.
// That the kernel's own devices give a gamepad's records is seen in the virtual machine (tests/vm).
#include <algorithm>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "daemon/base/commands.h"
#include "daemon/net/connection_server.h"
#include "drivers/io/pty_master.h"
#include "drivers/port/evdev_line.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

nlohmann::json ballOf(const std::string& driver, const std::string& port) {
  return onlyDevice(deviceEntry("ball", driver, port));
}

std::optional<BallSample> ballOf(Merlind& merlind) {
  const auto* devices = merlind.devices();
  return devices ? devices->ball()->samples->newest() : std::nullopt;
}

// spacenavd on a ball's line, in a folder of its own.
class Spacenavd {
 public:
  Spacenavd(const TempDir& dir, const std::string& line) : dir_(dir.path()) {
    writeText(dir / "spnavrc", "serial = " + line + "\n");
    // Debian's spacenavd binds run/spnav.sock relative to its working directory (/ as a service).
    std::filesystem::create_directory(dir / "run");
    start();
  }
  void start() {
    process_ = std::make_unique<Process>(std::vector<std::string>{
        "sh", "-c", "cd " + dir_ + " && rm -f run/spnav.sock && exec spacenavd -d -v -c spnavrc"});
  }
  void stop() { process_->kill(SIGTERM); }
  std::string socket() const { return dir_ + "/run/spnav.sock"; }

 private:
  std::string dir_;
  std::unique_ptr<Process> process_;
};

TEST(TodaysDevices, ASpaceMouseOfSpacenavdIsTheBallAndComesBackWithIt) {
  if (run({"which", "spacenavd"}).status != 0) GTEST_SKIP() << "spacenavd is not installed";
  const TempDir dir;
  Process emulator({kMerlin, "emulate", "spaceball", "--link", dir / "line", "--script", "visit"});
  ASSERT_TRUE(emulator.saysEventually("spaceball on")) << emulator.output();
  Spacenavd spacenavd(dir, dir / "line");
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = ballOf("spacenav", "unix:" + spacenavd.socket());
  Merlind merlind(dir, "", "mouse", options);
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  // The visitor turns the model now and then. spacenavd gives up on a ball that does not answer in
  // time, as happens on a busy machine; the test then starts it again, as a service manager would.
  const auto turns = [&] {
    for (int attempt = 0; attempt < 6; ++attempt) {
      const auto seen = [&] {
        const auto ball = ballOf(merlind);
        return ball && std::abs(ball->rotation[1]) > 0.1F;
      };
      if (eventually(seen, std::chrono::seconds(20))) return true;
      spacenavd.stop();
      spacenavd.start();
    }
    return false;
  };
  EXPECT_TRUE(turns()) << merlind.process().output();
  EXPECT_TRUE(merlind.healthIs("ball", HealthState::kOk));
  EXPECT_NE(merlind.status()["devices"]["ball"]["identity"].get<std::string>(), "");
  spacenavd.stop();
  EXPECT_TRUE(merlind.healthIs("ball", HealthState::kAbsent));
  spacenavd.start();
  EXPECT_TRUE(turns()) << merlind.process().output();
  EXPECT_GE(merlind.health("ball")->reconnects, 1u);
}

std::string record(EvdevRecord::Kind kind, int code = 0, std::int32_t value = 0,
                   std::string_view name = {}) {
  EvdevRecord r;
  r.kind = kind;
  r.code = static_cast<std::uint16_t>(code);
  r.value = value;
  if (kind == EvdevRecord::kAxis) {
    r.low = -32768;
    r.high = 32767;
  }
  std::copy(name.begin(), name.end(), r.text.begin());
  std::string out;
  append(r, out);
  return out;
}

// A gamepad at the other end of a pseudo-terminal, which merlind opens as soon as it is there.
class Gamepad {
 public:
  explicit Gamepad(const std::string& link) : line_(*io::PtyMaster::open(link)) {}
  void describe() {
    std::string text = record(EvdevRecord::kName, 0, 0, "made-up pad");
    for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) text += record(EvdevRecord::kAxis, code);
    text += record(EvdevRecord::kKey, BTN_SOUTH, 0, "SOUTH");
    text += record(EvdevRecord::kReady);
    (void)!::write(line_.fd(), text.data(), text.size());  // nobody may have opened it yet
  }
  void report(const std::string& events) {
    const std::string bytes = events + record(EvdevRecord::kReport);
    EXPECT_EQ(::write(line_.fd(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  io::PtyMaster line_;
};

// A line that says nothing is opened again and again. It is described once for each time, when it
// is open: what was sent before is dropped then, from some byte on.
bool isConnected(Merlind& merlind, Gamepad& pad, const std::string& name = "ball") {
  std::int64_t opened_ns = 0;
  return eventually([&] {
    const auto health = merlind.health(name);
    const bool opening = health && health->state == HealthState::kOpening;
    if (opening && std::exchange(opened_ns, health->since_ns) != health->since_ns) pad.describe();
    return health && health->state == HealthState::kOk;
  });
}

TEST(TodaysDevices, AGamepadMovesTheModelAndItsButtonsAct) {
  const TempDir dir;
  Gamepad pad(dir / "pad");
  MerlindOptions options;
  options.emulate = false;
  options.also = ballOf("evdev", "pty:" + dir / "pad");
  Merlind merlind(dir, makeModel(dir, 5), "pad", options);
  EXPECT_TRUE(isConnected(merlind, pad)) << merlind.process().output();
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  EXPECT_STREQ(merlind.health("ball")->identity, "made-up pad, 4 axes, 1 keys");
  ASSERT_TRUE(eventually([&] { return merlind.wall().moving == 0; }));
  pad.report(record(EvdevRecord::kMoved, ABS_RX, 32767));
  EXPECT_TRUE(eventually([&] { return merlind.wall().moving == 1; }));
  EXPECT_FLOAT_EQ(ballOf(merlind)->rotation[1], 1);
  // The stick is held, without another event: the model goes on turning.
  const std::uint32_t counter = ballOf(merlind)->counter;
  EXPECT_TRUE(eventually([&] { return ballOf(merlind)->counter > counter + 20; }));
  EXPECT_EQ(merlind.wall().moving, 1u);
  pad.report(record(EvdevRecord::kMoved, ABS_RX, 0));
  EXPECT_TRUE(eventually([&] { return merlind.wall().moving == 0; }));
  pad.report(record(EvdevRecord::kPressed, BTN_SOUTH, 1));  // ball.button.1: reset_view
  EXPECT_TRUE(eventually([&] {
    const auto actions = merlind.actions("ball");
    return actions && actions->sequence == 1;
  }));
}

TEST(TodaysDevices, KeysAreInputsByTheKernelsNames) {
  const TempDir dir;
  Gamepad pad(dir / "pad");
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = ballOf("evdev", "pty:" + dir / "pad");
  options.also["bindings"] = {{{"input", "button.south"}, {"action", "next_mode"}},
                              {{"input", "ball.key.space"}, {"action", "reset_view"}}};
  Merlind merlind(dir, "", "keys", options);
  EXPECT_TRUE(isConnected(merlind, pad)) << merlind.process().output();
  pad.report(record(EvdevRecord::kPressed, BTN_SOUTH, 1));
  EXPECT_TRUE(eventually([&] {
    const auto actions = merlind.actions("ball");
    return actions && actions->begun[actionIndex("next_mode")] == 1;
  }));
  EXPECT_EQ(ballOf(merlind)->keys[0], BTN_SOUTH);
  EXPECT_TRUE(eventually([&] {
    return std::string_view(merlind.health("ball")->reason) ==
           "it has no key.space, which a binding names; `merlin devices` lists the keys that it "
           "has";
  })) << merlind.health("ball")->reason;
}

// A TCP port that is free: the system has just assigned it, and it was closed again.
int freePort() {
  const auto probe = net::listenTcp("127.0.0.1", 0);
  return probe ? net::portOf(probe->get()) : 0;
}

MerlindOptions vrpnServer(int port) {
  MerlindOptions options;
  options.role = "devices";
  options.script = "turning";
  options.also = {{"serve", {{"vrpn_port", port}}}};
  return options;
}

MerlindOptions vrpnClient(int port) {
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = onlyDevice(deviceEntry("tracker", "vrpn", fmt::format("tcp://127.0.0.1:{}", port),
                                        {{"stations", {2, 0, -1, -1}}}));
  return options;
}

// Whether station 1 of the server measured what is now station 2 of the client.
bool agree(Merlind& server, Merlind& client) {
  const auto *from = server.devices(), *to = client.devices();
  const auto got = to ? to->tracker()->stations[1]->newest() : std::nullopt;
  if (!from || !got) return false;
  const std::uint64_t count = from->tracker()->stations[0]->count();
  for (std::uint64_t i = count - std::min<std::uint64_t>(count, shm::kHistory); i < count; ++i) {
    const auto sent = from->tracker()->stations[0]->at(i);
    if (!sent || !std::ranges::equal(sent->position_m, got->position_m)) continue;
    return std::ranges::equal(sent->orientation_wxyz, got->orientation_wxyz,
                              [](float a, float b) { return std::abs(a - b) < 1e-6F; });
  }
  return false;
}

TEST(TodaysDevices, ATrackerOfAVrpnServerIsTheTrackerAndComesBackWithIt) {
  const TempDir dir;
  const int port = freePort();
  std::optional<Merlind> server(std::in_place, dir, "", "server", vrpnServer(port));
  Merlind client(dir, "", "client", vrpnClient(port));
  ASSERT_TRUE(client.ready()) << client.process().output();
  ASSERT_TRUE(client.healthIs("tracker", HealthState::kOk)) << client.process().output();
  EXPECT_TRUE(eventually([&] { return agree(*server, client); }));
  EXPECT_EQ(client.status()["devices"]["tracker"]["identity"],
            "VRPN tracker Tracker0 at server version 07.38");
  EXPECT_EQ(client.devices()->tracker()->stations[0]->count(), 0u)
      << "the server has no third station";
  EXPECT_EQ(client.devices()->tracker()->frames->read()->boresight_wxyz[1][0], 1);
  const Outcome calibrated = run({kMerlin, "calibrate", "tracker", "--station", "2", "--boresight",
                                  "1", "0", "0", "0", "-o", client.config()});
  EXPECT_EQ(calibrated.status, 2) << calibrated.output;
  EXPECT_NE(calibrated.output.find("/devices/0/driver, that of \"tracker\", is \"vrpn\""),
            std::string::npos);
  const auto counter = client.devices()->tracker()->stations[1]->newest()->counter;
  server->process().kill(SIGKILL);
  EXPECT_TRUE(client.healthIs("tracker", HealthState::kAbsent));
  server.emplace(dir, "", "again", vrpnServer(port));
  EXPECT_TRUE(client.healthIs("tracker", HealthState::kOk)) << client.process().output();
  EXPECT_TRUE(eventually([&] { return agree(*server, client); }));
  EXPECT_GT(client.devices()->tracker()->stations[1]->newest()->counter, counter);
  EXPECT_EQ(client.health("tracker")->reconnects, 1u);
}

// A server with a tracker, which is emulated, and a gamepad, which this test holds.
MerlindOptions wandServer(int port, const std::string& pad) {
  MerlindOptions options = vrpnServer(port);
  options.also["devices"] = nlohmann::json::array(
      {deviceEntry("tracker", "fastrak"), deviceEntry("pad", "evdev", "pty:" + pad)});
  return options;
}

// Both of it are read, by two connections.
MerlindOptions wandClient(int port) {
  const std::string server = fmt::format("tcp://127.0.0.1:{}", port);
  MerlindOptions options;
  options.emulate = false;
  options.also["devices"] =
      nlohmann::json::array({deviceEntry("eyes", "vrpn", server, {{"device", "Tracker0"}}),
                             deviceEntry("wand", "vrpn_pad", server, {{"device", "Ball0"}})});
  options.also["bindings"] = {{{"input", "wand.button.1"}, {"action", "next_mode"}},
                              {{"input", "wand.axis.ry+"}, {"action", "reset_view"}}};
  return options;
}

TEST(TodaysDevices, AWandOfAVrpnServerIsATrackerAndAPadWhoseButtonsActAndWhoseAnalogsMove) {
  const TempDir dir;
  const int port = freePort();
  Gamepad pad(dir / "pad");
  Merlind server(dir, "", "server", wandServer(port, dir / "pad"));
  ASSERT_TRUE(server.ready()) << server.process().output();  // its segment has all names
  ASSERT_TRUE(isConnected(server, pad, "pad")) << server.process().output();
  Merlind client(dir, makeModel(dir, 5), "client", wandClient(port));
  ASSERT_TRUE(client.ready()) << client.process().output();
  ASSERT_TRUE(client.healthIs("eyes", HealthState::kOk)) << client.process().output();
  ASSERT_TRUE(client.healthIs("wand", HealthState::kOk)) << client.process().output();
  EXPECT_STREQ(client.health("wand")->identity,
               "VRPN buttons and analogs Ball0 at server version 07.38");
  ASSERT_TRUE(eventually([&] { return client.wall().moving == 0; }));
  const auto begun = [&](std::size_t action) {
    return eventually([&] {
      const auto actions = client.actions("wand");
      return actions && actions->begun[action] == 1;
    });
  };
  pad.report(record(EvdevRecord::kPressed, BTN_SOUTH, 1));
  EXPECT_TRUE(begun(actionIndex("next_mode")));
  pad.report(record(EvdevRecord::kMoved, ABS_RX, 32767));
  EXPECT_TRUE(begun(actionIndex("reset_view"))) << "its pushed axis is an input too";
  EXPECT_TRUE(eventually([&] { return client.wall().moving == 1; }));
  EXPECT_FLOAT_EQ(client.devices()->ball("wand")->samples->newest()->rotation[1], 1);
  pad.report(record(EvdevRecord::kMoved, ABS_RX, 0) + record(EvdevRecord::kPressed, BTN_SOUTH, 0));
  EXPECT_TRUE(eventually([&] { return client.wall().moving == 0; }));
  EXPECT_EQ(client.devices()->ball("wand")->samples->newest()->buttons, 0u);
  server.process().kill(SIGKILL);
  EXPECT_TRUE(client.healthIs("wand", HealthState::kAbsent));
}

}  // namespace
}  // namespace merlin::test
