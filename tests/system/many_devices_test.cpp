// Several devices of each kind at one merlind, over pseudo-terminals: two gloves, a tracker with
// two stations, two balls, a gamepad and two hands; and a tracker of a VRPN server. Each device has
// its slots under its name and is not affected by the others. Two people take turns at the wall.
#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <unistd.h>

#include "daemon/base/commands.h"
#include "drivers/io/pty_master.h"
#include "tests/support/evdev_records.h"
#include "tests/support/free_port.h"
#include "tests/system/contiguous.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr std::size_t kNextMode = actionIndex("next_mode"), kResetView = actionIndex("reset_view"),
                      kFreeze = actionIndex("freeze"), kBlank = actionIndex("blank");

struct Emulated {
  std::string name, driver, script;
  std::vector<std::string> more = {};  // further options of merlin emulate
};

// Emulated devices, each a process that can be killed alone.
class Emulators {
 public:
  explicit Emulators(std::vector<Emulated> all) : all_(std::move(all)) {
    for (const Emulated& device : all_) start(device.name);
  }

  void start(const std::string& name) {
    const Emulated& device = *std::ranges::find(all_, name, &Emulated::name);
    std::vector<std::string> words = {kMerlin,    "emulate",     device.driver, "--link", at(name),
                                      "--script", device.script, "--epoch-ns",  "1"};
    words.insert(words.end(), device.more.begin(), device.more.end());
    auto process = std::make_unique<Process>(words);
    EXPECT_TRUE(process->saysEventually(device.driver + " on")) << process->output();
    processes_[name] = std::move(process);
  }
  void kill(const std::string& name) { processes_.at(name)->kill(SIGKILL); }

  // Advances an emulator's person by `phases` phases of its script. REQUIRES: an emulator with the
  // option --step.
  void step(const std::string& name, int phases) {
    for (int i = 0; i < phases; ++i) {
      const std::size_t said = processes_.at(name)->output().size();
      processes_.at(name)->type("\n");
      EXPECT_TRUE(eventually([&] { return processes_.at(name)->output().size() > said; }));
    }
  }

  // Returns the devices as a list for the configuration. `people`: the person of each device.
  json list(const std::map<std::string, std::string>& people = {}) const {
    json all = json::array();
    for (const Emulated& device : all_) {
      all.push_back(deviceEntry(device.name, device.driver, "pty:" + at(device.name)));
      if (people.contains(device.name)) all.back()["person"] = people.at(device.name);
    }
    return all;
  }
  const std::vector<Emulated>& all() const { return all_; }

 private:
  std::string at(const std::string& name) const { return dir_ / ("line-" + name); }

  TempDir dir_;
  std::vector<Emulated> all_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
};

// A gamepad at the other end of a pseudo-terminal. A thread sends its description and stick
// movements repeatedly, so that merlind may open it at any time.
class Gamepad {
 public:
  explicit Gamepad(const std::string& link)
      : line_(*io::PtyMaster::open(link)),
        thread_([this](const std::stop_token& stop) { speak(stop); }) {}

 private:
  void speak(const std::stop_token& stop) const {
    using Kind = EvdevRecord::Kind;
    const std::string description =
        evdevRecord(Kind::kAxis, ABS_X, 0, -100, 100) + evdevRecord(Kind::kReady);
    for (int turn = 0; !stop.stop_requested(); ++turn) {
      const std::string bytes =
          description + evdevRecord(Kind::kMoved, ABS_X, turn % 100) + evdevRecord(Kind::kReport);
      (void)!::write(line_.fd(), bytes.data(), bytes.size());
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  io::PtyMaster line_;
  std::jthread thread_;
};

// The tracker of a VRPN server, which is another merlind.
class VrpnServer {
 public:
  explicit VrpnServer(const TempDir& dir) : dir_(dir), port_(freePort()) { start(); }
  void start() {
    server_.emplace(
        dir_, "", fmt::format("server{}", ++starts_),
        MerlindOptions{
            .script = "turning", .role = "devices", .also = {{"serve", {{"vrpn_port", port_}}}}});
  }
  void kill() { server_->process().kill(SIGKILL); }
  json entry() const {
    return deviceEntry("eyes", "vrpn", fmt::format("tcp://127.0.0.1:{}", port_));
  }

 private:
  const TempDir& dir_;
  int port_, starts_ = 0;
  std::optional<Merlind> server_;
};

// A device that a test can take away and bring back.
struct Removable {
  std::string name;
  std::function<void()> remove, bring_back;
};

class ManyDevices : public testing::Test {
 protected:
  // Starts merlind. Both hands make a fist and open it repeatedly, at the same time. `more`:
  // further devices.
  void start(const std::string& script_of_near, const std::string& script_of_far,
             const json& more = json::array()) {
    emulators_.emplace(std::vector<Emulated>{{"left", "cyberglove", "grabbing"},
                                             {"right", "cyberglove", "grabbing"},
                                             {"stage", "fastrak", "grabbing", {"--model", "2"}},
                                             {"near", "spaceball", script_of_near},
                                             {"far", "spaceball", script_of_far}});
    json list = emulators_->list();
    if (more.empty()) list.push_back(deviceEntry("pad", "evdev", "evdev:" + dir_ / "no-gamepad"));
    list.insert(list.end(), more.begin(), more.end());
    json hands = {{{"name", "left_hand"}, {"glove", "left"}, {"station", 1}},
                  {{"name", "right_hand"}, {"glove", "right"}, {"station", 2}}};
    if (!more.empty())
      hands.push_back({{"name", "wand"}, {"glove", "none"}, {"tracker", "eyes"}, {"station", 1}});
    const json bindings = {{{"input", "left.posture.fist"}, {"action", "next_mode"}},
                           {{"input", "right.posture.open"}, {"action", "reset_view"}},
                           {{"input", "far.button.1"}, {"action", "freeze"}},
                           {{"input", "button.3"}, {"action", "blank"}}};
    m_.emplace(
        dir_, "", "many",
        MerlindOptions{.role = "devices",
                       .emulate = false,
                       .also = {{"devices", list}, {"hands", hands}, {"bindings", bindings}}});
    ASSERT_TRUE(m_->ready()) << m_->process().output();
    for (const Emulated& device : emulators_->all())
      ASSERT_TRUE(m_->healthIs(device.name, HealthState::kOk))
          << device.name << m_->process().output();
  }
  // Returns how often inputs of the device have begun this action; `action` is an index of
  // kActions.
  std::uint32_t begun(const std::string& device, std::size_t action) {
    const auto state = m_->actions(device);
    return state ? state->begun[action] : 0;
  }
  // Returns the number of samples that the device has sent.
  std::uint64_t count(const std::string& device) {
    const auto* const slots = m_->devices();
    if (const auto* const glove = slots->glove(device)) return glove->samples->count();
    if (const auto* const ball = slots->ball(device)) return ball->samples->count();
    const auto& stations = slots->tracker(device)->stations;
    return device == "eyes" ? stations[0]->count()
                            : std::min(stations[0]->count(), stations[1]->count());
  }

  TempDir dir_;
  std::optional<Emulators> emulators_;
  std::optional<Merlind> m_;
};

// Returns whether `is` holds for one of the newest samples of the channel.
template <typename T, typename Is>
bool has(const shm::Channel<T>& channel, Is is) {
  const std::uint64_t count = channel.count();
  for (std::uint64_t n = count - std::min<std::uint64_t>(count, shm::kHistory - 1); n < count;
       ++n) {
    const auto sample = channel.at(n);
    if (sample && is(*sample)) return true;
  }
  return false;
}

// Returns whether the hand's newest sample combines this glove's joints with this station's record.
bool isMadeOf(const shm::DeviceSlots& devices, const char* hand, const char* glove,
              std::size_t station) {
  const auto made = devices.hand(hand)->samples->newest();
  if (!made || (made->flags & HandSample::kJoints) == 0) return false;
  return has(*devices.glove(glove)->samples,
             [&](const GloveSample& g) {
               return g.received_ns == made->glove_ns &&
                      std::ranges::equal(g.angle_rad, made->joint_rad);
             }) &&
         has(*devices.tracker("stage")->stations[station - 1], [&](const TrackerSample& t) {
           return t.received_ns == made->received_ns && t.counter == made->counter;
         });
}

TEST_F(ManyDevices, EachHasItsSlotsAndItsPlaceInTheStatusUnderItsName) {
  start("turning", "turning");
  for (const Emulated& device : emulators_->all())
    EXPECT_TRUE(eventually([&] { return count(device.name) > 20; })) << device.name;
  EXPECT_TRUE(m_->healthIs("pad", HealthState::kAbsent));
  const shm::DeviceSlots& devices = *m_->devices();
  EXPECT_EQ(devices.tracker("stage")->stations[2]->count(), 0u);
  EXPECT_TRUE(eventually([&] { return isMadeOf(devices, "left_hand", "left", 1); }));
  EXPECT_TRUE(eventually([&] { return isMadeOf(devices, "right_hand", "right", 2); }));
  for (const char* name : {"left", "right"})
    EXPECT_TRUE(devices.glove(name)->posture->newest()) << name;

  const auto dump = json::parse(
      run({kMerlin, "shm", "dump", "--json", "--instance", m_->instance()}).output, nullptr, false);
  const auto& fields = dump["/" + m_->instance() + "-devices"];
  for (const char* field :
       {"left.angle_rad", "right.angle_rad", "right.posture.name", "stage1.position_m",
        "stage2.position_m", "near.translation", "far.rotation", "pad.health.state",
        "left_hand.joint_rad", "right_hand.position_m", "actions.far.begun"})
    EXPECT_TRUE(fields.contains(field)) << field;
  EXPECT_FALSE(fields.contains("glove.angle_rad")) << "no device has the default name";

  json status;
  // All conditions have to hold at the same time; on a busy machine, a device may be stale for a
  // moment.
  EXPECT_TRUE(eventually([&] {
    status = m_->status();
    return status["devices"].size() == 6 &&
           std::ranges::all_of(emulators_->all(), [&](const Emulated& device) {
             return status["devices"][device.name]["health"] == "ok";
           });
  })) << status;
  EXPECT_EQ(status["devices"]["pad"]["health"], "absent");
  for (const char* name : {"left", "right"}) EXPECT_TRUE(status["postures"].contains(name)) << name;
  EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
  EXPECT_TRUE(m_->leftInSharedMemory().empty());
}

// Both gloves make the same postures and both balls press the same buttons.
TEST_F(ManyDevices, AnInputIsThatOfItsDeviceOrOfAny) {
  start("panel", "panel");
  EXPECT_TRUE(eventually([&] { return begun("left", kNextMode) >= 2; }));
  EXPECT_TRUE(eventually([&] { return begun("right", kResetView) >= 2; }));
  EXPECT_EQ(begun("left", kResetView), 0u);
  EXPECT_EQ(begun("right", kNextMode), 0u);
  EXPECT_TRUE(eventually([&] { return begun("far", kFreeze) >= 1; }));
  EXPECT_TRUE(eventually([&] { return begun("near", kBlank) >= 1 && begun("far", kBlank) >= 1; }));
  EXPECT_EQ(begun("near", kFreeze), 0u);
}

TEST_F(ManyDevices, EachMayDieAndComeBackWithoutTheOthersNoticing) {
  std::optional<Gamepad> pad(std::in_place, dir_ / "pad");
  VrpnServer server(dir_);
  start("turning", "turning",
        json::array({deviceEntry("pad", "evdev", "pty:" + dir_ / "pad"), server.entry()}));
  std::vector<Removable> all = {{"pad", [&] { pad.reset(); }, [&] { pad.emplace(dir_ / "pad"); }},
                                {"eyes", [&] { server.kill(); }, [&] { server.start(); }}};
  for (const Emulated& device : emulators_->all())
    all.push_back({device.name, [this, &device] { emulators_->kill(device.name); },
                   [this, &device] { emulators_->start(device.name); }});
  for (const Removable& device : all)
    ASSERT_TRUE(eventually([&] { return count(device.name) > 0; })) << device.name;
  const auto wand = m_->devices()->hand("wand")->samples->newest();
  ASSERT_TRUE(wand);
  EXPECT_EQ(wand->flags & HandSample::kJoints, 0u) << "it wears no glove, though there are two";
  for (const Removable& victim : all) {
    std::map<std::string, std::uint64_t> from;
    victim.remove();
    EXPECT_TRUE(m_->healthIs(victim.name, HealthState::kAbsent)) << victim.name;
    for (const Removable& device : all) from[device.name] = count(device.name);
    for (const Removable& other : all) {
      if (other.name == victim.name) continue;
      EXPECT_TRUE(eventually([&] { return count(other.name) > from[other.name] + 5; }))
          << other.name << " while " << victim.name << " is away";
    }
    victim.bring_back();
    EXPECT_TRUE(m_->healthIs(victim.name, HealthState::kOk)) << victim.name;
    EXPECT_TRUE(eventually([&] { return count(victim.name) > from[victim.name]; })) << victim.name;
    EXPECT_GE(m_->health(victim.name)->reconnects, 1u) << victim.name;
    for (const Removable& other : all) {
      if (other.name != victim.name) expectContiguous(*m_->devices(), other.name, from[other.name]);
    }
  }
  EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
}

TEST_F(ManyDevices, TheCommandsCalibrateAndRecordTheOneThatIsNamed) {
  start("turning", "turning");
  const std::string file = m_->config();
  const Outcome first = run({kMerlin, "calibrate", "ball", "--dead-zone", "7", "-o", file});
  const Outcome named =
      run({kMerlin, "calibrate", "ball", "--device", "far", "--dead-zone", "9", "-o", file});
  EXPECT_EQ(first.status + named.status, 0) << first.output << named.output;
  const json devices = json::parse(readText(file))["devices"];
  EXPECT_EQ(devices[3]["spaceball"], json({{"dead_zone", 7}}));
  EXPECT_EQ(devices[4]["spaceball"], json({{"dead_zone", 9}}));
  const auto refused = [&](std::vector<std::string> words, const std::string& said) {
    words.insert(words.begin(), {kMerlin, "calibrate"});
    words.insert(words.end(), {"-o", file});
    const std::string before = readText(file);
    const Outcome done = run(words);
    EXPECT_EQ(done.status, 2) << done.output;
    EXPECT_NE(done.output.find(said), std::string::npos) << done.output;
    EXPECT_EQ(readText(file), before);
  };
  refused({"ball", "--device", "third", "--dead-zone", "1"},
          "/devices has no device named \"third\"; its balls: near, far, pad");
  refused({"ball", "--device", "left", "--dead-zone", "1"},
          "/devices/0 (\"left\") has the driver \"cyberglove\", which is not that of a ball");
  refused({"ball", "--device", "pad", "--dead-zone", "1"},
          "run `merlin calibrate pad --device pad -o");
  refused({"ball", "--device", "far", "--full-scale", "300"},
          "\"far\" has the driver spaceball, whose options for its scale are "
          "--full-scale-translation");

  const Outcome hands =
      run({kMerlin, "posture", "collect", "fist", "--device", "right", "--seconds", "0.3", "-o",
           dir_ / "hands.csv", "--instance", m_->instance()});
  EXPECT_EQ(hands.status, 0) << hands.output;
  const Outcome none = run({kMerlin, "posture", "collect", "fist", "--device", "near", "-o",
                            dir_ / "hands.csv", "--instance", m_->instance()});
  EXPECT_EQ(none.status, 2) << none.output;
  EXPECT_NE(none.output.find("has no glove named near; its gloves: left, right"), std::string::npos)
      << none.output;
}

// A file in the old form is refused as a whole, and the message says how to convert it.
TEST(ManyDevicesCommands, CalibratingAFileOfTheEarlierFormIsRefused) {
  const TempDir dir;
  const std::string old = "{\"devices\": {\"ball\": {\"dead_zone\": 4}}}";
  writeText(dir / "old.json", old);
  const Outcome done =
      run({kMerlin, "calibrate", "ball", "--dead-zone", "1", "-o", dir / "old.json"});
  EXPECT_EQ(done.status, 2) << done.output;
  EXPECT_NE(done.output.find("run `merlin config migrate " + dir / "old.json` first"),
            std::string::npos)
      << done.output;
  EXPECT_EQ(readText(dir / "old.json"), old);
}

// Two people with a ball each. The phases of the script "panel": 0 button 3, 1 rest, 2 a push down,
// 3 rest, 4 button 1, 5 rest.
class TwoPeople : public testing::Test {
 protected:
  void SetUp() override {
    emulators_.emplace(std::vector<Emulated>{{"one", "spaceball", "panel", {"--step"}},
                                             {"two", "spaceball", "panel", {"--step"}}});
    const json bindings = {{{"input", "button.1"}, {"action", "next_mode"}}};
    m_.emplace(dir_, makeModel(dir_, 2), "people",
               MerlindOptions{.emulate = false,
                              .also = {{"devices", emulators_->list({{"one", "a"}, {"two", "b"}})},
                                       {"hands", json::array()},
                                       {"people", {{"turn_s", 60}}},
                                       {"bindings", bindings}}});
    ASSERT_TRUE(m_->ready()) << m_->process().output();
    for (const char* ball : {"one", "two"})
      ASSERT_TRUE(m_->healthIs(ball, HealthState::kOk)) << m_->process().output();
    for (const char* ball : {"one", "two"}) emulators_->step(ball, 1);
    ASSERT_TRUE(eventually([&] { return m_->wall().moving == 0; }));
  }
  bool moves(bool moving) {
    return eventually([&] { return (m_->wall().moving != 0) == moving; });
  }
  bool modeIs(const std::string& mode) {
    return eventually([&] { return m_->wall().mode == mode; });
  }
  bool isPushed(const std::string& ball) {
    return eventually([&] {
      const auto sample = m_->devices()->ball(ball)->samples->newest();
      return sample && std::abs(sample->translation[1]) > 0.3F;
    });
  }
  // Waits until the wall has read its input and published the effect at least once.
  void aFewPeriodsPass() {
    for (int i = 0; i < 4; ++i) {
      const std::int64_t updated = m_->wall().updated_ns;
      ASSERT_TRUE(eventually([&] { return m_->wall().updated_ns > updated; }));
    }
  }

  TempDir dir_;
  std::optional<Emulators> emulators_;
  std::optional<Merlind> m_;
};

TEST_F(TwoPeople, TakeTurnsAtTheWall) {
  emulators_->step("one", 1);
  EXPECT_TRUE(moves(true)) << "nobody else has it";
  const std::string mode = m_->wall().mode;
  emulators_->step("one", 1);
  ASSERT_TRUE(moves(false));

  // For the next minute, it is still the turn of person a.
  emulators_->step("two", 1);
  ASSERT_TRUE(isPushed("two"));
  aFewPeriodsPass();
  EXPECT_EQ(m_->wall().moving, 0u) << "b's push does not count";
  emulators_->step("two", 2);
  ASSERT_TRUE(eventually([&] {
    const auto actions = m_->actions("two");
    return actions && actions->begun[kNextMode] == 1;
  }));
  aFewPeriodsPass();
  EXPECT_EQ(m_->wall().mode, mode) << "b's button does not count";
  emulators_->step("one", 1);
  EXPECT_TRUE(eventually([&] { return m_->wall().mode != mode; })) << "a's button counts";

  json config = json::parse(readText(m_->config()));
  config["people"]["turn_s"] = 0;
  writeText(m_->config(), config.dump(2));
  const Outcome reloaded = run({kMerlin, "reload", "--instance", m_->instance()});
  EXPECT_EQ(reloaded.output, "/people/turn_s: 60 -> 0\n");
  emulators_->step("two", 4);
  EXPECT_TRUE(moves(true)) << "a does nothing any more";
  emulators_->step("two", 2);
  EXPECT_TRUE(modeIs(mode));
}

}  // namespace
}  // namespace merlin::test
