// merlin reload and SIGHUP with the real programs: either exactly what changed is swapped, or
// everything stays as it was.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "daemon/base/commands.h"
#include "daemon/base/sanitizer.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr const char* kDevices[] = {"glove", "tracker", "ball"};

json bindings(const std::string& fist) {
  return json::array({{{"input", "posture.fist"}, {"action", fist}},
                      {{"input", "ball.button.2"}, {"action", "next_mode"}}});
}

// Returns the default devices, where the device `name` has the driver settings `own` and the
// further entry members `members`.
json devicesWith(const std::string& name, const json& own, const json& members = json::object()) {
  json list = json::array({deviceEntry("glove", "cyberglove"), deviceEntry("tracker", "fastrak"),
                           deviceEntry("ball", "spaceball")});
  for (json& entry : list) {
    if (entry["name"] != name) continue;
    if (!own.is_null()) entry[entry["driver"].get<std::string>()] = own;
    entry.update(members);
  }
  return {{"devices", list}};
}

json handWith(const json& members) { return {{"hands", json::array({members})}}; }

json both(json first, const json& second) {
  first.update(second);
  return first;
}

// Returns the number of voluntary context switches of the process, that is, how often it has
// waited.
int timesSlept(pid_t pid) {
  const std::string status = readText(fmt::format("/proc/{}/status", pid));
  const std::string name = "\nvoluntary_ctxt_switches:";
  return std::atoi(status.substr(status.find(name) + name.size()).c_str());
}

class Reload : public testing::Test {
 protected:
  // Starts the devices' process. Its emulated person makes a fist and opens it repeatedly.
  void start(const json& also = {{"bindings", bindings("grab")}}) {
    merlind_.emplace(dir_, "", "reload",
                     MerlindOptions{.script = "grabbing", .role = "devices", .also = also});
    ASSERT_TRUE(merlind_->ready()) << merlind_->process().output();
    for (const char* device : kDevices)
      ASSERT_TRUE(merlind_->healthIs(device, HealthState::kOk)) << device;
    written_ = json::parse(readText(merlind_->config()));
  }
  void write(const json& patch) {
    written_.merge_patch(patch);
    writeText(merlind_->config(), written_.dump(2));
  }
  Outcome reload(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {kMerlin, "reload", "--instance", merlind_->instance()});
    return run(more);
  }
  DeviceHealth health(const std::string& device) {
    return merlind_->health(device).value_or(DeviceHealth{});
  }
  std::map<std::string, DeviceHealth> healths() {
    std::map<std::string, DeviceHealth> all;
    for (const char* device : kDevices) all[device] = health(device);
    return all;
  }
  // Returns whether a reload of other bindings left every line open. On a busy machine an emulator
  // may be silent for so long that its line is reopened meanwhile, so the test calls this more than
  // once.
  bool reloadLeavesLines(const std::string& fist) {
    auto before = healths();
    write({{"bindings", bindings(fist)}});
    EXPECT_EQ(reload().status, 0);
    return std::ranges::all_of(kDevices, [&](const char* device) {
      return health(device).since_ns == before[device].since_ns &&
             health(device).reconnects == before[device].reconnects;
    });
  }
  shm::ActionState actions() { return merlind_->actions("glove").value_or(shm::ActionState{}); }
  std::uint32_t begun(std::string_view action) {
    for (std::size_t i = 0; i < kActions.size(); ++i) {
      if (action == kActions[i]) return actions().begun[i];
    }
    return 0;
  }
  std::string serviceHealth() {
    return merlind_->status()["services"]["configuration"].value("health", "");
  }
  std::size_t entriesOf(const char* folder) const {
    const std::filesystem::directory_iterator all(
        fmt::format("/proc/{}/{}", merlind_->process().pid(), folder));
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  TempDir dir_;
  mutable std::optional<Merlind> merlind_;
  json written_;
};

// A line was not closed if its health is unchanged since before the reload.
TEST_F(Reload, AChangedBindingActsAndNoLineIsClosed) {
  start();
  ASSERT_TRUE(eventually([&] { return begun("grab") > 0; }));
  auto before = healths();
  write({{"bindings", bindings("reset_view")}});
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output, "/bindings/0/action: \"grab\" -> \"reset_view\"\n");
  EXPECT_TRUE(eventually([&] { return begun("reset_view") > 0; }));
  const std::uint32_t grabs = begun("grab");
  EXPECT_EQ(actions().held[actionIndex("grab")], 0);
  const std::uint32_t resets = begun("reset_view");
  EXPECT_TRUE(eventually([&] { return begun("reset_view") > resets; }));
  EXPECT_EQ(begun("grab"), grabs);
  EXPECT_GT(health("glove").samples, before["glove"].samples);
  EXPECT_EQ(reload().output, "nothing changed\n");
  write({{"bindings", bindings("grab")}});
  ASSERT_EQ(::kill(merlind_->process().pid(), SIGHUP), 0);
  EXPECT_TRUE(merlind_->process().saysEventually(
      "reload: /bindings/0/action was \"reset_view\" and is \"grab\""))
      << merlind_->process().output();
  EXPECT_TRUE(eventually([&] { return begun("grab") > grabs; }));
  EXPECT_TRUE(eventually([&] { return reloadLeavesLines("fly") || reloadLeavesLines("grab"); }));
  EXPECT_EQ(merlind_->process().kill(SIGTERM), 0);
}

TEST_F(Reload, ADeviceIsMadeAnewAloneAndItsCountersGoOn) {
  start();
  auto before = healths();
  write(devicesWith("glove", {{"light", "on"}}));
  const std::string pid = std::to_string(merlind_->process().pid());
  const Outcome done = run({kMerlin, "reload", "--pid", pid});
  EXPECT_EQ(done.output, "/devices/0/cyberglove/light: \"switch\" -> \"on\"\n");
  EXPECT_TRUE(eventually([&] {
    const DeviceHealth glove = health("glove");
    return glove.state == HealthState::kOk && glove.since_ns > before["glove"].since_ns &&
           glove.samples > before["glove"].samples + 10;
  })) << merlind_->process().output();
  EXPECT_EQ(health("glove").reconnects, before["glove"].reconnects + 1);
  for (const char* device : {"tracker", "ball"})
    EXPECT_EQ(health(device).since_ns, before[device].since_ns) << device;
  EXPECT_EQ(merlind_->process().output().find("the last bytes of"), std::string::npos)
      << "a device that was stopped on purpose has not failed";
}

// A refusal has the words of --check-config, and is an event that ends with the next good reload.
TEST_F(Reload, ABadFileIsSaidAndChangesNothing) {
  start();
  const std::string good = written_.dump(2);
  write({{"bindings", bindings("fly")}});
  const std::string wanted = written_.dump(2);
  const auto broken = [&](const json& patch) {
    json copy = written_;
    copy.merge_patch(patch);
    return copy.dump(2);
  };
  for (const std::string& text :
       {wanted.substr(0, wanted.size() / 2), broken(devicesWith("ball", nullptr, {{"bau", 9600}})),
        broken(devicesWith("ball", nullptr, {{"baud", 12345}})),
        broken({{"postures", {{"file", "none.json"}}}}),
        // at a start, merlind would adjust this value instead of refusing it
        broken({{"postures", {{"hold_s", 99}}}}),
        broken(both(devicesWith("glove", nullptr, {{"port", "serial"}}),
                    {{"wall", {{"outputs", 3}}}}))}) {
    writeText(merlind_->config(), text);
    const Outcome checked =
        run({kMerlind, "--check-config", merlind_->config(), "--role", "devices", "--emulate"});
    const Outcome refused = reload();
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_NE(refused.output.find("nothing was changed"), std::string::npos) << refused.output;
    std::istringstream lines(checked.output);
    int findings = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.find(": invalid, ") != std::string::npos ||
          line.find(": valid after 1 adj") != std::string::npos)
        continue;
      ++findings;
      EXPECT_NE(refused.output.find(line + "\n"), std::string::npos) << line << "\nis not in\n"
                                                                     << refused.output;
    }
    EXPECT_GT(findings, 0) << checked.output;
  }
  EXPECT_EQ(serviceHealth(), "failed");
  EXPECT_TRUE(merlind_->process().saysEventually("configuration: failed ("));
  EXPECT_TRUE(merlind_->process().saysEventually("the previous settings stay in effect"));
  writeText(merlind_->config(), good);
  EXPECT_EQ(reload().output, "nothing changed\n") << "none of the bad files was taken";
  EXPECT_EQ(serviceHealth(), "ok");
  EXPECT_TRUE(merlind_->process().saysEventually("configuration: works again"));
  EXPECT_FALSE(merlind_->process().ended());
}

// For settings that take effect only at a start, merlind starts again in the same process, and
// answers the command once it is ready.
TEST_F(Reload, ForWhatOnlyAStartTakesItStartsAgainWithAllTheRest) {
  start();
  write({{"state_file", dir_ / "a.json"}, {"bindings", bindings("fly")}});
  const Outcome would = reload({"--check"});
  EXPECT_EQ(would.output,
            "/bindings/0/action: \"grab\" -> \"fly\"\n"
            "merlind would start again, because these settings take effect only at a start:\n  "
            "/state_file\n");
  ASSERT_TRUE(eventually([&] { return begun("grab") > 0; })) << "nothing was changed";
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output,
            "/bindings/0/action: \"grab\" -> \"fly\"\n"
            "merlind started again, because these settings take effect only at a start:\n  "
            "/state_file\n");
  EXPECT_TRUE(merlind_->process().saysEventually("/state_file changed in " + merlind_->config()));
  merlind_->openAgain();
  for (const char* device : kDevices)
    EXPECT_TRUE(merlind_->healthIs(device, HealthState::kOk)) << device;
  EXPECT_TRUE(eventually([&] { return begun("fly") > 0; }));
  EXPECT_EQ(reload().output, "nothing changed\n");
  write({{"state_file", dir_ / "b.json"}});
  ASSERT_EQ(::kill(merlind_->process().pid(), SIGHUP), 0);
  EXPECT_TRUE(merlind_->process().saysEventually("starting again"));
  EXPECT_TRUE(eventually([&] { return reload().output == "nothing changed\n"; }));
  const std::string pid = std::to_string(merlind_->process().pid());
  EXPECT_EQ(readText("/proc/" + pid + "/comm"), "merlind\n");
  for (const std::string device : kDevices)
    EXPECT_EQ(merlind_->process().output().find(device + ": absent (not "), std::string::npos)
        << "it is configured, and is opened: " << merlind_->process().output();
  EXPECT_EQ(merlind_->process().kill(SIGTERM), 0) << merlind_->process().output();
}

TEST_F(Reload, AFileThatKeepsItsNameIsTakenOnceItsContentsChange) {
  const std::string postures = dir_ / "own.json";
  writeText(postures, readText(kSource + "/config/postures.json"));
  start({{"postures", {{"file", postures}}}});
  EXPECT_NE(reload().output.find("nothing changed"), std::string::npos);
  writeText(postures, readText(postures) + "\n");
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("/postures/file: "), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("with other contents"), std::string::npos) << done.output;
  EXPECT_NE(reload().output.find("nothing changed"), std::string::npos);
}

TEST_F(Reload, WhatOtherProcessesReadIsSaid) {
  start();
  write({{"page", {{"port", 7999}}}, {"bindings", bindings("fly")}});
  const Outcome would = reload({"--check", "--json"});
  EXPECT_EQ(would.status, 0) << would.output;
  const json answer = json::parse(would.output, nullptr, false)["processes"][0];
  EXPECT_EQ(answer["outcome"], "done");
  EXPECT_EQ(answer["only_checked"], true);
  EXPECT_EQ(answer["pid"], merlind_->process().pid());
  ASSERT_EQ(answer["swapped"].size(), 1u) << would.output;
  EXPECT_EQ(answer["elsewhere"], json({"/page/port"}));
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0);
  EXPECT_EQ(done.output,
            "/bindings/0/action: \"grab\" -> \"fly\"\n"
            "/page/port: is read by the page: systemctl reload merlin-page\n");
}

TEST_F(Reload, AnAlarmHasOneLineHoweverManyOfItsSettingsChanged) {
  start();
  const auto alarm = [](int most) { return json{{"run", {"/bin/true"}}, {"most_per_hour", most}}; };
  const std::string reader = ": is read by the alarms: systemctl reload merlin-alarms\n";
  write({{"alarms", {alarm(1), alarm(2)}}});
  EXPECT_EQ(reload({"--check"}).output, "/alarms" + reader) << "there were none";
  EXPECT_EQ(reload().status, 0);
  write({{"alarms", {alarm(1), alarm(5), alarm(3), alarm(4)}}});
  const std::string all = " (run, kinds, most_per_hour, time_limit_s)";
  EXPECT_EQ(reload().output, "/alarms/1/most_per_hour" + reader + "/alarms/2" + all + reader +
                                 "/alarms/3" + all + reader);
  write({{"serve", {{"vrpn_port", 3999}, {"spnav_socket", dir_ / "ball"}}}});
  const Outcome start = reload({"--check"});
  EXPECT_NE(start.output.find("take effect only at a start:\n  /serve ("), std::string::npos)
      << start.output;
}

// With a sanitizer each reload takes seconds of processor time; a dozen are enough to show a leak.
#if defined(MERLIN_ANY_SANITIZER)
constexpr int kInARow = 12;
#else
constexpr int kInARow = 50;
#endif

// Reloads good and bad configurations in a random order (with a fixed seed), while the hand moves.
TEST_F(Reload, ManyInARowLeaveNothingBehind) {
  start();
  const json good[] = {
      {{"bindings", bindings("fly")}},
      {{"bindings", bindings("grab")}, {"people", {{"stale_after_s", 0.7}}}},
      {{"postures", {{"hold_s", 0.1}, {"file", ""}}}},
      {{"postures", {{"hold_s", 0.2}, {"file", kSource + "/config/postures.json"}}}},
      devicesWith("ball", {{"dead_zone", 5}}),
      both(devicesWith("ball", {{"dead_zone", 6}}), handWith({{"cutoff_hz", 4}})),
      devicesWith("tracker", {{"alignment1_cm", {0, 0, 0, 1, 0, 0, 0, 1, 0}}}),
      handWith({{"station", 2}, {"cutoff_hz", 5}})};
  const json bad[] = {devicesWith("ball", nullptr, {{"baud", 7}}),
                      {{"hands", 1}},
                      {{"script", "still"}, {"hands", 1}},
                      {{"postures", {{"file", "none"}}}},
                      devicesWith("ball", nullptr, {{"name", "glove"}})};
  // These are counted before any client is connected, since a client's place becomes free only some
  // time after the client has gone.
  const std::size_t descriptors = entriesOf("fd"), threads = entriesOf("task");
  std::mt19937 random(5);
  std::uint64_t samples = health("glove").samples;
  for (int i = 0; i < kInARow; ++i) {
    const bool is_good = random() % 3 != 0;
    const json kept = written_;
    write(is_good ? good[random() % std::size(good)] : bad[random() % std::size(bad)]);
    const Outcome done = reload();
    EXPECT_EQ(done.status, is_good ? 0 : 2) << i << ": " << done.output;
    if (!is_good) written_ = kept;
    EXPECT_TRUE(eventually([&] { return health("glove").samples > samples; })) << i;
    samples = health("glove").samples;
  }
  for (const char* device : kDevices)
    EXPECT_TRUE(merlind_->healthIs(device, HealthState::kOk)) << device;
  // No reload has closed the glove's line, but on a busy machine its emulator may have been silent
  // for too long.
  EXPECT_LT(health("glove").reconnects, 10u);
  EXPECT_TRUE(eventually([&] { return entriesOf("fd") == descriptors; }))
      << entriesOf("fd") << " descriptors instead of " << descriptors;
  EXPECT_TRUE(eventually([&] { return entriesOf("task") == threads; }))
      << entriesOf("task") << " threads instead of " << threads;
  EXPECT_EQ(merlind_->process().kill(SIGTERM), 0);
}

// The wall runs in a process of its own.
class ReloadOfTwo : public Reload {
 protected:
  void SetUp() override {
    start({{"bindings", bindings("grab")},
           {"wall", {{"model", model_}, {"rate", {{"rate_hz", 10}}}}}});
    wall_.emplace(
        std::vector<std::string>{kMerlind, "--config", merlind_->config(), "--role", "wall"});
    ASSERT_TRUE(wall_->saysEventually("ready")) << wall_->output();
  }
  const std::string model_ = makeModel(dir_, 2);
  std::optional<Process> wall_;
};

TEST_F(ReloadOfTwo, EachTakesItsPartAndTheWallGoesOn) {
  const std::uint64_t frames = merlind_->wall().frames;
  ASSERT_EQ(merlind_->wall().rate_asked_hz, 10);
  write({{"bindings", bindings("fly")},
         {"hands", json::array({{{"station", 2}}})},
         {"wall",
          {{"rate", {{"rate_hz", 12}}},
           {"playlist", {{"dim_after_s", 100}}},
           {"scene", {{"hand_gain", 2}}}}}});
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0) << done.output;
  for (const char* line :
       {"/hands/0/station: 1 -> 2\n", "/wall/rate/rate_hz: 10 -> 12\n",
        "/wall/playlist/dim_after_s: 0 -> 100\n", "/wall/scene/hand_gain: 3 -> 2\n"})
    EXPECT_NE(done.output.find(line), std::string::npos) << line << done.output;
  EXPECT_EQ(done.output.find("is read by"), std::string::npos) << done.output;
  EXPECT_TRUE(eventually([&] { return merlind_->wall().rate_asked_hz == 12; }));
  // A still wall that shows full detail draws no frame, so the notice gives it something to draw.
  EXPECT_EQ(run({kMerlin, "notice", "x", "--instance", merlind_->instance()}).status, 0);
  EXPECT_TRUE(eventually([&] { return merlind_->wall().frames > frames; }));
  EXPECT_EQ(reload().output, "nothing changed\n");
}

TEST_F(ReloadOfTwo, TheWallAloneStartsAgainForItsContents) {
  auto before = healths();
  const auto contents = [](const std::string& file) {
    return json{{"contents", json::array({{{"model", file}, {"name", "second"}}})}};
  };
  write({{"wall", contents(dir_ / "none.mrm")}});
  const Outcome refused = reload();
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("none.mrm: No such file"), std::string::npos) << refused.output;
  write({{"wall", contents(model_)}});
  const Outcome done = reload();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("merlind started again, because these settings take effect only at a "
                             "start:\n  /wall/contents"),
            std::string::npos)
      << done.output;
  EXPECT_EQ(run({kMerlin, "show", "second", "--instance", merlind_->instance()}).status, 0);
  EXPECT_FALSE(wall_->ended());
  for (const char* device : kDevices)
    EXPECT_EQ(health(device).reconnects, before[device].reconnects) << device;
}

// Another request may have started the process again, as when systemd reloads two units one after
// the other.
TEST_F(ReloadOfTwo, OneThatStartsAgainIsWaitedFor) {
  write({{"wall", {{"snapshots", dir_ / "snapshots"}}}});
  ASSERT_EQ(::kill(wall_->pid(), SIGHUP), 0);
  ASSERT_TRUE(wall_->saysEventually("starting again"));
  ASSERT_TRUE(eventually([&] {
    return !shm::SegmentReader<shm::WallSegment>::open(
                shm::segmentName(merlind_->instance(), "wall"))
                .ok();
  }));
  ::kill(wall_->pid(), SIGSTOP);
  Process waits({kMerlin, "reload", "--pid", std::to_string(wall_->pid())});
  EXPECT_TRUE(eventually([&] { return waits.ended() || timesSlept(waits.pid()) > 50; }));
  EXPECT_FALSE(waits.ended());
  ::kill(wall_->pid(), SIGCONT);
  EXPECT_EQ(waits.wait(), 0);
  EXPECT_EQ(waits.output(), "nothing changed\n");
}

TEST_F(ReloadOfTwo, WhatOneRefusesNeitherTakes) {
  write({{"bindings", bindings("fly")}, {"wall", {{"snapshots", merlind_->config()}}}});
  const Outcome refused = reload();
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("/wall/snapshots cannot be used"), std::string::npos)
      << refused.output;
  write({{"wall", {{"snapshots", ""}}}});
  const Outcome done = reload();
  EXPECT_EQ(done.output, "/bindings/0/action: \"grab\" -> \"fly\"\n")
      << "it was not swapped before: " << done.output;
}

}  // namespace
}  // namespace merlin::test
