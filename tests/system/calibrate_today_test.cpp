// merlin calibrate pad, touch and tracker with present-day devices. The command opens them itself:
// records of an input device over a pseudo-terminal, and OSC.
#include <atomic>
#include <mutex>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "drivers/io/pty_master.h"
#include "tests/support/evdev_records.h"
#include "tests/support/osc_packets.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

std::string moved(int code, int value) { return evdevRecord(EvdevRecord::kMoved, code, value); }

// The device's end of an input device's pseudo-terminal.
class Line {
 public:
  explicit Line(const std::string& link) : line_(*io::PtyMaster::open(link)) {}
  void say(const std::string& bytes) const {
    (void)!::write(line_.fd(), bytes.data(), bytes.size());  // nobody may have opened the line yet
  }
  void report(const std::string& events) const { say(events + evdevRecord(EvdevRecord::kReport)); }
  // Sends the description repeatedly until the command has read it, since bytes sent before the
  // line is opened are lost.
  bool describes(Process& calibrate, const std::string& description) const {
    return eventually([&] {
      if (calibrate.output().find("\nrest: ") != std::string::npos ||
          calibrate.output().find("\ntop left: ") != std::string::npos || calibrate.ended())
        return true;
      say(description);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      return false;
    });
  }

 private:
  io::PtyMaster line_;
};

std::string description(std::initializer_list<std::array<int, 4>> axes) {
  std::string text;
  for (const auto& [code, value, low, high] : axes)
    text += evdevRecord(EvdevRecord::kAxis, code, value, low, high);
  return text + evdevRecord(EvdevRecord::kReady);
}

std::vector<std::string> calibrate(const std::string& what, const std::string& file) {
  return {kMerlin, "calibrate", what, "-o", file, "--hold", "0.4"};
}

json savedOf(const std::string& file, const std::string& driver) {
  const json config = json::parse(readText(file));
  for (const json& device : config["devices"]) {
    if (device["driver"] == driver) return device[driver];
  }
  return nullptr;
}

// For each step: its name, and the device's events as the person moves it before pressing Enter.
using Steps = std::vector<std::pair<const char*, std::string>>;

void walk(Process& calibrate, const Line& line, const Steps& steps) {
  for (const auto& [name, events] : steps) {
    ASSERT_TRUE(calibrate.saysEventually(fmt::format("\n{}: ", name))) << calibrate.output();
    if (!events.empty()) line.report(events);
    calibrate.type("\n");
  }
  EXPECT_EQ(calibrate.wait(), 0) << calibrate.output();
}

TEST(CalibratePad, AsksForMovesAndWritesAxesThatMerlindTakes) {
  const TempDir dir;
  const Line line(dir / "pad");
  const std::string file = dir / "merlin.json";
  // Without --device the command uses the gamepad, although the list has a ball before the gamepad.
  const json pad = deviceEntry("pad", "evdev", "pty:" + dir / "pad", {{"curve", 1.5}});
  writeText(file, json{{"devices", json::array({deviceEntry("ball", "spaceball"), pad})}}.dump());
  Process process(calibrate("pad", file));
  ASSERT_TRUE(line.describes(process, description({{ABS_X, 0, -128, 127},
                                                   {ABS_Y, 0, -128, 127},
                                                   {ABS_Z, 0, 0, 255},
                                                   {ABS_RX, 0, -128, 127},
                                                   {ABS_RZ, 0, 0, 255}})));
  const std::string back = moved(ABS_X, 0) + moved(ABS_Y, 0) + moved(ABS_RZ, 0) + moved(ABS_RX, 0);
  walk(process, line,
       {{"rest", ""},
        {"right", moved(ABS_RX, 127)},
        {"up", back + moved(ABS_RZ, 255)},
        {"towards you", back + moved(ABS_Y, -128)},
        {"tilt", back},
        {"turn", moved(ABS_X, 127)},
        {"roll", back}});
  const json saved = savedOf(file, "evdev");
  EXPECT_EQ(saved["axes"], json({"rx", "rz-z", "-y", "none", "x", "none"})) << process.output();
  EXPECT_EQ(saved["dead_zone"], 0.05);
  EXPECT_EQ(saved["curve"], 1.5);
  EXPECT_EQ(run({kMerlind, "--check-config", file, "--role", "devices"}).status, 0);
}

TEST(CalibratePad, WritesGivenValuesOrSaysWhatIsWrong) {
  const TempDir dir;
  const std::string file = dir / "merlin.json";
  writeText(file, onlyDevice(deviceEntry("pad", "evdev", "pty:" + dir / "pad")).dump());
  const Outcome set = run({kMerlin, "calibrate", "pad", "--axes=-x,rz-z,y,ry,rx,none",
                           "--dead-zone", "0.2", "-o", file});
  EXPECT_EQ(set.status, 0) << set.output;
  EXPECT_EQ(savedOf(file, "evdev")["axes"], json({"-x", "rz-z", "y", "ry", "rx", "none"}));
  EXPECT_EQ(savedOf(file, "evdev")["dead_zone"], 0.2);
  const std::string before = readText(file);
  const Outcome wrong =
      run({kMerlin, "calibrate", "pad", "--axes", "x,y,x,ry,rx,none", "-o", file});
  EXPECT_EQ(wrong.status, 2) << wrong.output;
  EXPECT_NE(wrong.output.find("/devices/0/evdev/axes/2"), std::string::npos) << wrong.output;
  const Outcome ball = run({kMerlin, "calibrate", "ball", "-o", file});
  EXPECT_NE(ball.output.find("run `merlin calibrate pad --device pad"), std::string::npos)
      << ball.output;
  writeText(dir / "ball.json", onlyDevice(deviceEntry("ball", "spaceball")).dump());
  const Outcome pad = run({kMerlin, "calibrate", "pad", "--curve", "2", "-o", dir / "ball.json"});
  EXPECT_NE(pad.output.find("`merlin calibrate ball` calibrates; for a pad"), std::string::npos)
      << pad.output;
  writeText(dir / "none.json", onlyDevice(deviceEntry("glove", "cyberglove")).dump());
  const Outcome none = run({kMerlin, "calibrate", "pad", "--curve", "2", "-o", dir / "none.json"});
  EXPECT_NE(none.output.find("/devices has no device with the driver evdev or vrpn_pad: add one"),
            std::string::npos)
      << none.output;
  EXPECT_EQ(readText(file), before);
}

TEST(CalibrateTouch, AsksForThreeCorners) {
  const TempDir dir;
  const Line line(dir / "frame");
  const std::string file = dir / "merlin.json";
  // The present settings have no effect, since corners are measured in the device's own axes.
  writeText(file, onlyDevice(deviceEntry("frame", "touch", "pty:" + dir / "frame",
                                         {{"invert_y", true}, {"aspect", 1.5}}))
                      .dump());
  Process process(calibrate("touch", file));
  ASSERT_TRUE(line.describes(process, description({{ABS_MT_SLOT, 0, 0, 9},
                                                   {ABS_MT_TRACKING_ID, 0, 0, 65535},
                                                   {ABS_MT_POSITION_X, 0, 0, 1000},
                                                   {ABS_MT_POSITION_Y, 0, 0, 1000}})));
  const auto at = [](int id, int x, int y) {
    return moved(ABS_MT_SLOT, 0) + moved(ABS_MT_TRACKING_ID, id) + moved(ABS_MT_POSITION_X, x) +
           moved(ABS_MT_POSITION_Y, y);
  };
  // The touch frame is mounted with a quarter turn.
  walk(process, line,
       {{"top left", at(1, 980, 30)},
        {"top right", at(2, 970, 960)},
        {"bottom left", at(3, 40, 20)}});
  const json saved = savedOf(file, "touch");
  EXPECT_EQ(saved,
            json({{"invert_y", true}, {"aspect", 1.5}, {"swap_axes", true}, {"invert_x", false}}))
      << process.output();
  const Outcome counts = run({kMerlin, "calibrate", "touch", "--mouse-counts", "3000", "-o", file});
  EXPECT_EQ(counts.status, 0) << counts.output;
  EXPECT_EQ(savedOf(file, "touch")["mouse_counts"], 3000);
}

// Sends a station's pose repeatedly, as a tracking system does.
class OscSender {
 public:
  OscSender() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    const UniqueFd probe(::socket(AF_INET, SOCK_DGRAM, 0));
    EXPECT_EQ(::bind(probe.get(), reinterpret_cast<sockaddr*>(&address_), size), 0);
    ::getsockname(probe.get(), reinterpret_cast<sockaddr*>(&address_), &size);
    thread_ = std::jthread([this](const std::stop_token& stop) { send(stop); });
  }
  int port() const { return ntohs(address_.sin_port); }
  // Moves the station; returns once no pose of its previous place is on its way any more.
  void holdAt(float x, float y, float z) {
    {
      const std::lock_guard lock(mutex_);
      place_ = {x, y, z};
    }
    const int before = sent_;
    EXPECT_TRUE(eventually([&] { return sent_ >= before + 2; }));
  }

 private:
  std::array<float, 3> place() {
    const std::lock_guard lock(mutex_);
    return place_;
  }
  void send(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const auto [x, y, z] = place();
      const std::string bytes = oscMessage("/tracker/1/pose", {x, y, z, 0.0F, 0.0F, 0.0F, 1.0F});
      (void)::sendto(socket_.get(), bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&address_), sizeof address_);
      ++sent_;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  UniqueFd socket_;
  sockaddr_in address_{};
  std::atomic<int> sent_{0};
  std::mutex mutex_;
  std::array<float, 3> place_{};
  std::jthread thread_;
};

TEST(CalibrateTracker, OfASenderWithAFrameOfItsOwnSetsAxesAndOrigin) {
  const TempDir dir;
  const std::string file = dir / "merlin.json";
  OscSender sender;
  writeText(file,
            onlyDevice(deviceEntry("wand", "osc", fmt::format("udp://127.0.0.1:{}", sender.port()),
                                   {{"axes", {2, 1, 3}}}))
                .dump());
  sender.holdAt(0.5F, 1.2F, -0.3F);
  Process process(calibrate("tracker", file));
  ASSERT_TRUE(process.saysEventually("\norigin: ")) << process.output();
  process.type("\n");
  ASSERT_TRUE(process.saysEventually("\nx axis: ")) << process.output();
  sender.holdAt(0.5F, 1.2F, 0.7F);
  process.type("\n");
  ASSERT_TRUE(process.saysEventually("\ny axis: ")) << process.output();
  sender.holdAt(-0.5F, 1.2F, -0.3F);
  process.type("\n");
  EXPECT_EQ(process.wait(), 0) << process.output();
  const json saved = savedOf(file, "osc");
  EXPECT_EQ(saved["axes"], json({3, -1, -2})) << process.output();
  const double origin[] = {0.3, 0.5, 1.2};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(saved["origin_m"][i].get<double>(), origin[i], 1e-4);
  EXPECT_EQ(run({kMerlind, "--check-config", file, "--role", "devices"}).status, 0);
}

}  // namespace
}  // namespace merlin::test
