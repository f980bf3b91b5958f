#include "drivers/loop/device_loop.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/cyberglove/device.h"
#include "tests/support/device_bench.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// A DeviceLoop for a glove whose port opens or fails to open, as the test decides.
struct Loop : test::DeviceBench {
  Loop() : DeviceBench("cyberglove", {}, "visit") {}

  // Runs the loop until one of the hooks below requests a stop.
  void run() {
    DeviceLoop loop(
        {.port = "pty:/tmp/glove"}, [this] { return open(); },
        cyberglove::makeDevice(CybergloveSettings{}, clock, sink), health, clock);
    loop.run(stop.get_token());
  }

  Result<std::unique_ptr<ByteStream>> open() {
    opened_at.push_back(clock.now());
    before_opening(opened_at.size());
    if (absent) return Error{Errc::kNotFound, "/tmp/glove: no such file"};
    auto fresh = std::make_unique<test::FakeStream>(clock, plugged ? emulator.get() : nullptr);
    line = fresh.get();
    return std::unique_ptr<ByteStream>(std::move(fresh));
  }

  // Returns the milliseconds between successive attempts to open the port.
  std::vector<long> pauses() const {
    std::vector<long> all;
    for (std::size_t i = 1; i < opened_at.size(); ++i) {
      all.push_back(
          std::chrono::duration_cast<milliseconds>(opened_at[i] - opened_at[i - 1]).count());
    }
    return all;
  }

  // Returns the sequence of health states, without repetitions.
  std::vector<HealthState> states() const {
    std::vector<HealthState> all;
    for (const DeviceHealth& h : health.all) {
      if (all.empty() || all.back() != h.state) all.push_back(h.state);
    }
    return all;
  }

  // Keeps each health report and then calls `then` with it.
  struct Reports final : HealthSink {
    void publish(const DeviceHealth& h) noexcept override {
      all.push_back(h);
      then(h);
    }
    std::vector<DeviceHealth> all;
    std::function<void(const DeviceHealth&)> then = [](const DeviceHealth&) {};
  } health;

  std::function<void(std::size_t)> before_opening = [](std::size_t) {};
  bool absent = false;
  bool plugged = true;
  std::stop_source stop;
  std::vector<Timestamp> opened_at;
  test::FakeStream* line = nullptr;  // the newest stream; the loop owns it
};

TEST(DeviceLoop, AnAbsentPortIsTriedEverMoreRarely) {
  Loop loop;
  loop.absent = true;
  loop.before_opening = [&](std::size_t n) {
    if (n == 8) loop.stop.request_stop();
  };
  loop.run();
  EXPECT_EQ(loop.pauses(), (std::vector<long>{100, 200, 250, 250, 250, 250, 250}));
  // The report before the last one is checked, since the last one has the reason "stopped".
  const DeviceHealth& h = loop.health.all[loop.health.all.size() - 2];
  EXPECT_EQ(h.state, HealthState::kAbsent);
  EXPECT_STREQ(h.reason, "/tmp/glove: no such file");
  EXPECT_STREQ(h.port, "pty:/tmp/glove");
  EXPECT_EQ(h.reconnects, 0u);
  EXPECT_EQ(h.since_ns, toNanoseconds(loop.start));  // the port has been absent since the start
}

TEST(DeviceLoop, ADeviceThatStreamsIsWellAndHasARate) {
  Loop loop;
  loop.health.then = [&](const DeviceHealth& h) {
    if (h.samples >= 500) loop.stop.request_stop();
  };
  loop.run();
  EXPECT_EQ(loop.states(), (std::vector{HealthState::kAbsent, HealthState::kOpening,
                                        HealthState::kOk, HealthState::kAbsent}));
  const DeviceHealth& h = loop.health.all[loop.health.all.size() - 2];
  EXPECT_EQ(h.state, HealthState::kOk);
  EXPECT_STREQ(h.identity, "CyberGlove, 22 sensors");
  EXPECT_STREQ(h.reason, "");
  EXPECT_NEAR(h.rate_hz, 100, 1);
  EXPECT_LE(h.updated_ns - h.since_ns, toNanoseconds(Timestamp(milliseconds(5200))));
  EXPECT_EQ(loop.opened_at.size(), 1u);
}

TEST(DeviceLoop, ALostDeviceIsReopenedAndCounted) {
  Loop loop;
  std::size_t lost_at = 200;
  loop.health.then = [&](const DeviceHealth& h) {
    if (h.samples >= 800) {
      loop.stop.request_stop();
    } else if (h.samples >= lost_at && h.state == HealthState::kOk) {
      loop.line->close();  // unplugged at the computer's end
      lost_at += 200;
    }
  };
  loop.run();
  EXPECT_EQ(loop.health.all.back().reconnects, 3u);
  EXPECT_EQ(loop.opened_at.size(), 4u);
  const auto states = loop.states();
  ASSERT_GE(states.size(), 6u);
  EXPECT_EQ(states[3], HealthState::kAbsent);
  EXPECT_EQ(states[4], HealthState::kOpening);
  EXPECT_EQ(states[5], HealthState::kOk);
  for (const DeviceHealth& h : loop.health.all) {
    const bool unmeasured = h.rate_hz == 0;  // no rate has been measured yet, as after each gap
    EXPECT_TRUE(unmeasured || h.state == HealthState::kOk);
    EXPECT_TRUE(unmeasured || std::abs(h.rate_hz - 100) < 2) << h.rate_hz;
  }
}

TEST(DeviceLoop, ASilentDeviceHasFailedAndItsRetryStartsAgainAtTheFirst) {
  Loop loop;
  loop.absent = true;
  loop.before_opening = [&](std::size_t n) {
    if (n == 4) loop.absent = false;   // after 550 ms of failed attempts
    if (n == 5) loop.plugged = false;  // the device has streamed and then fallen silent
    if (n == 7) loop.stop.request_stop();
  };
  loop.health.then = [&](const DeviceHealth& h) {
    if (h.samples >= 100 && h.state == HealthState::kOk) loop.line->mute();
  };
  loop.run();
  const auto pauses = loop.pauses();
  ASSERT_EQ(pauses.size(), 6u);
  EXPECT_EQ((std::vector<long>{pauses[0], pauses[1], pauses[2]}),
            (std::vector<long>{100, 200, 250}));
  EXPECT_NEAR(static_cast<double>(pauses[3]), 250 + 1000 + 500 + 100,
              120);                                                  // open, stream, silence, retry
  EXPECT_NEAR(static_cast<double>(pauses[4]), 100 + 300 + 200, 10);  // ^C, ?i, retry
  EXPECT_NEAR(static_cast<double>(pauses[5]), 100 + 300 + 250, 10);
  bool silent = false, deaf = false;
  for (const DeviceHealth& h : loop.health.all) {
    if (h.state != HealthState::kFailed) continue;
    silent |= std::string(h.reason) == "no record for 0.5 s";
    deaf |= std::string(h.reason) == "no answer to ?i within 0.3 s";
  }
  EXPECT_TRUE(silent && deaf);
  EXPECT_EQ(loop.health.all.back().reconnects, 1u);
}

TEST(DeviceLoop, AFailedDeviceWhosePortVanishesIsAbsentFromThenOn) {
  Loop loop;
  loop.plugged = false;
  loop.before_opening = [&](std::size_t n) {
    loop.absent = n > 1;
    if (n == 3) loop.stop.request_stop();
  };
  loop.run();
  EXPECT_EQ(loop.states(), (std::vector{HealthState::kAbsent, HealthState::kOpening,
                                        HealthState::kFailed, HealthState::kAbsent}));
  for (const DeviceHealth& h : loop.health.all) {
    if (std::string(h.reason) != "/tmp/glove: no such file") continue;
    EXPECT_EQ(h.since_ns, toNanoseconds(loop.opened_at[1]));
  }
}

TEST(DeviceLoop, PassesTheDevicesComplaintOnWhileItStreams) {
  Loop loop;
  loop.health.then = [&](const DeviceHealth& h) {
    if (h.state != HealthState::kOk) return;
    if (h.reason[0] || loop.health.all.size() > 20) loop.stop.request_stop();
    loop.line->mute();
    loop.line->feed(std::string("eg\0", 3));
  };
  loop.run();
  EXPECT_STREQ(loop.health.all[loop.health.all.size() - 2].reason, "glove not plugged in");
}

TEST(DeviceLoop, StopsWithinOnePollWhateverItDoes) {
  for (const HealthState during :
       {HealthState::kAbsent, HealthState::kOpening, HealthState::kOk, HealthState::kFailed}) {
    Loop loop;
    loop.plugged = during != HealthState::kFailed;
    Timestamp asked{};
    loop.health.then = [&](const DeviceHealth& h) {
      if (h.state != during || asked != Timestamp{}) return;
      asked = loop.clock.now();
      loop.stop.request_stop();
    };
    loop.run();
    EXPECT_LE(loop.clock.now() - asked, milliseconds(1));
    EXPECT_EQ(loop.health.all.back().state, HealthState::kAbsent);
    EXPECT_STREQ(loop.health.all.back().reason, "stopped");
    EXPECT_LE(loop.opened_at.size(), 1u);
  }
}

// The advice to check the speed appears only for lines that have a speed.
TEST(DeviceLoop, AsksForTheSpeedOfLinesThatHaveOne) {
  const auto reason = [](const std::string& port) {
    Loop loop;
    int tries = 0;
    DeviceLoop device(
        {.port = port, .baud = 9600},
        [&]() -> Result<std::unique_ptr<ByteStream>> {
          if (++tries == 2) loop.stop.request_stop();
          return Error{Errc::kMalformed, "line 2 makes no sense"};
        },
        cyberglove::makeDevice(CybergloveSettings{}, loop.clock, loop.sink), loop.health,
        loop.clock);
    device.run(loop.stop.get_token());
    for (const DeviceHealth& h : loop.health.all) {
      if (std::string_view(h.reason).starts_with("line 2")) return std::string(h.reason);
    }
    return std::string();
  };
  EXPECT_EQ(reason("serial:/dev/ttyS0"),
            "line 2 makes no sense (is it another device, or is its speed not 9600 baud?)");
  EXPECT_EQ(reason("replay:glove.bytes"), "line 2 makes no sense");
  EXPECT_EQ(reason("tcp://server:4001"), "line 2 makes no sense");
}

}  // namespace
}  // namespace merlin
