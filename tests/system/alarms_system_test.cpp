// merlind --role alarms beside a real merlind: the configured program starts when a device is lost
// and when a merlind ends.
#include <gtest/gtest.h>

#include "tests/system/merlind.h"
#include "tests/system/told.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;

// Returns how often the alarm's program has received an event of this role whose sentence contains
// `part`.
int timesTold(const std::string& file, const std::string& role, const std::string& part) {
  int times = 0;
  for (const Json& event : told(file)) {
    if (event.is_object() && event["role"] == role &&
        event["what"].get<std::string>().find(part) != std::string::npos)
      ++times;
  }
  return times;
}
bool isToldNow(const std::string& file, const std::string& role, const std::string& part) {
  return timesTold(file, role, part) > 0;
}
bool isTold(const std::string& file, const std::string& role, const std::string& part) {
  return eventually([&] { return isToldNow(file, role, part); }, std::chrono::seconds(60));
}

Json alarmsInto(const std::string& file) {
  return {{{"run", {"/bin/sh", "-c", "cat >> \"$0\"", file}}, {"most_per_hour", 3600}}};
}

Process alarmsOf(const Merlind& merlind) {
  return Process({kMerlind, "--config", merlind.config(), "--role", "alarms"});
}

// Waits until the role has published the events of its start, which takes the role 3 s.
bool hasPublishedItsStart(Merlind& merlind) {
  return eventually([&] {
    const auto* const devices = merlind.devices();
    const Timestamp now = SystemClock().now();
    return devices && now - fromNanoseconds(devices->header->started_ns) > std::chrono::seconds(4);
  });
}

TEST(Alarms, ALostDeviceAndAMerlindThatEndsStartTheProgram) {
  const TempDir dir;
  const std::string file = dir / "told", broken = dir / "broken";
  MerlindOptions options;
  options.role = "devices";
  options.also = {
      {"alarms",
       {{{"run", {"/bin/sh", "-c", "cat >> \"$0\"", file}}, {"most_per_hour", 3600}},
        {{"run", {"/no/such/program"}}},
        {{"run", {"/bin/sh", "-c", "cat >> \"$0\"", broken}}, {"kinds", {"projector"}}}}}};
  Merlind merlind(dir, "", "alarmed", options);
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk));
  Process alarms({kMerlind, "--config", merlind.config(), "--role", "alarms"});
  ASSERT_TRUE(alarms.saysEventually("ready")) << alarms.output();
  // A working device raises no alarm, so the emulated ball is killed repeatedly until an alarm
  // shows that its loss was noticed.
  EXPECT_TRUE(eventually([&] {
    for (const pid_t pid : merlind.children("spaceball")) ::kill(pid, SIGKILL);
    return !told(file).empty();
  })) << alarms.output();
  EXPECT_TRUE(isTold(file, "devices", "ball")) << readText(file);
  const std::string line = dir / (merlind.instance() + "-ball.pty");
  const Process plugged_in({kMerlin, "emulate", "spaceball", "--link", line, "--script", "still"});
  EXPECT_TRUE(isTold(file, "devices", "ball: ok (")) << "and that it is back: " << readText(file);
  for (const Json& event : told(file)) {
    EXPECT_EQ(event["instance"], merlind.instance());
    EXPECT_FALSE(event["kind"].get<std::string>().empty());
  }
  EXPECT_TRUE(alarms.saysEventually("/no/such/program: cannot be executed"));
  EXPECT_TRUE(told(broken).empty()) << "no event was of its kind";
  ::kill(alarms.pid(), SIGUSR1);
  EXPECT_TRUE(isTold(broken, "alarms", "this is a test"));
  EXPECT_TRUE(isTold(file, "alarms", "this is a test"));
  merlind.process().kill(SIGKILL);
  EXPECT_TRUE(isTold(file, "alarms", "the role devices has not run for 15 s")) << readText(file);
  EXPECT_EQ(timesTold(broken, "alarms", ""), 1) << "no other event was for it";
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

// After a boot the alarms' process starts last: it has to report the devices' earlier faults, each
// only once.
TEST(Alarms, FaultsOfTheStartAreToldThoughTheAlarmsStartLater) {
  const TempDir dir;
  const std::string file = dir / "told";
  MerlindOptions options;
  options.role = "devices";
  options.emulate = false;
  options.also = onlyDevice(deviceEntry("ball", "spaceball", "serial:/dev/serial/by-id/none"));
  options.also["alarms"] = alarmsInto(file);
  Merlind merlind(dir, "", "booted", options);
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(hasPublishedItsStart(merlind));
  Process alarms = alarmsOf(merlind);
  EXPECT_TRUE(isTold(file, "devices", "ball: absent (")) << readText(file) << alarms.output();
  EXPECT_EQ(merlind.process().kill(SIGTERM), 0);
  EXPECT_TRUE(isTold(file, "alarms", "the role devices has not run for 15 s")) << readText(file);
  EXPECT_EQ(timesTold(file, "devices", "ball: "), 1) << readText(file);
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

TEST(Alarms, AContentThatWasMissingAtTheStartIsTold) {
  const TempDir dir;
  const std::string file = dir / "told", model = makeModel(dir, 2);
  MerlindOptions options;
  options.role = "wall";
  options.emulate = false;
  options.also = {{"alarms", alarmsInto(file)},
                  {"wall",
                   {{"contents",
                     {{{"model", model}, {"name", "there"}},
                      {{"model", dir / "missing.mrm"}, {"name", "missing"}}}}}}};
  options.also["wall"]["model"] = nullptr;
  Merlind merlind(dir, "", "booted", options);
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  Process alarms = alarmsOf(merlind);
  EXPECT_TRUE(isTold(file, "wall", "missing.mrm")) << readText(file) << merlind.process().output();
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

// A supervisor may ignore SIGCHLD, and child processes inherit this; the kernel then reports to
// nobody how the alarms' programs end.
TEST(Alarms, TheEndOfAProgramIsNoticedWhoeverStartedMerlind) {
  const TempDir dir;
  writeText(dir / "c.json", Json{{"instance", privateName("alarm")},
                                 {"run_directory", dir.path()},
                                 {"alarms", alarmsInto(dir / "told")}}
                                .dump());
  // Uses bash instead of /bin/sh, since dash does not ignore this signal.
  Process alarms({"bash", "-c", "trap '' CHLD; exec \"$@\"", "sh", kMerlind, "--config",
                  dir / "c.json", "--role", "alarms"});
  ASSERT_TRUE(alarms.saysEventually("ready")) << alarms.output();
  for (const int times : {1, 2}) {
    ::kill(alarms.pid(), SIGUSR1);
    EXPECT_TRUE(eventually([&] {
      return timesTold(dir / "told", "alarms", "this is a test") == times;
    })) << alarms.output();
  }
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

// The alarms' process waits for a configuration that has alarms, and uses it after a SIGHUP.
TEST(Alarms, AConfigurationWithoutAlarmsHasNothingToStart) {
  const TempDir dir;
  writeText(dir / "c.json", "{}");
  const Outcome checked = run({kMerlind, "--check-config", dir / "c.json", "--role", "alarms"});
  EXPECT_EQ(checked.status, 1);
  EXPECT_NE(checked.output.find("/alarms is empty: the role alarms has no program to start"),
            std::string::npos)
      << checked.output;
  Process alarms({kMerlind, "--config", dir / "c.json", "--role", "alarms"});
  ASSERT_TRUE(alarms.saysEventually("ready")) << alarms.output();
  writeText(dir / "c.json", "{");
  ::kill(alarms.pid(), SIGHUP);
  EXPECT_TRUE(alarms.saysEventually("c.json is invalid; the previous settings stay in effect"));
  writeText(dir / "c.json", R"({"alarms": [{"run": ["/bin/true"]}]})");
  ::kill(alarms.pid(), SIGHUP);
  EXPECT_TRUE(alarms.saysEventually("starting again"));
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

}  // namespace
}  // namespace merlin::test
