// merlind --role alarms beside a real merlind: a device that is lost, and a merlind that ends,
// start the configured program.
#include <gtest/gtest.h>

#include "tests/system/merlind.h"
#include "tests/system/told.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;

bool isTold(const std::string& file, const std::string& role, const std::string& part) {
  return eventually(
      [&] {
        for (const Json& event : told(file)) {
          if (event.is_object() && event["role"] == role &&
              event["what"].get<std::string>().find(part) != std::string::npos)
            return true;
        }
        return false;
      },
      std::chrono::seconds(60));
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
  // What happened before the alarms' start is not told, so the ball is lost until that is seen.
  EXPECT_TRUE(eventually([&] {
    for (const pid_t pid : merlind.children("spaceball")) ::kill(pid, SIGKILL);
    return !told(file).empty();
  })) << alarms.output();
  EXPECT_TRUE(isTold(file, "devices", "ball")) << readText(file);
  for (const Json& event : told(file)) {
    EXPECT_EQ(event["instance"], merlind.instance());
    EXPECT_FALSE(event["kind"].get<std::string>().empty());
  }
  EXPECT_TRUE(alarms.saysEventually("/no/such/program: cannot be executed"));
  merlind.process().kill(SIGKILL);
  EXPECT_TRUE(isTold(file, "alarms", "the role devices has not run for 15 s")) << readText(file);
  EXPECT_TRUE(told(broken).empty()) << "no event was of its kind";
  EXPECT_EQ(alarms.kill(SIGTERM), 0) << alarms.output();
}

TEST(Alarms, AConfigurationWithoutAlarmsHasNothingToStart) {
  const TempDir dir;
  writeText(dir / "none.json", "{}");
  const Outcome refused = run({kMerlind, "--config", dir / "none.json", "--role", "alarms"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("/alarms is empty: the role alarms has no program to start"),
            std::string::npos)
      << refused.output;
}

}  // namespace
}  // namespace merlin::test
