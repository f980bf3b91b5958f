// PJLink without a network: the protocol, hostile answers, the state of a projector, the schedule.

#include <vector>

#include <gtest/gtest.h>

#include "drivers/pjlink/digest.h"
#include "drivers/pjlink/password.h"
#include "drivers/pjlink/projector.h"
#include "drivers/pjlink/protocol.h"
#include "drivers/pjlink/schedule.h"
#include "drivers/pjlink/settings.h"
#include "tests/support/emulated_projector.h"
#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"

namespace merlin::pjlink {
namespace {

using std::chrono::seconds;

// The specification of PJLink gives this example of its authentication.
TEST(Pjlink, TheDigestIsThatOfTheSpecification) {
  EXPECT_EQ(md5Hex("498e4a67JBMIAProjectorLink"), "5d8409bc1c3fa39749434aa3a5c38682");
  EXPECT_EQ(md5Hex(""), "d41d8cd98f00b204e9800998ecf8427e");  // RFC 1321, appendix A.5
}

TEST(Pjlink, OnlyTheFirstCommandIsPrecededByTheDigest) {
  Session session("JBMIAProjectorLink");
  ASSERT_TRUE(session.feed("PJLINK 1 498e4a67\r"));
  ASSERT_TRUE(session.isOpen());
  EXPECT_EQ(session.request(Command::kAskPower, ""), "5d8409bc1c3fa39749434aa3a5c38682%1POWR ?\r");
  const auto answer = session.feed("%1POWR=3\r");
  ASSERT_TRUE(answer);
  ASSERT_TRUE(*answer);
  EXPECT_EQ((*answer)->value, "3");
  EXPECT_EQ(session.request(Command::kPowerOn, ""), "%1POWR 1\r");
}

TEST(Pjlink, WithoutAPasswordCommandsArePlain) {
  Session session("unused");
  ASSERT_TRUE(session.feed("pjlink 0\r\n"));
  EXPECT_EQ(session.request(Command::kInput, "31"), "%1INPT 31\r");
  EXPECT_EQ(session.request(Command::kPowerOff, ""), "%1POWR 0\r");
  EXPECT_EQ(session.request(Command::kAskErrors, ""), "%1ERST ?\r");
  EXPECT_EQ(session.request(Command::kAskLamps, ""), "%1LAMP ?\r");
  EXPECT_EQ(session.request(Command::kAskName, ""), "%1NAME ?\r");
  for (const char* const name : {"a", "b"}) {  // CR LF ends a line too
    const auto answer = session.feed(std::string("%1NAME=") + name + "\r\n");
    ASSERT_TRUE(answer && *answer);
    EXPECT_EQ((*answer)->value, name);
    session.request(Command::kAskName, "");
  }
}

Session greeted() {
  Session session("");
  EXPECT_TRUE(session.feed("PJLINK 0\r"));
  session.request(Command::kAskPower, "");
  return session;
}

TEST(Pjlink, AnAnswerArrivesInAnyPieces) {
  const std::string bytes = "%1POWR=ERR3\r";
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Session session = greeted();
    const auto first = session.feed(bytes.substr(0, cut));
    ASSERT_TRUE(first);
    EXPECT_FALSE(*first) << cut;
    EXPECT_EQ(session.isAtLineStart(), cut == 0);
    const auto second = session.feed(bytes.substr(cut));
    ASSERT_TRUE(second && *second) << cut;
    EXPECT_EQ((*second)->code, Answer::Code::kUnavailable);
  }
}

TEST(Pjlink, EveryDamagedByteOfAnAnswerIsAnErrorOrAnotherValue) {
  const std::string bytes = "%1POWR=1\r";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(value);
      if (damaged[i] == bytes[i]) continue;
      Session session = greeted();
      const auto answer = session.feed(damaged);
      const bool value_only = answer && *answer && (*answer)->value != "1";
      const bool incomplete = answer && !*answer;
      const bool same_letter = answer && *answer && std::isalpha(value) != 0;  // such as "%1powr"
      EXPECT_TRUE(!answer || value_only || incomplete || same_letter) << i << " " << value;
    }
  }
}

std::string faultOf(Session session, const std::string& bytes) {
  const auto fed = session.feed(bytes);
  return fed ? "" : fed.error().what;
}

TEST(Pjlink, HostileBytesEndTheConnection) {
  EXPECT_EQ(faultOf(Session(""), "SSH-2.0-OpenSSH_9.2\r"),
            "greets with \"SSH-2.0-OpenSSH_9.2\", which is not PJLink");
  EXPECT_EQ(faultOf(Session("x"), "PJLINK 1 \r"), "greets with \"PJLINK 1 \", which is not PJLink");
  EXPECT_EQ(faultOf(Session("x"), "PJLINK 1 " + std::string(33, '1') + "\r").substr(0, 11),
            "greets with");
  EXPECT_EQ(faultOf(Session(""), "PJLINK 1 498e4a67\r"),
            "asks for a password; name a file that contains it as password_file");
  EXPECT_EQ(faultOf(greeted(), "PJLINK ERRA\r"), "refuses the password (ERRA)");
  EXPECT_EQ(faultOf(greeted(), "%1LAMP=12 1\r"),
            "answers \"%1LAMP=12 1\" where %1POWR=... was due");
  EXPECT_EQ(faultOf(greeted(), "%1POWR=1\r%1POWR=0\r"), "sends \"%1POWR=0\" without being asked");
  EXPECT_EQ(faultOf(greeted(), "%1POWR=\x1b[2J\r"), "");
  EXPECT_EQ(faultOf(greeted(), std::string(135, 'x')), "");
  EXPECT_EQ(faultOf(greeted(), std::string(136, 'x')).substr(0, 40),
            "sends a line of more than 136 bytes, \"xx");
}

// A projector on a virtual clock. In each second it is sent the commands that are due, and its
// answers are read.
struct Bench {
  test::FakeClock clock;
  test::EmulatedProjector device;
  PjlinkSettings settings{.name = "left",
                          .address = "10.0.0.7",
                          .password_file = {},
                          .input = {},
                          .warm_up_s = 60,
                          .cool_down_s = 120};
  Projector projector{settings, clock.now()};

  void talk() {
    for (int i = 0; i < 10; ++i) {
      const auto command = projector.next(clock.now());
      if (!command) return;
      Session session("");
      ASSERT_TRUE(session.feed(device.greet()));
      std::string line = session.request(*command, settings.input);
      line.pop_back();
      const auto answer = session.feed(device.answer(line, clock.now()));
      ASSERT_TRUE(answer && *answer);
      projector.answered(*command, **answer, clock.now());
    }
    FAIL() << "it always has something to say";
  }
  void pass(int s) {
    for (int i = 0; i < s; ++i) {
      clock.advance(seconds(1));
      talk();
    }
  }
  ProjectorState state() { return projector.state(clock.now()); }
};

TEST(Pjlink, AProjectorIsAskedBeforeItIsSwitched) {
  Bench b;
  EXPECT_EQ(b.state().health, Health::kOpening);
  b.talk();
  EXPECT_EQ(b.state().power, Power::kOff);
  EXPECT_EQ(b.state().health, Health::kOk);
  EXPECT_EQ(b.state().identity, "Epsilon");
  EXPECT_EQ(b.state().lamp_hours, std::vector{1234});
  EXPECT_EQ(b.device.log, "") << "nobody wants it to change";
  b.projector.want(true, b.clock.now());
  b.talk();
  EXPECT_EQ(b.device.log, "1");
  b.pass(3);
  EXPECT_EQ(b.state().power, Power::kWarming);
  EXPECT_EQ(b.state().wanted, true);
  EXPECT_EQ(b.state().within, seconds(57)) << "of the 60 that it may take";
  b.pass(30);
  EXPECT_EQ(b.state().power, Power::kOn);
  EXPECT_EQ(b.state().within, std::nullopt);
  EXPECT_EQ(b.state().wanted, std::nullopt);
  EXPECT_EQ(b.device.log, "1") << "once";
}

TEST(Pjlink, WhileItCoolsOnWaitsAndIsSentAfterwards) {
  Bench b;
  b.projector.want(true, b.clock.now());
  b.pass(40);
  b.projector.want(false, b.clock.now());
  b.pass(5);
  ASSERT_EQ(b.state().power, Power::kCooling);
  b.projector.want(true, b.clock.now());
  b.pass(60);
  EXPECT_EQ(b.device.log, "10") << "still cooling";
  EXPECT_EQ(b.state().health, Health::kOk);
  b.pass(30);
  EXPECT_EQ(b.device.log, "101");
  b.pass(35);
  EXPECT_EQ(b.state().power, Power::kOn);
}

TEST(Pjlink, WhileItWarmsOffWaitsAndIsSentAfterwards) {
  Bench b;
  b.projector.want(true, b.clock.now());
  b.pass(5);
  b.projector.want(false, b.clock.now());
  b.pass(20);
  EXPECT_EQ(b.device.log, "1");
  b.pass(10);
  EXPECT_EQ(b.device.log, "10");
}

TEST(Pjlink, ARefusalIsSaidAndTriedAgain) {
  Bench b;
  b.device.refusal = "ERR3";
  b.projector.want(true, b.clock.now());
  b.pass(30);
  EXPECT_EQ(b.state().health, Health::kRefused);
  EXPECT_EQ(b.state().reason,
            "refuses to be switched on (ERR3, not available at this time); it is tried "
            "again");
  EXPECT_GE(b.device.log.size(), 8u);
  EXPECT_LE(b.device.log.size(), 11u) << "every three seconds";
  b.device.refusal.clear();
  b.pass(40);
  EXPECT_EQ(b.state().health, Health::kOk);
  EXPECT_EQ(b.state().power, Power::kOn);
}

TEST(Pjlink, AProjectorThatNeverGetsReadyHasFailed) {
  Bench b;
  b.device.warm_up = std::chrono::hours(1);
  b.talk();
  b.projector.want(true, b.clock.now());
  b.pass(60);
  EXPECT_EQ(b.state().health, Health::kOk);
  b.pass(1);
  EXPECT_EQ(b.state().health, Health::kFailed);
  EXPECT_EQ(b.state().reason, "is still warming though it was to be on by now");
}

TEST(Pjlink, ASwitchingWithoutEffectIsRepeated) {
  Bench b;
  b.device.refusal = "OK";  // the projector accepts the command and does nothing
  b.projector.want(true, b.clock.now());
  b.pass(31);
  EXPECT_EQ(b.device.log, "1111");
}

TEST(Pjlink, WhatAPersonDoesWithARemoteControlIsLeftAlone) {
  Bench b;
  b.projector.want(true, b.clock.now());
  b.pass(40);
  ASSERT_EQ(b.device.answer("%1POWR 0", b.clock.now()), "%1POWR=OK\r");
  b.pass(200);
  EXPECT_EQ(b.device.log, "10");
  EXPECT_EQ(b.state().power, Power::kOff);
}

// For a moment after it has accepted the command to switch off, a projector may still report that
// it is on.
TEST(Pjlink, OnAfterOffIsNotReachedByAnAnswerFromBefore) {
  Bench b;
  b.projector.want(true, b.clock.now());
  b.pass(40);
  b.projector.want(false, b.clock.now());
  b.projector.answered(Command::kAskPower, {Answer::Code::kValue, "1"}, b.clock.now());
  b.projector.answered(Command::kPowerOff, {Answer::Code::kValue, "OK"}, b.clock.now());
  b.projector.want(true, b.clock.now());
  b.projector.answered(Command::kAskPower, {Answer::Code::kValue, "1"}, b.clock.now());
  EXPECT_EQ(b.state().wanted, true);
}

TEST(Pjlink, TheInputIsSelectedOnceItIsOn) {
  Bench b;
  b.settings.input = "31";
  b.projector = Projector(b.settings, b.clock.now());
  b.projector.want(true, b.clock.now());
  b.pass(20);
  EXPECT_EQ(b.device.inputs, "");
  b.pass(100);
  EXPECT_EQ(b.device.inputs, "31 ");
}

TEST(Pjlink, FaultsThatItReportsAreItsHealth) {
  Bench b;
  b.device.errors = "010001";
  b.talk();
  EXPECT_EQ(b.state().health, Health::kOk);
  EXPECT_EQ(b.state().reason, "lamp: warning, other: warning");
  b.device.errors = "020000";
  b.pass(30);
  EXPECT_EQ(b.state().health, Health::kFailed);
  EXPECT_EQ(b.state().reason, "lamp: error");
  for (const char* const junk : {"junk", "00x000", "0000000"}) {
    b.device.errors = junk;
    b.pass(30);
    EXPECT_EQ(b.state().reason, "lamp: error") << "what was known stays";
  }
}

TEST(Pjlink, LampsAreReadOrUnknown) {
  const auto hours = [](const std::string& text) {
    Bench b;
    b.device.lamps = text;
    b.talk();
    return b.state().lamp_hours;
  };
  EXPECT_EQ(hours("1200 1 34567 0"), (std::vector{1200, 34567}));
  for (const char* bad : {"", "12", "12 2", "x 1", "123456 1", "-1 1", "1 1 ", "1 1 1",
                          "1 1 2 1 3 1 4 1 5 1 6 1 7 1 8 1 9 1"}) {
    const auto read = hours(bad);
    EXPECT_TRUE(read.empty() || std::string(bad) == "1 1 ") << bad;
  }
}

TEST(Pjlink, ALostProjectorIsUnknownAndAskedAgain) {
  Bench b;
  b.talk();
  b.projector.lost({Errc::kIo, "tcp://10.0.0.7:4352: Connection refused"}, b.clock.now());
  EXPECT_EQ(b.state().power, Power::kUnknown);
  EXPECT_EQ(b.state().health, Health::kUnreachable);
  EXPECT_EQ(b.state().reason, "tcp://10.0.0.7:4352: Connection refused");
  EXPECT_FALSE(b.state().answers);
  EXPECT_EQ(b.projector.due() - b.clock.now(), seconds(5));
  b.projector.lost({Errc::kInvalidArgument, "refuses the password (ERRA)"}, b.clock.now());
  EXPECT_EQ(b.state().health, Health::kPassword);
  EXPECT_EQ(b.projector.due() - b.clock.now(), seconds(30)) << "some lock out who tries often";
  b.projector.want(true, b.clock.now());
  EXPECT_EQ(b.projector.due(), b.clock.now()) << "a person may have mended it";
}

TEST(Pjlink, APasswordIsTheFirstLineOfItsFile) {
  const test::TempDir folder;
  const std::string path = folder.path() + "/password";
  const auto read = [&](const std::string& content) {
    test::writeText(path, content);
    const auto password = readPassword(path);
    return password ? *password : password.error().what;
  };
  EXPECT_EQ(*readPassword(""), "");
  EXPECT_EQ(read("secret\n"), "secret");
  EXPECT_EQ(read("secret\r\nother\n"), "secret");
  EXPECT_EQ(read(std::string(64, 'p')), std::string(64, 'p'));
  const std::string bad =
      path + ": its first line is not a password of 1 to 64 printable ASCII characters";
  for (const std::string& content :
       {std::string(), std::string("\n"), std::string("a b"), std::string(65, 'p')})
    EXPECT_EQ(read(content), bad);
  EXPECT_EQ(readPassword(folder.path() + "/none").error().code, Errc::kNotFound);
}

// Returns minutes of the local calendar. Day 0 is Monday, 2026-06-01.
LocalMinute at(int day, int hour, int minute = 0) {
  constexpr LocalMinute kMonday = 20605;  // days from 1970-01-01 to 2026-06-01
  return (kMonday + day) * 24 * 60 + hour * 60 + minute;
}

const std::vector<std::string> kDaily = SwitchingTimes().days;

TEST(Schedule, ProjectorsAreOnBetweenTheTimesOfTheDay) {
  const Schedule schedule(
      {{{"mon", "tue", "wed", "thu", "fri"}, "09:00", "17:30"}, {{"sat"}, "20:00", "02:00"}});
  for (int day = 0; day < 5; ++day) {
    EXPECT_FALSE(schedule.isOn(at(day, 8, 59)));
    EXPECT_TRUE(schedule.isOn(at(day, 9)));
    EXPECT_TRUE(schedule.isOn(at(day, 17, 29)));
    EXPECT_FALSE(schedule.isOn(at(day, 17, 30)));
  }
  EXPECT_FALSE(schedule.isOn(at(5, 9))) << "Saturday";
  EXPECT_TRUE(schedule.isOn(at(5, 20)));
  EXPECT_TRUE(schedule.isOn(at(6, 1, 59))) << "Sunday, still Saturday's";
  EXPECT_FALSE(schedule.isOn(at(6, 2)));
  EXPECT_FALSE(schedule.isOn(at(6, 21)));
  EXPECT_FALSE(schedule.isOn(at(7, 1))) << "Monday";
}

TEST(Schedule, SpeaksOnlyWhenItsStateChanges) {
  Schedule schedule({{kDaily, "09:00", "17:00"}, {kDaily, "16:00", "18:00"}});
  EXPECT_EQ(schedule.step(at(0, 8)), false) << "at the start";
  EXPECT_EQ(schedule.step(at(0, 8, 59)), std::nullopt);
  EXPECT_EQ(schedule.step(at(0, 9)), true);
  EXPECT_EQ(schedule.step(at(0, 17)), std::nullopt) << "the other entry goes on";
  EXPECT_EQ(schedule.step(at(0, 18)), false);
  EXPECT_EQ(Schedule({}).step(at(0, 9)), std::nullopt) << "without entries nothing is switched";
}

// When the clocks go back, 02:00 to 03:00 occurs twice.
TEST(Schedule, ARepeatedHourSwitchesOnce) {
  Schedule schedule({{kDaily, "01:00", "02:30"}});
  EXPECT_EQ(schedule.step(at(0, 2, 29)), true);
  EXPECT_EQ(schedule.step(at(0, 2, 30)), false);
  EXPECT_EQ(schedule.step(at(0, 2, 59)), std::nullopt);
  for (int minute = 0; minute < 60; ++minute)
    EXPECT_EQ(schedule.step(at(0, 2, minute)), std::nullopt) << minute;
  EXPECT_EQ(schedule.step(at(0, 3)), std::nullopt);
  EXPECT_EQ(schedule.step(at(1, 1)), true);
}

// When the clocks go forward, 02:00 to 03:00 does not occur.
TEST(Schedule, AnHourThatIsLeftOutCountsAsPassed) {
  Schedule schedule({{kDaily, "02:30", "12:00"}});
  EXPECT_EQ(schedule.step(at(0, 1, 59)), false);
  EXPECT_EQ(schedule.step(at(0, 3)), true);
}

TEST(Schedule, AClockThatIsSetBackByDaysCounts) {
  Schedule schedule({{kDaily, "09:00", "17:00"}});
  EXPECT_EQ(schedule.step(at(30, 10)), true);
  EXPECT_EQ(schedule.step(at(0, 8)), false);
}

TEST(Schedule, SaysWhenItSwitchesNext) {
  const Schedule schedule({{{"mon", "tue"}, "09:00", "17:00"},
                           {{"mon"}, "16:00", "18:00"},
                           {{"sat"}, "20:00", "02:00"}});
  const auto next = [&](LocalMinute now) {
    const auto found = schedule.next(now);
    return found ? std::pair(found->at, found->on) : std::pair(LocalMinute{0}, false);
  };
  EXPECT_EQ(next(at(0, 8, 59)), std::pair(at(0, 9), true));
  EXPECT_EQ(next(at(0, 9)), std::pair(at(0, 18), false)) << "at 17:00 the other entry goes on";
  EXPECT_EQ(next(at(1, 17)), std::pair(at(5, 20), true)) << "Saturday";
  EXPECT_EQ(next(at(5, 23)), std::pair(at(6, 2), false)) << "Sunday";
  EXPECT_EQ(next(at(6, 2)), std::pair(at(7, 9), true)) << "the next week";
  EXPECT_FALSE(Schedule({}).next(at(0, 9)));
  EXPECT_FALSE(Schedule({{kDaily, "09:00", "09:00"}}).next(at(0, 9))) << "on for ever";
}

TEST(PjlinkSettings, FaultsAreNamed) {
  const std::vector<PjlinkSettings> projectors = {
      {.name = "left", .address = "10.0.0.7"},
      {.name = "left", .address = "projector-2.lab:4353", .input = "61"},
      {.name = "a b", .address = "10.0.0.7:99999"},
      {.name = "panel", .address = ""}};
  std::string text;
  for (const SettingFault& f : validate(projectors)) text += f.pointer + " " + f.what + "\n";
  EXPECT_EQ(text,
            "/1/name is \"left\", the name of another projector\n"
            "/1/input is \"61\"; allowed are two digits: 1 (RGB), 2 (video), 3 (digital), 4 "
            "(storage) or 5 (network), then the number of the input from 1 to 9, or \"\"\n"
            "/2/name is \"a b\"; allowed are 1 to 32 letters, digits, - and _\n"
            "/2/address is \"10.0.0.7:99999\"; allowed is HOST or HOST:PORT, PORT 1 to 65535\n"
            "/3/name is \"panel\", the name of the projectors at the panel's line\n"
            "/3/address is \"\"; allowed is HOST or HOST:PORT, PORT 1 to 65535\n");
  const auto twice = validate(std::vector<PjlinkSettings>{
      {.name = "left", .address = "10.0.0.7"}, {.name = "right", .address = "10.0.0.7:4352"}});
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_EQ(twice[0].pointer + " " + twice[0].what,
            "/1/address is \"10.0.0.7:4352\", the address of the projector \"left\" too");
  text.clear();
  const std::vector<SwitchingTimes> times = {{kDaily, "09:00", "17:00"},
                                             {{}, "9:00", "24:00"},
                                             {{"sun", "Mon"}, "08:00", "08:00"},
                                             {{"mon"}, "0a:00", "08:60"}};
  for (const SettingFault& f : validate(times)) text += f.pointer + " " + f.what + "\n";
  EXPECT_EQ(text,
            "/1/on is \"9:00\"; allowed is a time from 00:00 to 23:59\n"
            "/1/off is \"24:00\"; allowed is a time from 00:00 to 23:59\n"
            "/1/days names no day; leave it out for all days\n"
            "/2/off is the same time as on; leave out this entry, or change one of the two\n"
            "/2/days/1 is \"Mon\"; allowed are mon, tue, wed, thu, fri, sat, sun\n"
            "/3/on is \"0a:00\"; allowed is a time from 00:00 to 23:59\n"
            "/3/off is \"08:60\"; allowed is a time from 00:00 to 23:59\n");
}

TEST(PjlinkSettings, AnAddressHasPort4352UnlessItSaysOther) {
  const auto parsed = [](const char* text) {
    const auto a = projectorAddress(text);
    return a ? a->host + " " + a->port : "none";
  };
  EXPECT_EQ(parsed("10.0.0.7"), "10.0.0.7 4352");
  EXPECT_EQ(parsed("left.lab:14352"), "left.lab 14352");
  EXPECT_EQ(parsed("[fe80::1]"), "fe80::1 4352");
  EXPECT_EQ(parsed("[::1]:1"), "::1 1");
  for (const char* bad : {"", ":4352", "10.0.0", "10.0.0.7:", "a b", "*", "*:4352", "host:0"})
    EXPECT_EQ(parsed(bad), "none") << bad;
}

}  // namespace
}  // namespace merlin::pjlink
