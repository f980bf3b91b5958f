// Readers that know nothing of MERLIN but the table of fields: the C one and the Python one that
// are shipped, as programs of their own, against a live writer.
#include <thread>

#include <gtest/gtest.h>

#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::shm {
namespace {

const std::string kReaders = MERLIN_SOURCE_DIR "/daemon/shm/read_merlin";

struct Writer : testing::Test {
  Writer() : name(segmentName(test::privateName("readers"), "devices")) {
    auto made = SegmentWriter<DevicesSegment>::make(name, devicesFields(), 1, SystemClock().now(),
                                                    {"ipc://a", "ipc://b"});
    EXPECT_TRUE(made);
    segment.emplace(*std::move(made));
    GloveSample glove{};
    glove.counter = 7;
    glove.angle_rad[4] = 0.5F;
    glove.raw[22] = 201;
    (*segment)->glove.publish(glove);
    BallSample ball{};
    ball.raw[0] = -1234;
    (*segment)->ball.publish(ball);
    DeviceHealth health{};
    std::snprintf(health.reason, sizeof health.reason, "no record for 0.5 s");
    (*segment)->health[kGlove].publish(health);
  }
  std::string shmName() const { return name.substr(1); }
  std::string reader(const test::TempDir& dir) const {
    EXPECT_EQ(test::run({"cc", "-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", kReaders + ".c",
                         "-o", dir / "reader"})
                  .status,
              0);
    return dir / "reader";
  }
  std::string name;
  std::optional<SegmentWriter<DevicesSegment>> segment;
};

TEST_F(Writer, TheCReaderFindsEverythingByName) {
  const test::TempDir dir;
  const auto out = test::run({reader(dir), shmName(), "glove.counter", "glove.angle_rad",
                              "ball.raw", "glove.health.reason", "hand.delay_s", "glove.ring"});
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_NE(out.output.find("glove.counter 7 \n"), std::string::npos) << out.output;
  EXPECT_NE(out.output.find("glove.angle_rad 0 0 0 0 0.5 0"), std::string::npos);
  EXPECT_NE(out.output.find("ball.raw -1234 0 0 0 0 0 \n"), std::string::npos);
  EXPECT_NE(out.output.find("glove.health.reason no record for 0.5 s\n"), std::string::npos);
  EXPECT_NE(out.output.find("hand.delay_s -\n"), std::string::npos) << "never written";
  EXPECT_NE(out.output.find("256 x 144 B\n"), std::string::npos);
}

TEST_F(Writer, ThePythonReaderSaysTheSame) {
  const auto out = test::run({"python3", "-B", kReaders + ".py", shmName(), "glove.counter",
                              "ball.raw", "glove.health.reason", "glove.count"});
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_NE(out.output.find("glove.counter (7,)"), std::string::npos) << out.output;
  EXPECT_NE(out.output.find("ball.raw (-1234, 0, 0, 0, 0, 0)"), std::string::npos);
  EXPECT_NE(out.output.find("glove.health.reason no record for 0.5 s"), std::string::npos);
  EXPECT_NE(out.output.find("glove.count (1,)"), std::string::npos);
}

TEST_F(Writer, TheCReaderSleepsUntilTheNextSampleAndMissesNone) {
  const test::TempDir dir;
  test::Process follower({reader(dir), shmName(), "--follow", "ball", "100"});
  std::jthread writing([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      (*segment)->ball.publish(BallSample{});
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  EXPECT_EQ(follower.wait(), 0) << follower.output();
  std::istringstream lines(follower.output());
  std::uint64_t count = 0, last = 0;
  for (std::string word; lines >> word;) {
    const std::uint64_t n = (lines >> word, std::stoull(word));
    EXPECT_TRUE(count == 0 || n == last + 1) << n;
    last = n;
    ++count;
  }
  EXPECT_GE(count, 100u);
}

}  // namespace
}  // namespace merlin::shm
