// Runs read_status.py, the shipped example of a ZeroMQ client, as a process against a real daemon
// on emulated devices.
#include <sstream>

#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

const std::string kReader = MERLIN_SOURCE_DIR "/daemon/status/read_status.py";
const std::string kPython = "/usr/bin/python3";  // the Python for which Debian packages python3-zmq

TEST(StatusReader, FollowsATopicAndSendsCommands) {
  if (run({kPython, "-c", "import zmq"}).status != 0) GTEST_SKIP() << "no python3-zmq";
  const TempDir dir;
  MerlindOptions options;
  options.role = "devices";
  Merlind daemon(dir, "", "pyzmq", options);
  ASSERT_TRUE(daemon.ready()) << daemon.process().output();
  ASSERT_TRUE(daemon.healthIs("ball", HealthState::kOk));
  const std::string segment = shm::segmentName(daemon.instance(), "devices").substr(1);

  const Outcome samples = run({kPython, "-B", kReader, segment, "sample", "3"});
  ASSERT_EQ(samples.status, 0) << samples.output;
  std::istringstream lines(samples.output);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    ASSERT_EQ(line.substr(0, 7), "sample ");
    const auto document = nlohmann::json::parse(line.substr(7));
    EXPECT_TRUE(document.contains("health") && document.contains("time_utc")) << line;
  }
  EXPECT_EQ(count, 3);

  Outcome status;
  EXPECT_TRUE(eventually([&] {
    status = run({kPython, "-B", kReader, segment, "--command", "status"});
    return status.status == 0 &&
           nlohmann::json::parse(status.output)["devices"]["ball"]["health"] == "ok";
  })) << status.output;

  const Outcome wrong = run({kPython, "-B", kReader, segment, "--command", "nothing"});
  EXPECT_NE(wrong.status, 0);
  EXPECT_NE(wrong.output.find("nothing"), std::string::npos) << wrong.output;
}

}  // namespace
}  // namespace merlin::test
