// The shipped C and Python readers, which know only the table of fields, run as programs while a
// writer writes.
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/shm/fields.h"
#include "daemon/shm/segment.h"
#include "tests/support/local_devices.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::shm {
namespace {

const std::string kReaders = MERLIN_SOURCE_DIR "/daemon/shm/read_merlin";

struct Writer : testing::Test {
  Writer() : name(segmentName(test::privateName("readers"), "devices")) {
    auto made = SegmentWriter<DevicesSegment>::make(name, devicesFields(test::defaultSlotNames()),
                                                    1, SystemClock().now(), {"ipc://a", "ipc://b"});
    EXPECT_TRUE(made);
    segment.emplace(*std::move(made));
    GloveSample glove{};
    glove.counter = 7;
    glove.angle_rad[4] = 0.5F;
    glove.raw[22] = 201;
    (*segment)->glove[0].samples.publish(glove);
    BallSample ball{};
    ball.raw[0] = -1234;
    (*segment)->ball[0].publish(ball);
    DeviceHealth health{};
    std::snprintf(health.reason, sizeof health.reason, "no record for 0.5 s");
    (*segment)->health[test::kGlove].publish(health);
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
  const auto out =
      test::run({reader(dir), shmName(), "glove.counter", "glove.angle_rad", "ball.raw",
                 "glove.health.reason", "hand.delay_s", "segment.command_endpoint"});
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_NE(out.output.find("glove.counter 7 \n"), std::string::npos) << out.output;
  EXPECT_NE(out.output.find("glove.angle_rad 0 0 0 0 0.5 0"), std::string::npos);
  EXPECT_NE(out.output.find("ball.raw -1234 0 0 0 0 0 \n"), std::string::npos);
  EXPECT_NE(out.output.find("glove.health.reason no record for 0.5 s \n"), std::string::npos);
  EXPECT_NE(out.output.find("hand.delay_s -\n"), std::string::npos) << "never written";
  EXPECT_NE(out.output.find("segment.command_endpoint ipc://b \n"), std::string::npos);
}

TEST_F(Writer, ThePythonReaderSaysTheSame) {
  const auto out = test::run({"python3", "-B", kReaders + ".py", shmName(), "glove.counter",
                              "ball.raw", "glove.health.reason", "glove.count"});
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_NE(out.output.find("glove.counter [7]"), std::string::npos) << out.output;
  EXPECT_NE(out.output.find("ball.raw [-1234, 0, 0, 0, 0, 0]"), std::string::npos);
  EXPECT_NE(out.output.find("glove.health.reason ['no record for 0.5 s']"), std::string::npos);
  EXPECT_NE(out.output.find("glove.count [1]"), std::string::npos);
}

// Publishes ball samples whose rotation about x equals their counter, as long as this object lives.
struct Turning {
  explicit Turning(DevicesSegment& segment)
      : thread([&segment](const std::stop_token& stop) {
          BallSample ball{};
          ball.received_ns = toNanoseconds(SystemClock().now());
          while (!stop.stop_requested()) {
            ball.rotation[0] = static_cast<float>(segment.ball[0].count());
            segment.ball[0].publish(ball);
            std::this_thread::sleep_for(std::chrono::microseconds(300));
          }
        }) {}
  std::jthread thread;
};

TEST_F(Writer, TheCReaderSleepsUntilTheNextSampleAndMissesNone) {
  const test::TempDir dir;
  test::Process follower({reader(dir), shmName(), "--follow", "ball.rotation", "100"});
  const Turning turning(**segment);
  EXPECT_EQ(follower.wait(), 0) << follower.output();
  std::istringstream lines(follower.output());
  std::uint64_t count = 0, last = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::istringstream words(line);
    std::string field;
    std::uint64_t n = 0;
    double x = -1;
    words >> field >> n >> x;
    EXPECT_EQ(x, static_cast<double>(n)) << line << ": a value of that very sample";
    EXPECT_TRUE(count == 0 || n == last + 1) << line;
    last = n;
  }
  EXPECT_GE(count, 100u);
}

TEST_F(Writer, TheCppReaderFollowsTheBallWithTheTimeOfDay) {
  const test::TempDir dir;
  const auto built = test::run({"c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", "-I",
                                MERLIN_SOURCE_DIR, kReaders + ".cpp", "-o", dir / "reader"});
  ASSERT_EQ(built.status, 0) << built.output;
  const double before = toSeconds(std::chrono::system_clock::now().time_since_epoch());
  test::Process follower({dir / "reader", shmName(), "50"});
  const Turning turning(**segment);
  EXPECT_EQ(follower.wait(), 0) << follower.output();
  unsigned long long n = 0;
  double utc_s = 0, x = -1;
  ASSERT_EQ(std::sscanf(follower.output().c_str(), "ball %llu at %lf: %lf", &n, &utc_s, &x), 3);
  EXPECT_EQ(x, static_cast<double>(n));
  EXPECT_NEAR(utc_s, before, 60);
}

}  // namespace
}  // namespace merlin::shm
