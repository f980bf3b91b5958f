// The unit files, checked by systemd's own tools.
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

const std::string kUnits = MERLIN_SOURCE_DIR "/systemd/";

bool installed(const char* program) { return run({"which", program}).status == 0; }

class Unit : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  }
  // A copy of the unit with the paths of this build's merlin and merlind, which exist, instead of
  // the installed programs' paths.
  std::string localCopy() const {
    const std::string name = GetParam();
    std::string unit = readText(kUnits + name);
    const std::string from =
        name == "merlin-rfb.service" ? "/usr/bin/merlin-rfb" : "/usr/bin/merlind";
    const std::string to = MERLIN_BIN_DIR "/merlind";
    EXPECT_NE(unit.find(from), std::string::npos);
    for (std::size_t at = 0; (at = unit.find(from, at)) != std::string::npos; at += to.size())
      unit.replace(at, from.size(), to);
    const std::string tool = "/usr/bin/merlin ";
    if (const std::size_t at = unit.find(tool); at != std::string::npos)
      unit.replace(at, tool.size(), MERLIN_BIN_DIR "/merlin ");
    writeText(dir_ / name, unit);
    return dir_ / name;
  }

  TempDir dir_;
};

TEST_P(Unit, SystemdFindsNoFault) {
  const Outcome verified = run({"systemd-analyze", "verify", "--man=no", localCopy()});
  EXPECT_EQ(verified.status, 0) << verified.output;
  EXPECT_EQ(verified.output.find(std::string(GetParam()) + ":"), std::string::npos)
      << verified.output;
}

TEST_P(Unit, IsExposedLittle) {
  // The limit in tenths. merlin-rfb listens on the network, so its limit is higher.
  const char* const most = std::string(GetParam()) == "merlin-rfb.service" ? "16" : "15";
  const Outcome judged = run({"systemd-analyze", "security", "--offline=true",
                              std::string("--threshold=") + most, localCopy()});
  EXPECT_EQ(judged.status, 0) << judged.output.substr(
      judged.output.size() > 300 ? judged.output.size() - 300 : 0);
}

INSTANTIATE_TEST_SUITE_P(Units, Unit,
                         testing::Values("merlin-devices.service", "merlin-wall.service",
                                         "merlin-rfb.service", "merlin-page.service",
                                         "merlin-alarms.service"),
                         [](const auto& unit) {
                           std::string name(unit.param);
                           name.resize(name.find('.'));
                           if (name.size() > 6 && name[6] == '-') name[6] = '_';
                           return name;
                         });

TEST(DaemonsUnits, SayWhatTheDaemonReliesOn) {
  const std::string devices = readText(kUnits + "merlin-devices.service");
  const std::string wall = readText(kUnits + "merlin-wall.service");
  for (const std::string& unit : {devices, wall}) {
    for (const char* line : {"\nType=notify", "\nWatchdogSec=", "\nRuntimeDirectory=merlin\n",
                             "\nRuntimeDirectoryPreserve=yes", "\nRestart=always"})
      EXPECT_NE(unit.find(line), std::string::npos) << line;
  }
  EXPECT_NE(devices.find("\nMemoryDenyWriteExecute=yes"), std::string::npos);
  EXPECT_NE(devices.find("\nLimitRTPRIO="), std::string::npos);
  EXPECT_NE(wall.find("\nFileDescriptorStoreMax="), std::string::npos)
      << "the displays are black while the wall is restarted";
  EXPECT_EQ(wall.find("\nMemoryDenyWriteExecute=yes"), std::string::npos)
      << "llvmpipe dies with it";
}

// Other people's programs run under this unit, and it has to report faults of the start.
TEST(AlarmsUnit, GivesItsProgramsAnErrorAndWaitsForTheNetworkAlone) {
  const std::string unit = readText(kUnits + "merlin-alarms.service");
  EXPECT_NE(unit.find("\nSystemCallErrorNumber=EPERM\n"), std::string::npos)
      << "a program that calls chown would be killed";
  EXPECT_NE(unit.find("\nAfter=network-online.target\n"), std::string::npos);
  EXPECT_EQ(unit.find("After=merlin"), std::string::npos)
      << "a wall that is never ready would keep the alarms from starting";
}

TEST(AlarmsUnit, SystemdFindsNoFaultInTheDropInForMail) {
  if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  const TempDir dir;
  std::string unit = readText(kUnits + "merlin-alarms.service");
  unit.replace(unit.find("/usr/bin/merlind"), 16, MERLIN_BIN_DIR "/merlind");
  writeText(dir / "merlin-alarms.service", unit);
  std::filesystem::create_directory(dir / "merlin-alarms.service.d");
  writeText(dir / "merlin-alarms.service.d/mail.conf",
            readText(kUnits + "merlin-alarms.service.d/mail.conf"));
  const Outcome verified =
      run({"systemd-analyze", "verify", "--man=no", dir / "merlin-alarms.service"});
  EXPECT_EQ(verified.status, 0) << verified.output;
  EXPECT_EQ(verified.output.find("mail.conf:"), std::string::npos) << verified.output;
}

}  // namespace
}  // namespace merlin::test
