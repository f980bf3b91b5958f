// An input device of the kernel that is unplugged after `merlin devices` has listed it, at each
// step of its opening: the message, and that no other device is affected. What the kernel itself
// does with an existing device is tested in the virtual machine (tests/vm).
#include "drivers/io/evdev_stream.h"

#include <cerrno>
#include <filesystem>
#include <set>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <libevdev/libevdev.h>
#include <linux/input-event-codes.h>

#include "drivers/evdev/device.h"
#include "drivers/loop/device_loop.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_stream.h"
#include "tests/support/recording_sink.h"
#include "tests/support/temp_dir.h"

namespace merlin::io {
namespace {

int describes(int, libevdev** device) {
  *device = libevdev_new();
  return 0;
}
int grabs(libevdev*) { return 0; }

// Returns requests in which the description gets this answer of the kernel.
EvdevRequests descriptionIs(int answer) {
  return {[answer](int, libevdev**) { return answer; }, grabs};
}
EvdevRequests grabIs(int answer) {
  return {describes, [answer](libevdev*) { return answer; }};
}

std::set<std::string> openFiles() {
  std::set<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
    files.insert(file.path().filename());
  return files;
}

class EvdevStreamTest : public testing::Test {
 protected:
  EvdevStreamTest() { test::writeText(path_, ""); }
  Error errorOf(const EvdevRequests& requests) const {
    const auto opened = openEvdev(path_, requests);
    return opened ? Error{Errc::kIo, "it was opened"} : opened.error();
  }

  test::TempDir dir_;
  const std::string path_ = dir_ / "event3";
};

TEST_F(EvdevStreamTest, ADeviceThatGoesWhileItIsOpenedIsOneMessageThatSaysSo) {
  const std::set<std::string> before = openFiles();
  for (const EvdevRequests& requests :
       {descriptionIs(-ENODEV), descriptionIs(-ENXIO), grabIs(-ENODEV)}) {
    const Error error = errorOf(requests);
    EXPECT_EQ(error.code, Errc::kNotFound);
    EXPECT_EQ(error.what, path_ + ": the input device was unplugged while it was being opened");
  }
  EXPECT_EQ(openFiles(), before);
}

TEST_F(EvdevStreamTest, OtherRefusalsKeepTheirReasons) {
  EXPECT_EQ(errorOf(descriptionIs(-ENOTTY)).what, path_ + ": is not an input device of the kernel");
  const Error busy = errorOf(grabIs(-EBUSY));
  EXPECT_EQ(busy.code, Errc::kBusy);
  EXPECT_NE(busy.what.find("has grabbed this input device"), std::string::npos) << busy.what;
  const auto missing = openEvdev(dir_ / "none", {describes, grabs});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
  EXPECT_EQ(missing.error().what, dir_ / "none" + ": No such file or directory");
  EXPECT_TRUE(openEvdev(path_, {describes, grabs}));
}

struct Reports final : HealthSink {
  void publish(const DeviceHealth& h) noexcept override {
    all.push_back(h);
    then(h);
  }
  std::vector<DeviceHealth> all;
  std::function<void(const DeviceHealth&)> then;
};

// The device disappears at its description, then at its grab; then its file does not exist; then
// the device is back.
TEST_F(EvdevStreamTest, ItIsAbsentUntilItIsBack) {
  const std::string description = test::evdevRecord(EvdevRecord::kAxis, ABS_X, 0, -100, 100) +
                                  test::evdevRecord(EvdevRecord::kReady);
  test::FakeClock clock;
  test::RecordingSink sink;
  std::stop_source stop;
  int attempt = 0;
  const auto open = [&]() -> Result<std::unique_ptr<ByteStream>> {
    ++attempt;
    if (attempt == 1) return openEvdev(path_, descriptionIs(-ENODEV));
    if (attempt == 2) return openEvdev(path_, grabIs(-ENODEV));
    if (attempt == 3) return openEvdev(dir_ / "none", {describes, grabs});
    auto line = std::make_unique<test::FakeStream>(clock, nullptr);
    line->feed(description);
    return std::unique_ptr<ByteStream>(std::move(line));
  };
  Reports reports;
  reports.then = [&](const DeviceHealth& h) {
    if (h.state == HealthState::kOk) stop.request_stop();
  };
  DeviceLoop loop({.port = "evdev:" + path_}, open, evdev::makeDevice(EvdevSettings{}, clock, sink),
                  reports, clock);
  loop.run(stop.get_token());

  std::vector<std::string> reasons;
  for (const DeviceHealth& h : reports.all) {
    EXPECT_NE(h.state, HealthState::kFailed) << h.reason;
    if (h.state == HealthState::kAbsent && (reasons.empty() || reasons.back() != h.reason))
      reasons.emplace_back(h.reason);
  }
  ASSERT_EQ(reasons.size(), 4u);  // the first: not opened yet; after the last: stopped
  EXPECT_EQ(reasons[1], path_ + ": the input device was unplugged while it was being opened");
  EXPECT_EQ(reasons[2], dir_ / "none" + ": No such file or directory");
  EXPECT_EQ(reports.all.back().reconnects, 0u) << "it never worked before";
}

}  // namespace
}  // namespace merlin::io
