// The unit files, checked by systemd's own tools.
#include <algorithm>
#include <filesystem>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

const std::string kUnits = MERLIN_SOURCE_DIR "/systemd/";

bool installed(const char* program) { return run({"which", program}).status == 0; }

// Copies the unit and the given drop-ins into `dir`. In the unit, the paths of installed programs
// are replaced by those of this build, which always exist. Returns the unit's path.
std::string localCopy(const TempDir& dir, const std::string& name,
                      const std::vector<std::string>& drop_ins = {}) {
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
  writeText(dir / name, unit);
  for (const std::string& drop_in : drop_ins) {
    const std::string folder = name + ".d/";
    fs::create_directories(dir / folder);
    writeText(dir / (folder + drop_in), readText(kUnits + folder + drop_in));
  }
  return dir / name;
}

// Expects that systemd finds no fault in the unit, and reports nothing about these files.
void expectNoFault(const std::string& unit, const std::vector<std::string>& files) {
  const Outcome verified = run({"systemd-analyze", "verify", "--man=no", unit});
  EXPECT_EQ(verified.status, 0) << verified.output;
  for (const std::string& file : files)
    EXPECT_EQ(verified.output.find(file + ":"), std::string::npos) << verified.output;
}

// Expects that systemd's exposure score of the unit is at most `most` tenths.
void expectExposure(const std::string& unit, int most) {
  const Outcome judged = run({"systemd-analyze", "security", "--offline=true",
                              "--threshold=" + std::to_string(most), unit});
  EXPECT_EQ(judged.status, 0) << judged.output.substr(
      judged.output.size() > 300 ? judged.output.size() - 300 : 0);
}

class Unit : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  }

  TempDir dir_;
};

TEST_P(Unit, SystemdFindsNoFault) { expectNoFault(localCopy(dir_, GetParam()), {GetParam()}); }

TEST_P(Unit, IsExposedLittle) {
  // merlin-rfb listens on the network, which raises its score.
  const bool listens = std::string(GetParam()) == "merlin-rfb.service";
  expectExposure(localCopy(dir_, GetParam()), listens ? 16 : 15);
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
  EXPECT_NE(wall.find("\nNice=-10\nSlice=merlin.slice\n"), std::string::npos)
      << "any program that starts would delay frames";
  EXPECT_NE(wall.find("\nMemoryMax=80%\nOOMScoreAdjust=300\n"), std::string::npos);
  EXPECT_NE(devices.find("\nOOMScoreAdjust=-300\n"), std::string::npos)
      << "the wall's process is to end first";
}

// Other people's programs run under this unit, and the unit has to report faults that happen at the
// start.
TEST(AlarmsUnit, GivesItsProgramsAnErrorAndWaitsForTheNetworkAlone) {
  const std::string unit = readText(kUnits + "merlin-alarms.service");
  EXPECT_NE(unit.find("\nSystemCallErrorNumber=EPERM\n"), std::string::npos)
      << "a program that calls chown would be killed";
  EXPECT_NE(unit.find("\nAfter=network-online.target\n"), std::string::npos);
  EXPECT_EQ(unit.find("After=merlin"), std::string::npos)
      << "a wall that is never ready would keep the alarms from starting";
}

struct DropIn {
  std::string unit, name;
};
void PrintTo(const DropIn& drop_in, std::ostream* out) {
  *out << drop_in.unit << ".d/" << drop_in.name;
}

// Returns all drop-ins in the repository.
std::vector<DropIn> dropIns() {
  std::vector<DropIn> all;
  for (const auto& folder : fs::directory_iterator(kUnits)) {
    const std::string name = folder.path().filename();
    if (!name.ends_with(".service.d")) continue;
    for (const auto& file : fs::directory_iterator(folder))
      all.push_back({name.substr(0, name.size() - 2), file.path().filename()});
  }
  std::ranges::sort(all, {}, [](const DropIn& d) { return d.unit + d.name; });
  return all;
}

class ShippedDropIn : public testing::TestWithParam<DropIn> {};

TEST_P(ShippedDropIn, HasNoFaultAndExposesItsUnitNoMoreThanWasMeant) {
  if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  const auto& [unit, name] = GetParam();
  const TempDir dir;
  const std::string copy = localCopy(dir, unit, {name});
  expectNoFault(copy, {unit, name});
  // Network sockets add 0.9 to the score, and mail.conf removes every filter, as it says itself.
  expectExposure(copy, name == "mail.conf" ? 82 : name == "network.conf" ? 20 : 15);
}

// For each drop-in, administrators must find a description, and a probe in the virtual machine must
// show that what the drop-in allows is allowed with it and forbidden without it.
TEST_P(ShippedDropIn, IsDescribedAndTried) {
  const auto& [unit, name] = GetParam();
  const std::string service = unit.substr(0, unit.find('.'));
  EXPECT_NE(readText(kUnits + "README.md").find('`' + name + '`'), std::string::npos);
  EXPECT_NE(readText(MERLIN_SOURCE_DIR "/tests/vm/package_test.py")
                .find("(\"" + service + "\", \"" + name + "\", "),
            std::string::npos)
      << "DROP_INS in tests/vm/package_test.py has no probe of it";
}

INSTANTIATE_TEST_SUITE_P(DropIns, ShippedDropIn, testing::ValuesIn(dropIns()), [](const auto& of) {
  std::string name = of.param.unit + "_" + of.param.name;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '.'; }, '_');
  return name;
});

// An administrator may need all drop-ins of a unit at once.
TEST(AllDropInsOfAUnit, HaveNoFaultTogether) {
  if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  std::map<std::string, std::vector<std::string>> names;
  for (const DropIn& drop_in : dropIns()) names[drop_in.unit].push_back(drop_in.name);
  ASSERT_EQ(names.size(), 3u);
  for (const auto& [unit, all] : names) {
    const TempDir dir;
    const std::string copy = localCopy(dir, unit, all);
    std::vector<std::string> files = all;
    files.push_back(unit);
    expectNoFault(copy, files);
    if (unit != "merlin-alarms.service") expectExposure(copy, 20);
  }
}

}  // namespace
}  // namespace merlin::test
