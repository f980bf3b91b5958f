// All projectors together: a day on a virtual clock with the schedule, a person's commands,
// cool-down, and a projector that does not answer for a while. Also the texts of commands and
// status.
#include "daemon/devices/projectors.h"

#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/status/projectors.h"
#include "drivers/gpio/panel.h"
#include "tests/support/emulated_connection.h"
#include "tests/support/fake_clock.h"
#include "tests/support/told.h"

namespace merlin::devices {
namespace {

using std::chrono::seconds;
using test::EmulatedProjector;

using EmulatedConnection = test::EmulatedConnection<test::FakeClock>;

DevicesSettings settingsOf(const std::vector<SwitchingTimes>& schedule) {
  DevicesSettings settings;
  settings.projectors = {{.name = "left", .address = "10.0.0.7"},
                         {.name = "right", .address = "10.0.0.8"}};
  settings.projector_schedule = schedule;
  return settings;
}

constexpr pjlink::LocalMinute kMonday = 20605 * 24 * 60;  // 2026-06-01 00:00

// A wall with projectors at the control panel's line and two projectors that speak PJLink; its
// clock starts on Monday at `start_min`.
struct Wall {
  explicit Wall(int start_min, const std::vector<SwitchingTimes>& schedule =
                                   {{{"mon", "tue", "wed", "thu", "fri"}, "09:00", "17:00"}})
      : first_min(kMonday + start_min), projectors(settingsOf(schedule), parts()) {}

  Projectors::Parts parts() {
    return {
        [this](const std::string& command) -> Result<Ok> {
          if (chip_gone) return Error{Errc::kIo, "gpiochip0: No such device"};
          return panel.execute(command, clock.now());
        },
        [this](const TcpAddress& to) -> Result<std::unique_ptr<ByteStream>> {
          EmulatedProjector& device = to.host == "10.0.0.7" ? left : right;
          if (&device == &right && right_gone)
            return Error{Errc::kTimeout, "tcp://10.0.0.8:4352: Connection timed out"};
          return std::unique_ptr<ByteStream>(std::make_unique<EmulatedConnection>(device, clock));
        },
        [this] { return minute(); }, clock};
  }
  pjlink::LocalMinute minute() const {
    return first_min +
           std::chrono::duration_cast<std::chrono::minutes>(clock.now() - begin).count();
  }
  std::string time() const {
    const auto s = std::chrono::duration_cast<seconds>(clock.now() - begin).count() +
                   (first_min - kMonday) * 60;
    return fmt::format("{:02}:{:02}:{:02}", s / 3600 % 24, s / 60 % 60, s % 60);
  }
  std::string powers() {
    constexpr const char* kNames[] = {"off", "warming", "on", "cooling"};
    std::string text = kNames[panel.sample(clock.now()).power];
    for (const auto& s : projectors.states())
      text += fmt::format(" {}", pjlink::powerName(s.power));
    return text;
  }
  // Runs until the time of day: does in each second what is due, and adds a row for each change.
  void until(int hour, int minute_of_hour, int second = 0) {
    const auto end = begin + seconds(hour * 3600 + minute_of_hour * 60 + second) -
                     std::chrono::minutes(first_min - kMonday);
    while (clock.now() < end) {
      clock.advance(seconds(1));
      panel.step(false, clock.now());
      projectors.tend();
      projectors.round();
      for (const std::string& event : test::told(projectors.takeEvents())) {
        if (event.starts_with("projectors: ")) table += time() + " " + event + "\n";
      }
      if (const std::string now = powers(); now != last) {
        table += fmt::format("{} {}\n", time(), now);
        last = now;
      }
    }
  }
  void command(bool on) {
    const auto done = projectors.switchAll(on);
    table += fmt::format("{} projector_{}: {}\n", time(), on ? "on" : "off",
                         done ? "done" : done.error().what);
  }

  test::FakeClock clock;
  Timestamp begin = clock.now();
  pjlink::LocalMinute first_min;
  EmulatedProjector left, right;
  bool right_gone = false, chip_gone = false;
  gpio::Panel panel{{.chip = "gpiochip0", .projector_line = 0}, clock.now()};
  Projectors projectors;
  std::string last, table = "\n";
};

// The columns after the time are the panel's projectors (30 s to warm up, 90 s to cool down), then
// the projectors left and right, which take the same times.
TEST(Projectors, ADayOnAVirtualClock) {
  Wall w(8 * 60);
  w.until(8, 30);
  w.command(true);  // somebody comes early
  w.until(8, 31);
  w.command(false);  // and leaves
  w.until(12, 0);
  w.command(false);  // a talk, in the dark
  w.until(12, 0, 30);
  w.command(true);  // before they have cooled down
  w.until(16, 0);
  w.right_gone = true;
  w.until(16, 30);
  w.command(true);
  w.until(17, 10);
  w.right_gone = false;
  w.until(20, 0);
  w.command(true);  // a late visitor
  w.until(33, 5);   // Tuesday, 09:05
  EXPECT_EQ(w.table, R"(
08:00:01 projectors: switched off by the schedule
08:00:01 off off off
08:30:00 projector_on: done
08:30:01 warming off off
08:30:03 warming warming warming
08:30:30 on warming warming
08:30:31 on on on
08:31:00 projector_off: done
08:31:01 cooling on on
08:31:03 cooling cooling cooling
08:32:30 off cooling cooling
08:32:31 off off off
09:00:00 projectors: switched on by the schedule
09:00:00 warming off off
09:00:02 warming warming warming
09:00:30 on on on
12:00:00 projector_off: done
12:00:01 cooling on on
12:00:03 cooling cooling cooling
12:00:30 projector_on: panel: the projectors cool down: wait 60 s; it is switched on afterwards
12:01:30 warming cooling cooling
12:01:31 warming off off
12:01:33 warming warming warming
12:02:00 on warming warming
12:02:01 on on on
16:00:01 on on unknown
16:30:00 projector_on: right: tcp://10.0.0.8:4352: Connection timed out; it is switched on when it answers
17:00:00 projectors: switched off by the schedule
17:00:00 cooling on unknown
17:00:02 cooling cooling unknown
17:01:30 off off unknown
17:10:05 off off on
17:10:07 off off cooling
17:11:35 off off off
20:00:00 projector_on: done
20:00:01 warming off off
20:00:03 warming warming warming
20:00:30 on warming warming
20:00:31 on on on
09:00:00 projectors: switched on by the schedule
)");
}

TEST(Projectors, WhatThePanelRefusesTheScheduleIsDoneLater) {
  Wall w(8 * 60 + 59);
  w.until(8, 59, 50);
  w.command(true);
  w.command(true);
  w.until(8, 59, 56);
  w.command(false);  // the projectors are cooling down for 90 s when the schedule switches them on
  w.until(9, 10);
  EXPECT_EQ(w.powers(), "on on on");
}

TEST(Projectors, WhatTheyWereToldWhileTheChipWasGoneIsDoneLater) {
  Wall w(10 * 60, {});
  w.chip_gone = true;
  w.until(10, 1);
  w.command(true);
  w.until(10, 2);
  EXPECT_EQ(w.powers(), "off on on");
  w.chip_gone = false;
  w.until(10, 3);
  EXPECT_EQ(w.powers(), "on on on");
}

TEST(Projectors, APersonSupersedesWhatTheScheduleStillWants) {
  Wall w(16 * 60 + 59, {{{"mon"}, "17:00", "18:00"}});
  w.until(16, 59, 30);
  w.command(true);
  w.until(16, 59, 50);
  w.command(false);
  w.until(17, 0, 10);  // the schedule waits for the panel to cool down
  w.command(false);
  w.until(17, 30);
  EXPECT_EQ(w.powers(), "off off off");
}

// merlind is restarted on a Monday or Tuesday. The schedule switches on at 09:00 and off at 17:00.
struct Restart {
  int command_min;  // when a person switched the projectors, from Monday 00:00
  bool on;
  int restart_min;
  const char* expected;
};

class AfterARestart : public testing::TestWithParam<Restart> {};

TEST_P(AfterARestart, APersonsCommandHoldsUntilTheSchedulesNextPoint) {
  const Restart& r = GetParam();
  Wall w(r.restart_min);
  w.projectors.remember(PersonsSwitch{r.on, kMonday + r.command_min}, [](const PersonsSwitch&) {});
  const int minute = r.restart_min + 5;
  w.until(minute / 60, minute % 60);
  EXPECT_EQ(w.powers(), r.expected) << w.table;
}

constexpr const char* kOff = "off off off";
constexpr const char* kOn = "on on on";

INSTANTIATE_TEST_SUITE_P(
    Times, AfterARestart,
    testing::Values(Restart{14 * 60, false, 15 * 60, kOff},      // switched off in the afternoon
                    Restart{8 * 60, true, 8 * 60 + 30, kOn},     // on before the opening time
                    Restart{14 * 60, false, 17 * 60 + 1, kOff},  //
                    Restart{14 * 60, true, 17 * 60 + 1, kOff},   // the switching time has passed
                    Restart{14 * 60, false, 33 * 60 + 5, kOn},   // two of them have
                    Restart{18 * 60, true, 27 * 60, kOn},        // a late visitor stays till three
                    Restart{20 * 60, false, 27 * 60, kOff}));

TEST(Projectors, WhatAPersonDoesIsKeptWithItsTime) {
  Wall w(16 * 60 + 59);
  std::vector<PersonsSwitch> kept;
  w.projectors.remember({}, [&](const PersonsSwitch& person) { kept.push_back(person); });
  w.until(17, 10);
  EXPECT_TRUE(kept.empty()) << "the schedule is no person";
  w.command(true);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_TRUE(kept[0].on);
  EXPECT_EQ(kept[0].at, kMonday + 17 * 60 + 10);
}

TEST(Projectors, WithoutAScheduleARestartSwitchesNothing) {
  Wall w(8 * 60, {});
  w.projectors.remember(PersonsSwitch{true, kMonday}, [](const PersonsSwitch&) {});
  w.until(8, 5);
  EXPECT_EQ(w.powers(), "off off off");
}

TEST(Projectors, EventsNameProjectorPowerAndHealth) {
  Wall w(8 * 60);
  w.right_gone = true;
  w.projectors.round();
  EXPECT_EQ(
      test::told(w.projectors.takeEvents()),
      (test::Sentences{
          "projector left: off, ok",
          "fault: projector right: unknown, unreachable (tcp://10.0.0.8:4352: Connection timed "
          "out)"}));
  w.projectors.round();
  EXPECT_TRUE(w.projectors.takeEvents().empty()) << "nothing has changed";
}

TEST(Projectors, TheStatusListsThem) {
  status::ProjectorStatus left;
  left.name = "left";
  left.kind = "pjlink";
  left.power = "on";
  left.health = "ok";
  left.lamp_hours = {1200, 7};
  EXPECT_EQ(status::addProjectors(R"({"role":"devices"})", {left}),
            R"({"role":"devices","projectors":{"left":{"kind":"pjlink","power":"on","wanted":"",)"
            R"("health":"ok","reason":"","address":"","identity":"","lamp_hours":[1200,7]}}})");
  EXPECT_EQ(status::addProjectors(R"({"role":"devices"})", {}), R"({"role":"devices"})");
  constexpr std::int64_t kMinute = 20605 * 24 * 60 + 18 * 60 + 5;  // 2026-06-01
  EXPECT_EQ(status::addProjectors("{}", {}, status::ProjectorSwitching{kMinute, true}),
            R"({"projector_schedule":{"at":"2026-06-01T18:05","on":true}})");
  left.within_s = 42;
  EXPECT_NE(status::addProjectors("{}", {left}).find(R"("within_s":42)"), std::string::npos);
}

TEST(ProjectorStatus, IsReadFromADocumentByWhoeverGetsIt) {
  status::ProjectorStatus left;
  left.name = "left";
  left.power = "warming";
  left.wanted = "on";
  const auto read = status::projectorsIn(status::addProjectors(R"({"role":"devices"})", {left}));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].name, "left");
  EXPECT_EQ(read[0].power, "warming");
  EXPECT_EQ(read[0].wanted, "on");
  for (const char* none : {"", "[]", "{", "{}", R"({"projectors": 3})", R"({"projectors": []})"})
    EXPECT_TRUE(status::projectorsIn(none).empty()) << none;
  const auto odd = status::projectorsIn(R"({"projectors": {"a": 7, "b": {"power": 1}}})");
  ASSERT_EQ(odd.size(), 2U);
  EXPECT_EQ(odd[1].power, "");
}

}  // namespace
}  // namespace merlin::devices
