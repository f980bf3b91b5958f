// The unit file, as systemd itself judges it.
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

const std::string kUnit = MERLIN_SOURCE_DIR "/systemd/merlind.service";

bool installed(const char* program) { return run({"which", program}).status == 0; }

// Paths of a machine where MERLIN is installed, put where this build is.
std::string localCopy(const TempDir& dir) {
  std::string unit = readText(kUnit);
  const std::string from = "/usr/bin/merlind", to = MERLIN_BIN_DIR "/merlind";
  for (std::size_t at = 0; (at = unit.find(from, at)) != std::string::npos; at += to.size())
    unit.replace(at, from.size(), to);
  writeText(dir / "merlind.service", unit);
  return dir / "merlind.service";
}

TEST(Unit, SystemdFindsNoFault) {
  if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  const TempDir dir;
  const Outcome verified = run({"systemd-analyze", "verify", "--man=no", localCopy(dir)});
  EXPECT_EQ(verified.status, 0) << verified.output;
  EXPECT_EQ(verified.output.find("merlind.service:"), std::string::npos) << verified.output;
}

TEST(Unit, IsExposedLittle) {
  if (!installed("systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  const TempDir dir;
  const Outcome judged =
      run({"systemd-analyze", "security", "--offline=true", "--threshold=20", localCopy(dir)});
  EXPECT_EQ(judged.status, 0) << judged.output.substr(
      judged.output.size() > 300 ? judged.output.size() - 300 : 0);
}

TEST(Unit, SaysWhatTheDaemonReliesOn) {
  const std::string unit = readText(kUnit);
  for (const char* line :
       {"Type=notify", "WatchdogSec=", "RuntimeDirectory=merlin", "Restart=always"}) {
    EXPECT_NE(unit.find(line), std::string::npos) << line;
  }
  EXPECT_EQ(unit.find("\nMemoryDenyWriteExecute=yes"), std::string::npos)
      << "llvmpipe dies with it";
}

}  // namespace
}  // namespace merlin::test
