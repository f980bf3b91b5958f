// Present-day devices at a real merlind: a space mouse through the real spacenavd, a gamepad whose
// records come over a pseudo-terminal, and the tracker of a VRPN server, which is another merlind.
// Whether the kernel gives such records for real devices is tested in the virtual machine
// (tests/vm).
#include <algorithm>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <unistd.h>

#include "daemon/base/commands.h"
#include "daemon/net/connection_server.h"
#include "drivers/io/pty_master.h"
#include "tests/support/evdev_records.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn_messages.h"
#include "tests/support/vrpn_speaker.h"
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

// A spacenavd process that reads a ball at this line, in a folder of its own.
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
  // The visitor turns the model from time to time. spacenavd gives up on a ball that does not
  // answer in time, as happens on a busy machine; the test then starts spacenavd again, as a
  // service manager would.
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

// A gamepad at the other end of a pseudo-terminal, which merlind opens once it exists.
class Gamepad {
 public:
  explicit Gamepad(const std::string& link) : line_(*io::PtyMaster::open(link)) {}
  void describe() {
    std::string text = evdevNamed(EvdevRecord::kName, 0, "made-up pad");
    for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY})
      text += evdevRecord(EvdevRecord::kAxis, code, 0, -32768, 32767);
    text += evdevNamed(EvdevRecord::kKey, BTN_SOUTH, "SOUTH");
    text += evdevRecord(EvdevRecord::kReady);
    (void)!::write(line_.fd(), text.data(), text.size());  // nobody may have opened the line yet
  }
  void report(const std::string& events) {
    const std::string bytes = events + evdevRecord(EvdevRecord::kReport);
    EXPECT_EQ(::write(line_.fd(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  io::PtyMaster line_;
};

// merlind reopens a line that sends nothing. The test sends the description once after each
// opening, since bytes that were sent before are partly lost.
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
  pad.report(evdevRecord(EvdevRecord::kMoved, ABS_RX, 32767));
  EXPECT_TRUE(eventually([&] { return merlind.wall().moving == 1; }));
  EXPECT_FLOAT_EQ(ballOf(merlind)->rotation[1], 1);
  // The stick is held and sends no further event; the model goes on turning.
  const std::uint32_t counter = ballOf(merlind)->counter;
  EXPECT_TRUE(eventually([&] { return ballOf(merlind)->counter > counter + 20; }));
  EXPECT_EQ(merlind.wall().moving, 1u);
  pad.report(evdevRecord(EvdevRecord::kMoved, ABS_RX, 0));
  EXPECT_TRUE(eventually([&] { return merlind.wall().moving == 0; }));
  // ball.button.1 is bound to reset_view
  pad.report(evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 1));
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
  pad.report(evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 1));
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

// Returns whether the newest sample of the client's station 2 is a sample of the server's station
// 1.
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
  EXPECT_NE(calibrated.output.find("/devices/0/driver (device \"tracker\") is \"vrpn\""),
            std::string::npos)
      << calibrated.output;
  const auto counter = client.devices()->tracker()->stations[1]->newest()->counter;
  server->process().kill(SIGKILL);
  EXPECT_TRUE(client.healthIs("tracker", HealthState::kAbsent));
  server.emplace(dir, "", "again", vrpnServer(port));
  EXPECT_TRUE(client.healthIs("tracker", HealthState::kOk)) << client.process().output();
  EXPECT_TRUE(eventually([&] { return agree(*server, client); }));
  EXPECT_GT(client.devices()->tracker()->stations[1]->newest()->counter, counter);
  EXPECT_EQ(client.health("tracker")->reconnects, 1u);
}

// Options of a server with an emulated tracker, and a gamepad that the test controls.
MerlindOptions wandServer(int port, const std::string& pad) {
  MerlindOptions options = vrpnServer(port);
  options.also["devices"] = nlohmann::json::array(
      {deviceEntry("tracker", "fastrak"), deviceEntry("pad", "evdev", "pty:" + pad)});
  return options;
}

// Options of a client that reads both devices over two connections.
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
  // the server's segment has all names now
  ASSERT_TRUE(server.ready()) << server.process().output();
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
  pad.report(evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 1));
  EXPECT_TRUE(begun(actionIndex("next_mode")));
  pad.report(evdevRecord(EvdevRecord::kMoved, ABS_RX, 32767));
  EXPECT_TRUE(begun(actionIndex("reset_view"))) << "its pushed axis is an input too";
  EXPECT_TRUE(eventually([&] { return client.wall().moving == 1; }));
  EXPECT_FLOAT_EQ(client.devices()->ball("wand")->samples->newest()->rotation[1], 1);
  pad.report(evdevRecord(EvdevRecord::kMoved, ABS_RX, 0) +
             evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 0));
  EXPECT_TRUE(eventually([&] { return client.wall().moving == 0; }));
  EXPECT_EQ(client.devices()->ball("wand")->samples->newest()->buttons, 0u);
  server.process().kill(SIGKILL);
  EXPECT_TRUE(client.healthIs("wand", HealthState::kAbsent));
}

// The tracker of the first hand is missing, so that only the wand's own hand can point.
TEST(TodaysDevices, AWandOfAVrpnServerPointsWithItsOwnTracker) {
  const TempDir dir;
  const int port = freePort();
  Gamepad pad(dir / "pad");
  Merlind server(dir, "", "server", wandServer(port, dir / "pad"));
  ASSERT_TRUE(server.ready()) << server.process().output();
  ASSERT_TRUE(isConnected(server, pad, "pad")) << server.process().output();
  MerlindOptions options = wandClient(port);
  options.also["devices"].push_back(deviceEntry("gone", "fastrak"));
  options.also["hands"] = {
      {{"name", "first"}, {"glove", "none"}, {"tracker", "gone"}},
      {{"name", "pointer"}, {"glove", "none"}, {"tracker", "eyes"}, {"buttons", "wand"}}};
  options.also["bindings"] = {{{"input", "wand.button.1"}, {"action", "point_at"}}};
  Merlind client(dir, makeModel(dir, 5), "client", options);
  ASSERT_TRUE(client.ready()) << client.process().output();
  ASSERT_TRUE(client.healthIs("eyes", HealthState::kOk)) << client.process().output();
  ASSERT_TRUE(client.healthIs("wand", HealthState::kOk)) << client.process().output();
  const auto wall =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(client.instance(), "wall"));
  ASSERT_TRUE(wall);
  const auto points = [&](bool expected) {
    return eventually([&] {
      const auto interaction = (*wall)->interaction.read();
      return interaction && (interaction->pointing != shm::WallInteraction::kNone) == expected;
    });
  };
  EXPECT_TRUE(points(false));
  pad.report(evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 1));
  EXPECT_TRUE(points(true));
  pad.report(evdevRecord(EvdevRecord::kPressed, BTN_SOUTH, 0));
  EXPECT_TRUE(points(false));
}

// Returns what `merlin devices --json` reports about the VRPN server at this port; `options`:
// further options.
nlohmann::json vrpnServerAt(int port, std::vector<std::string> options = {}) {
  const std::string host = fmt::format("127.0.0.1:{}", port);
  options.insert(options.begin(), {kMerlin, "devices", "--json", "--vrpn", host});
  const auto all = nlohmann::json::parse(run(options).output, nullptr, false);
  for (const auto& server : all.value("vrpn_servers", nlohmann::json::array())) {
    if (server["port"] == "tcp://" + host) return server;
  }
  return {};
}

// The configuration entry with which this driver reads the server's device; null if there is none.
nlohmann::json entryFor(const nlohmann::json& server, const std::string& device,
                        const std::string& driver) {
  for (const auto& one : server.value("devices", nlohmann::json::array())) {
    for (const auto& entry : one["as"]) {
      if (one["name"] == device && entry["driver"] == driver) return entry;
    }
  }
  return {};
}

TEST(TodaysDevices, AVrpnServersDevicesAreListedWithTheEntryThatMakesThemDevices) {
  const TempDir dir;
  const int port = freePort();
  Merlind server(dir, "", "server", vrpnServer(port));
  ASSERT_TRUE(server.ready()) << server.process().output();
  nlohmann::json listed, entry;
  // The test repeats this, since on a busy machine a server may take longer than the half second
  // that it is given.
  ASSERT_TRUE(eventually([&] {
    listed = vrpnServerAt(port);
    entry = entryFor(listed, "Tracker0", "vrpn");
    return !entry.is_null() && entryFor(listed, "Tracker0", "vrpn_pad").is_null();
  })) << listed;
  EXPECT_EQ(listed["version"], "07.38");
  EXPECT_FALSE(listed["own"]);
  EXPECT_EQ(entryFor(listed, "Ball0", "vrpn_pad")["vrpn_pad"]["device"], "Ball0");
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = onlyDevice(entry);
  Merlind client(dir, "", "client", options);
  EXPECT_TRUE(client.healthIs(entry["name"], HealthState::kOk)) << client.process().output();
  EXPECT_TRUE(eventually([&] {
    listed = vrpnServerAt(port, {"-c", client.config()});
    return listed["answers"] == true;
  }));
  EXPECT_TRUE(entryFor(listed, "Tracker0", "vrpn").is_null()) << "it is configured now";
  EXPECT_FALSE(entryFor(listed, "Ball0", "vrpn_pad").is_null());
  // The running merlind reports which devices it reads and which servers it knows.
  nlohmann::json read_by;
  EXPECT_TRUE(eventually([&] {
    const auto all = nlohmann::json::parse(
        run({kMerlin, "devices", "--json", "--instance", client.instance()}).output, nullptr,
        false);
    for (const auto& asked : all["vrpn_servers"]) {
      for (const auto& device : asked["devices"]) {
        if (device["name"] == "Tracker0") read_by = device["read_by"];
      }
    }
    return read_by == nlohmann::json::array({entry["name"]});
  })) << read_by;
}

TEST(TodaysDevices, MerlindIsNotOfferedWhatItServesItself) {
  const TempDir dir;
  const int port = freePort();
  Merlind server(dir, "", "server", vrpnServer(port));
  ASSERT_TRUE(server.ready()) << server.process().output();
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--instance", server.instance()}, {"-c", server.config()}}) {
    nlohmann::json listed;
    EXPECT_TRUE(eventually([&] {
      listed = vrpnServerAt(port, options);
      return listed["answers"] == true;
    }));
    EXPECT_TRUE(listed["own"]) << listed;
    EXPECT_EQ(listed["devices"].size(), 0u) << listed;
  }
}

TEST(TodaysDevices, AVrpnServerThatLiesOrNeverAnswersHarmsNoList) {
  const TempDir dir;
  const auto silent = net::listenTcp("127.0.0.1", 0);
  const std::string evil = R"(a "b"}, {"name": "evil)";
  std::string lies = vrpnCookie() + vrpnType(4, kVrpnPoseType) + vrpnSender(1, evil) +
                     vrpnSender(2, "\x1B]0;title\x07\x1B[2J") +
                     vrpnSender(3, std::string(5000, 'x')) +
                     vrpnSender(4,
                                "\xC2\x9B"
                                "31m") +
                     vrpnMessage(99, 4, "x");
  for (int i = 0; i < 2000; ++i) lies += vrpnSender(100 + i, fmt::format("many{}", i));
  lies += std::string(64, '\xFF');
  const VrpnSpeaker liar(lies);
  const auto list = [&](const char* json) {
    return run({kMerlin, "devices", "--vrpn", fmt::format("127.0.0.1:{}", liar.port()), "--vrpn",
                fmt::format("localhost:{}", net::portOf(silent->get())), json});
  };
  Outcome text;
  EXPECT_TRUE(eventually([&] {
    text = list("--instance=none");
    return text.output.find("an invalid length") != std::string::npos;
  })) << text.output;
  EXPECT_EQ(text.status, 0);
  EXPECT_EQ(text.output.find_first_of("\x1B\x07\xC2"), std::string::npos) << text.output;
  EXPECT_EQ(text.output.find(std::string(100, 'x')), std::string::npos);
  EXPECT_NE(text.output.find(R"("vrpn": {"device": "a \"b\"}, {\"name\": \"evil"})"),
            std::string::npos)
      << text.output;
  EXPECT_NE(text.output.find(": no answer within 0.5 s\n"), std::string::npos) << text.output;
  EXPECT_LT(std::ranges::count(text.output, '\n'), 250) << "at most 64 devices of a server";
  const Outcome asked = list("--json");
  const auto json = nlohmann::json::parse(asked.output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << asked.output;
  EXPECT_EQ(asked.output.find('\x1B'), std::string::npos);
  EXPECT_EQ(run({kMerlin, "devices", "--vrpn", "a b"}).status, 2);
  EXPECT_EQ(run({kMerlin, "devices", "-c", dir / "none.json"}).status, 2);
}

}  // namespace
}  // namespace merlin::test
