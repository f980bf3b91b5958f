// The devices that `merlin devices` finds in a synthetic /dev and /sys, and its table of live
// values.
#include "daemon/cli/devices/plugged.h"

#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "daemon/base/unique_fd.h"
#include "daemon/cli/devices/live_table.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

// Returns the bits in the form in which the kernel prints a bitmap: words of 64 bits, the highest
// first.
std::string bitmap(std::initializer_list<int> bits) {
  std::array<std::uint64_t, 12> words{};
  for (const int bit : bits) words[static_cast<std::size_t>(bit) / 64] |= 1ULL << bit % 64;
  std::string text;
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    if (*word != 0 || !text.empty()) text += fmt::format("{}{:x}", text.empty() ? "" : " ", *word);
  }
  return text.empty() ? "0" : text;
}

class PluggedTest : public testing::Test {
 protected:
  struct Bits {
    std::initializer_list<int> keys, absolute, relative = {};
  };
  void addInput(int number, const std::string& name, const Bits& bits,
                const std::string& link = {}) {
    const fs::path device = fmt::format("{}/sys/class/input/event{}/device", root(), number);
    fs::create_directories(device / "capabilities");
    test::writeText(device / "name", name + "\n");
    test::writeText(device / "capabilities/key", bitmap(bits.keys) + "\n");
    test::writeText(device / "capabilities/abs", bitmap(bits.absolute) + "\n");
    test::writeText(device / "capabilities/rel", bitmap(bits.relative) + "\n");
    const fs::path node = fmt::format("{}/dev/input/event{}", root(), number);
    fs::create_directories(node.parent_path() / "by-id");
    test::writeText(node, "");
    if (!link.empty()) fs::create_symlink(node, node.parent_path() / "by-id" / link);
  }
  std::string root() const { return dir_.path(); }

  test::TempDir dir_;
};

TEST_F(PluggedTest, AnEmptyMachineHasNothing) { EXPECT_TRUE(findPlugged(root()).empty()); }

TEST_F(PluggedTest, SerialAdaptersAreNamedByIdWhereTheyHaveOne) {
  fs::create_directories(root() + "/dev/serial/by-id");
  fs::create_directories(root() + "/sys/class/tty/ttyUSB0");
  fs::create_directories(root() + "/sys/class/tty/ttyUSB1");
  fs::create_directories(root() + "/sys/class/tty/ttyS0");  // exists even if no device is connected
  for (const char* name : {"ttyUSB0", "ttyUSB1", "ttyS0"})
    test::writeText(root() + "/dev/" + name, "");
  const std::string by_id = root() + "/dev/serial/by-id/usb-FTDI_A1-if00-port0";
  fs::create_symlink(root() + "/dev/ttyUSB0", by_id);
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].port, "serial:" + by_id);
  EXPECT_EQ(found[0].path, root() + "/dev/ttyUSB0");
  EXPECT_EQ(found[1].port, "serial:" + root() + "/dev/ttyUSB1");
  ASSERT_EQ(found[0].uses.size(), 3u);
  EXPECT_EQ(configurationEntry(found[0], found[0].uses[1]),
            "{\"name\": \"tracker\", \"driver\": \"fastrak\", \"port\": \"serial:" + by_id + "\"}");
}

TEST_F(PluggedTest, InputDevicesAreToldApart) {
  addInput(0, "Power Button", {{KEY_POWER}, {}});
  addInput(1, "pad", {{BTN_SOUTH, BTN_EAST}, {ABS_X, ABS_Y, ABS_RX, ABS_RY}},
           "usb-pad-event-joystick");
  addInput(2, "stick", {{BTN_TRIGGER}, {ABS_X, ABS_Y}});
  addInput(3, "SpaceMouse", {{BTN_0}, {}, {REL_X, REL_Y, REL_Z, REL_RX, REL_RY, REL_RZ}});
  addInput(4, "a mouse", {{BTN_LEFT}, {}, {REL_X, REL_Y}});
  addInput(5, "frame", {{BTN_TOUCH}, {ABS_X, ABS_Y, ABS_MT_POSITION_X}});
  addInput(8, "tablet", {{BTN_LEFT}, {ABS_X, ABS_Y}});
  addInput(6, "presenter", {{KEY_PAGEUP, KEY_PAGEDOWN}, {}});
  addInput(7, "keys", {{KEY_A, KEY_PAGEDOWN}, {}});
  std::vector<std::string> found;
  for (const Plugged& plugged : findPlugged(root()))
    found.push_back(plugged.name + ": " + plugged.kind);
  EXPECT_EQ(found, (std::vector<std::string>{"SpaceMouse: space mouse", "a mouse: mouse",
                                             "frame: touch screen", "keys: keyboard",
                                             "pad: gamepad", "presenter: clicker",
                                             "stick: joystick", "tablet: touch screen"}));
}

TEST_F(PluggedTest, AnInputDevicesEntryHasItsDriverAndALastingName) {
  addInput(12, "pad", {{BTN_SOUTH}, {ABS_X}}, "usb-pad-event-joystick");
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].uses.size(), 1u);
  EXPECT_EQ(configurationEntry(found[0], found[0].uses[0]),
            "{\"name\": \"pad\", \"driver\": \"evdev\", \"port\": \"evdev:" + root() +
                "/dev/input/by-id/usb-pad-event-joystick\"}");
  EXPECT_TRUE(found[0].readable);
}

// A device that /sys still lists may have lost its file in /dev a moment ago.
TEST_F(PluggedTest, AnInputDeviceThatIsGoneIsNotListedAndTheOthersAre) {
  addInput(1, "gone", {{BTN_SOUTH}, {ABS_X}});
  addInput(2, "pad", {{BTN_SOUTH}, {ABS_X}});
  fs::remove(root() + "/dev/input/event1");
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "pad");
}

TEST_F(PluggedTest, ATouchScreenAndAMouseServeAsTouchFrames) {
  addInput(1, "a mouse", {{BTN_LEFT}, {}, {REL_X, REL_Y}});
  addInput(2, "frame", {{BTN_TOUCH}, {ABS_X, ABS_Y, ABS_MT_POSITION_X}});
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 2u);
  ASSERT_EQ(found[0].uses.size(), 2u);
  EXPECT_EQ(found[0].uses[0].driver, "evdev");
  EXPECT_EQ(found[0].uses[1].driver, "touch");
  ASSERT_EQ(found[1].uses.size(), 1u);
  EXPECT_EQ(configurationEntry(found[1], found[1].uses[0]),
            R"({"name": "touch", "driver": "touch", "port": "evdev:)" + root() +
                R"(/dev/input/event2"})");
  EXPECT_TRUE(found[1].keys.empty()) << "the driver touch has no setting that names them";
}

TEST_F(PluggedTest, AnInputDevicesAxesAndKeysHaveTheConfigurationsNames) {
  addInput(1, "pad", {{BTN_SOUTH, BTN_EAST, BTN_TL}, {ABS_X, ABS_Y, ABS_RX, ABS_RY, ABS_HAT0X}});
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].axes, (std::vector<std::string>{"x", "y", "rx", "ry", "hat0x"}));
  EXPECT_EQ(found[0].keys, (std::vector<std::string>{"south", "east", "tl"}));
  EXPECT_EQ(found[0].usual, "axes x, none, y, ry, rx, -hat0x; buttons south, east, tl");
}

TEST_F(PluggedTest, NamesAreFreeUnlessOnlyOneOfSeveralUsesCanBe) {
  addInput(1, "pad", {{BTN_SOUTH}, {ABS_X}});
  addInput(2, "pad", {{BTN_SOUTH}, {ABS_X}});
  fs::create_directories(root() + "/dev/serial/by-id");
  for (const char* name : {"a", "b"}) test::writeText(root() + "/dev/serial/by-id/" + name, "");
  auto found = findPlugged(root());
  nameApart(found, {"pad", "tracker", "tracker_2"});
  std::vector<std::string> names;
  for (const Plugged& plugged : found) {
    for (const auto& use : plugged.uses) names.push_back(use.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"glove", "tracker_3", "ball", "glove", "tracker_3",
                                             "ball", "pad_2", "pad_3"}));
}

TEST_F(PluggedTest, SpacenavdsSocketIsOfferedAndAFileOfThatNameIsNot) {
  fs::create_directories(root() + "/run");
  const std::string path = root() + "/run/spnav.sock";
  test::writeText(path, "");
  EXPECT_TRUE(findPlugged(root()).empty());
  fs::remove(path);
  const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::copy(path.begin(), path.end(), address.sun_path);
  ASSERT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const auto found = findPlugged(root());
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].uses.size(), 1u);
  EXPECT_EQ(configurationEntry(found[0], found[0].uses[0]),
            "{\"name\": \"mouse\", \"driver\": \"spacenav\", \"port\": \"unix:" + path + "\"}");
}

TEST(LiveTable, ABarShowsHowFarAnAxisIsPushed) {
  EXPECT_EQ(axisBar(0), "[          |          ]");
  EXPECT_EQ(axisBar(0.5F), "[          |#####     ]");
  EXPECT_EQ(axisBar(-1), "[##########|          ]");
}

DeviceHealth health(HealthState state, const std::string& identity, const std::string& reason) {
  DeviceHealth h{};
  h.state = state;
  h.updated_ns = 1'000'000'000;
  h.rate_hz = 20;
  std::copy(identity.begin(), identity.end(), h.identity);
  std::copy(reason.begin(), reason.end(), h.reason);
  return h;
}

TEST(LiveTable, ShowsWhatWorkingDevicesMeasureAndWhyOthersDoNot) {
  test::LocalDevices devices;
  devices->health[test::kGlove].publish(health(HealthState::kAbsent, "", "not configured"));
  devices->health[test::kBall].publish(health(HealthState::kOk, "pad, 8 axes", ""));
  BallSample ball{};
  ball.translation[1] = -0.5F;
  ball.raw[1] = -700;
  ball.rotation[0] = 0.25F;
  ball.buttons = 0x801;
  ball.keys[0] = BTN_SOUTH;
  devices->ball[0].publish(ball);
  const std::string text = liveTable(devices.slots(), fromNanoseconds(1'100'000'000));
  EXPECT_NE(text.find("glove      absent      20.0 Hz  not configured\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("ball       ok          20.0 Hz  pad, 8 axes\n"), std::string::npos) << text;
  EXPECT_NE(text.find("axis.y-  [     #####|          ] -0.500  raw -700\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("axis.rx+ ["), std::string::npos) << text;
  EXPECT_NE(text.find("axis.z   ["), std::string::npos) << "at rest";
  EXPECT_NE(text.find("pressed  button.1 button.12 button.south\n"), std::string::npos) << text;
}

TEST(LiveTable, ShowsWhatADeviceThatWorksComplainsOf) {
  test::LocalDevices devices;
  devices->health[test::kBall].publish(
      health(HealthState::kOk, "pad, 8 axes", "it has no axis throttle"));
  const std::string text = liveTable(devices.slots(), fromNanoseconds(1'100'000'000));
  EXPECT_NE(text.find("20.0 Hz  pad, 8 axes; it has no axis throttle\n"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace merlin::cli
