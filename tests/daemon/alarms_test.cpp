// Alarms: which events start a program and how often, and a program whose time is limited.
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/alarms/alarm_queue.h"
#include "daemon/alarms/child_program.h"
#include "daemon/alarms/role_state.h"
#include "daemon/alarms/told_events.h"
#include "daemon/base/child_process.h"
#include "daemon/json/json_tree.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::alarms {
namespace {

using std::chrono::seconds;
using test::TempDir;

Timestamp at(double after_s) { return Timestamp(fromSeconds(1000 + after_s)); }

AlarmEvent event(const std::string& what, const std::string& kind = "device",
                 Severity severity = Severity::kFault) {
  return {"devices", "2026-11-25T12:00:00.000000Z", kind, what, severity};
}

AlarmSettings settings(int most_per_hour, std::vector<std::string> kinds = {}) {
  AlarmSettings s;
  s.run = {"/bin/true"};
  s.kinds = std::move(kinds);
  s.most_per_hour = most_per_hour;
  return s;
}

TEST(AlarmQueue, TellsEventsInTheirOrder) {
  AlarmQueue queue(settings(12));
  EXPECT_FALSE(queue.next(at(0)));
  queue.add(event("one"));
  queue.add(event("two"));
  EXPECT_EQ(queue.next(at(0))->event.what, "one");
  EXPECT_EQ(queue.next(at(0))->event.what, "two");
  EXPECT_FALSE(queue.next(at(0)));
}

TEST(AlarmQueue, LeavesOutOtherKinds) {
  AlarmQueue queue(settings(12, {"output", "role"}));
  queue.add(event("a device"));
  queue.add(event("an output", "output"));
  EXPECT_EQ(queue.next(at(0))->event.what, "an output");
  EXPECT_FALSE(queue.next(at(0)));
}

TEST(AlarmQueue, IsNeverForWhatIsRoutine) {
  AlarmQueue queue(settings(12));
  queue.add(event("hand: gesture push", "gesture", Severity::kRoutine));
  queue.add(event("an output", "output"));
  EXPECT_EQ(queue.next(at(0))->event.what, "an output");
}

TEST(AlarmQueue, TellsFaultsFirstAndKeepsTheLastStartForOne) {
  AlarmQueue queue(settings(12));  // at most six starts at once
  for (int i = 0; i < 8; ++i) queue.add(event("news", "device", Severity::kNews));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(queue.next(at(0))->event.what, "news") << i;
  EXPECT_FALSE(queue.next(at(0)));
  EXPECT_EQ(queue.waiting(), 3u);
  queue.add(event("the wall is gone", "role"));
  EXPECT_EQ(queue.next(at(0))->event.what, "the wall is gone");
  queue.add(event("and the devices", "role"));
  EXPECT_FALSE(queue.next(at(0)));
  EXPECT_EQ(queue.next(at(600))->event.what, "and the devices") << "one in ten minutes";
}

TEST(AlarmQueue, WhereOneMayStartAtOnceItMayBeForNews) {
  AlarmQueue queue(settings(2));
  queue.add(event("news", "device", Severity::kNews));
  EXPECT_TRUE(queue.next(at(0)));
}

TEST(AlarmQueue, WhenItIsFullNewsAreLeftOutBeforeFaults) {
  AlarmQueue queue(settings(2000));
  queue.add(event("a fault"));
  for (std::size_t i = 0; i < AlarmQueue::kMost; ++i)
    queue.add(event("news", "device", Severity::kNews));
  const auto first = queue.next(at(0));
  EXPECT_EQ(first->event.what, "a fault");
  EXPECT_EQ(first->left_out, 1u);
  for (std::size_t i = 0; i < AlarmQueue::kMost + 1; ++i) queue.add(event(std::to_string(i)));
  EXPECT_EQ(queue.next(at(0))->event.what, "1") << "the oldest fault, if there is nothing else";
}

TEST(AlarmQueue, AFaultWaitsLongerThanNews) {
  AlarmQueue queue(settings(2));
  queue.add(event("first"));
  EXPECT_TRUE(queue.next(at(0)));
  queue.add(event("a fault"));
  queue.add(event("news", "device", Severity::kNews));
  EXPECT_FALSE(queue.next(at(1)));
  EXPECT_EQ(queue.next(at(3600))->event.what, "a fault");
  EXPECT_EQ(queue.waiting(), 0u);
}

TEST(AlarmQueue, ATestIsToldWhateverWasToldBefore) {
  AlarmQueue queue(settings(2));
  queue.add(event("one"));
  queue.add(event("two"));
  EXPECT_TRUE(queue.next(at(0)));
  EXPECT_FALSE(queue.next(at(0)));
  for (int i = 0; i < 3; ++i) {
    queue.add(event("a test", kTestKind));
    const auto next = queue.next(at(0));
    ASSERT_TRUE(next) << i;
    EXPECT_EQ(next->event.what, "a test");
  }
}

TEST(AlarmQueue, NeverStartsMoreThanAllowedWithinAnHour) {
  constexpr int kMost = 6;
  AlarmQueue queue(settings(kMost));
  std::deque<double> starts;
  for (double t = 0; t < 4 * 3600; t += 1) {
    queue.add(event("again"));
    if (!queue.next(at(t))) continue;
    starts.push_back(t);
    while (starts.front() <= t - 3600) starts.pop_front();
    ASSERT_LE(starts.size(), static_cast<std::size_t>(kMost)) << t;
  }
  EXPECT_GE(starts.size(), 2u) << "and not none";
}

TEST(AlarmQueue, SaysHowManyEventsWereLeftOut) {
  AlarmQueue queue(settings(2));
  queue.add(event("first"));
  EXPECT_EQ(queue.next(at(0))->left_out, 0u);
  for (std::size_t i = 0; i < AlarmQueue::kMost + 5; ++i) queue.add(event(std::to_string(i)));
  EXPECT_FALSE(queue.next(at(1)));
  queue.add(event("later"));
  const auto next = queue.next(at(3605));  // the events that waited are too old by now
  ASSERT_TRUE(next);
  EXPECT_EQ(next->event.what, "later");
  EXPECT_EQ(next->left_out, AlarmQueue::kMost + 5);
}

TEST(AlarmText, IsJsonWhateverTheEventSays) {
  const std::string text = alarmText("lab", event("a \"quote\"\n\x01 \xFF"), 3);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const auto parsed = parseJson(text);
  ASSERT_TRUE(parsed) << text;
  EXPECT_EQ(parsed->members.size(), 6u);
}

TEST(AlarmSettings, ProgramsAreAbsolutePathsAndKindsAreThoseOfEvents) {
  std::vector<AlarmSettings> alarms(3);
  alarms[1].run = {"mail", "-s", "wall"};
  alarms[2].run = {"/usr/bin/mail"};
  alarms[2].kinds = {"device", "output"};
  std::vector<std::string> pointers;
  for (const SettingFault& fault : validate(alarms)) pointers.push_back(fault.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/0/run", "/1/run/0", "/2/kinds/1"}));
}

// Waits, on the system's clock, until the program has ended; returns how it ended.
std::string outcome(ChildProgram& program, double pretend_s = 0) {
  const SystemClock clock;
  std::optional<std::string> ended;
  EXPECT_TRUE(test::eventually(
      [&] { return (ended = program.ended(clock.now() + fromSeconds(pretend_s))).has_value(); }));
  return ended.value_or("it still runs");
}

Timestamp inAnHour() { return SystemClock().now() + std::chrono::hours(1); }

TEST(ChildProgram, GetsTheTextAsItsInput) {
  const TempDir dir;
  auto program =
      ChildProgram::start({"/bin/sh", "-c", "cat > \"$0\"", dir / "out"}, "an event\n", inAnHour());
  ASSERT_TRUE(program) << program.error().what;
  EXPECT_EQ(outcome(*program), "");
  EXPECT_EQ(test::readText(dir / "out"), "an event\n");
  EXPECT_FALSE(program->ended(inAnHour())) << "it is told once";
}

TEST(ChildProgram, SaysHowItFailed) {
  auto failed = ChildProgram::start({"/bin/sh", "-c", "exit 3"}, "", inAnHour());
  ASSERT_TRUE(failed);
  EXPECT_EQ(outcome(*failed), "ended with status 3");
  auto killed = ChildProgram::start({"/bin/sh", "-c", "kill -SEGV $$"}, "", inAnHour());
  ASSERT_TRUE(killed);
  EXPECT_EQ(outcome(*killed), "was ended by signal 11");
  const auto missing = ChildProgram::start({"/no/such/program"}, "", inAnHour());
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
}

// Runs in a child process, so that the limit on descriptors affects only the child: of the five
// files that the start needs, none to three can be opened.
TEST(ChildProgram, IsNamedWhereDescriptorsRanOut) {
  const auto child = startChild();
  ASSERT_TRUE(child);
  if (*child == 0) {
    const int next = ::dup(0);
    ::close(next);
    int named = 0;
    for (const unsigned free : {0U, 1U, 3U}) {
      const auto used = static_cast<rlim_t>(next);
      const rlimit limit{used + free, used + 3};
      if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) ::_exit(100);
      const auto started = ChildProgram::start({"/bin/true"}, "", inAnHour());
      if (!started && started.error().what.starts_with("/bin/true: ") &&
          started.error().what.ends_with(": Too many open files"))
        ++named;
    }
    ::_exit(named);
  }
  const int status = waitForChild(*child);
  ASSERT_TRUE(WIFEXITED(status)) << status;
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

TEST(ChildProgram, OfWhatItWritesTheBeginningIsKept) {
  auto little = ChildProgram::start({"/bin/sh", "-c", "echo one; printf 't\\033wo\\n\\nthree' >&2"},
                                    "", inAnHour());
  ASSERT_TRUE(little);
  EXPECT_EQ(outcome(*little), "");
  EXPECT_EQ(little->written(), (std::vector<std::string>{"one", "t\\x1bwo", "three"}));
  auto much = ChildProgram::start({"/bin/sh", "-c", "yes | head -c 3000000"}, "", inAnHour());
  ASSERT_TRUE(much);
  EXPECT_EQ(outcome(*much), "");
  const std::vector<std::string> lines = much->written();
  EXPECT_EQ(lines.size(), ChildProgram::kMostKept / 2 + 1);
  EXPECT_EQ(lines.back(), "... and 2997952 bytes more, left out");
}

// The check of a program has to report the same reason as its start.
TEST(ChildProgram, SaysWhyAScriptCannotBeExecuted) {
  const TempDir dir;
  const std::string script = dir / "script";
  const auto whatOf = [&](const std::string& text) {
    test::writeText(script, text);
    EXPECT_EQ(::chmod(script.c_str(), 0755), 0);
    const auto checked = checkProgram(script);
    const auto started = ChildProgram::start({script}, "", inAnHour());
    EXPECT_EQ(checked.ok(), started.ok()) << text;
    EXPECT_EQ(checked ? "" : checked.error().what, started ? "" : started.error().what);
    return checked ? std::string("started") : checked.error().what;
  };
  const std::string begin = script + ": cannot be executed: ";
  const std::string none = "it is not a program; a script begins with a line such as #!/bin/sh";
  const std::string names = "its first line names the interpreter ";
  for (const char* text : {"echo\n", "", "#", "#!", "#! \n/bin/sh\n"})
    EXPECT_EQ(whatOf(text), begin + none) << text;
  for (const char* text : {"#!/no/such/sh\n", "#! \t/no/such/sh -e", "#!/no/such/sh\t\n"})
    EXPECT_EQ(whatOf(text), begin + names + "/no/such/sh: No such file or directory") << text;
  EXPECT_EQ(whatOf("#!/bin/sh\r\n"), begin + names + "/bin/sh\\x0d: No such file or directory");
  EXPECT_EQ(whatOf("#!/etc/passwd\n"), begin + names + "/etc/passwd: Permission denied");
  EXPECT_EQ(whatOf("#!/tmp\n"), begin + names + "/tmp: it is not a file");
  for (const char* text : {"#!/bin/sh", "#!/bin/sh\n", "#! /bin/sh -e\n"})
    EXPECT_EQ(whatOf(text), "started") << text;
}

// Only the kernel can say whether a program that is not a script can be executed.
TEST(ChildProgram, IsNotJudgedByBytesThatAreNoScript) {
  const TempDir dir;
  test::writeText(dir / "program", std::string("MZ\0\1", 4));
  ASSERT_EQ(::chmod((dir / "program").c_str(), 0755), 0);
  EXPECT_TRUE(checkProgram(dir / "program"));
  EXPECT_TRUE(checkProgram("/bin/true"));
}

TEST(ChildProgram, IsEndedWithAllThatItStartedWhenItsTimeIsOver) {
  const TempDir dir;
  auto program = ChildProgram::start(
      {"/bin/sh", "-c", "sleep 1000 >/dev/null 2>&1 & echo $! > \"$0\"; wait", dir / "pid"}, "",
      inAnHour());
  ASSERT_TRUE(program);
  ASSERT_TRUE(test::eventually([&] { return !test::readText(dir / "pid").empty(); }));
  EXPECT_FALSE(program->ended(SystemClock().now()));
  EXPECT_EQ(outcome(*program, 7200), "took longer than its time limit, and was ended");
  const pid_t sleeper = std::stoi(test::readText(dir / "pid"));
  // The process is gone, or it is a zombie that init has not collected yet.
  EXPECT_TRUE(test::eventually([&] {
    const std::string stat = test::readText("/proc/" + std::to_string(sleeper) + "/stat");
    return stat.empty() || stat.find(") Z") != std::string::npos;
  }));
}

TEST(RoleStateTest, TellsOfARoleThatEndedAndIsBackButNotOfARestart) {
  Timestamp now{};
  RoleState wall("wall", true, now);
  const auto after = [&](Duration time, std::uint64_t generation) {
    now += time;
    return wall.update(generation, now).value_or("");
  };
  EXPECT_EQ(after(seconds(1), 7), "");
  EXPECT_EQ(after(seconds(14), 0), "");
  EXPECT_EQ(after(seconds(0), 8), "") << "it was restarted";
  EXPECT_EQ(after(seconds(14), 0), "");
  EXPECT_EQ(after(seconds(1), 0), "the role wall has not run for 15 s");
  EXPECT_EQ(after(seconds(100), 0), "") << "once";
  EXPECT_EQ(after(seconds(1), 9), "the role wall runs again");
  EXPECT_EQ(after(seconds(1), 9), "");
}

TEST(RoleStateTest, TellsOfARoleThatNeverCameIfItHasWork) {
  RoleState wall("wall", true, {}), devices("devices", false, {});
  EXPECT_EQ(wall.update(0, Timestamp(seconds(179))), std::nullopt);
  EXPECT_EQ(wall.update(0, Timestamp(seconds(180))),
            "the role wall has not run since the alarms were started 180 s ago");
  EXPECT_EQ(wall.update(0, Timestamp(seconds(1000))), std::nullopt);
  EXPECT_EQ(wall.update(3, Timestamp(seconds(1001))), "the role wall runs again");
  EXPECT_EQ(devices.update(0, Timestamp(seconds(1000))), std::nullopt);
}

TEST(RoleStateTest, TellsOfARoleThatDoesNotStay) {
  RoleState wall("wall", true, {});
  std::uint64_t generation = 1;
  int told = 0;
  const auto starts = [&](int count, Duration apart, Timestamp from) {
    told = 0;
    for (int i = 0; i < count; ++i) {
      const auto said = wall.update(generation++, from + i * apart);
      if (!said) continue;
      ++told;
      EXPECT_EQ(*said,
                "the role wall was started 5 times within 10 minutes: it does not keep running");
    }
    return told;
  };
  EXPECT_EQ(starts(4, seconds(5), Timestamp(seconds(0))), 0);
  EXPECT_EQ(starts(1, seconds(5), Timestamp(seconds(20))), 1) << "the fifth";
  EXPECT_EQ(starts(10, seconds(5), Timestamp(seconds(25))), 2) << "every fifth, while it goes on";
  EXPECT_EQ(starts(50, std::chrono::minutes(3), Timestamp(std::chrono::hours(2))), 0)
      << "now and then is no loop";
}

TEST(EventsOf, AreThoseOfAnAnswerInTheirOrder) {
  const auto events =
      eventsOf("devices",
               R"([{"now_ns": 7, "time_utc": "T1", "kind": "device", "what": "ball: absent"},
          {"kind": "device"}, 3,
          {"time_utc": "T2", "kind": "flight", "severity": "news", "what": "bytes"}])");
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].role, "devices");
  EXPECT_EQ(events[0].time_utc, "T1");
  EXPECT_EQ(events[0].what, "ball: absent");
  EXPECT_EQ(events[0].severity, Severity::kFault) << "of an older release";
  EXPECT_EQ(events[1].kind, "flight");
  EXPECT_EQ(events[1].severity, Severity::kNews);
  for (const char* const none : {"", "[", "{}", "[]", "null"})
    EXPECT_TRUE(eventsOf("wall", none).empty()) << none;
}

TEST(ToldEventsTest, AnEventThatComesTwiceIsToldOnce) {
  ToldEvents told;
  EXPECT_TRUE(told.take(event("ball: absent (unplugged)"), false));
  EXPECT_FALSE(told.take(event("ball: absent (unplugged)"), false));
  AlarmEvent again = event("ball: absent (unplugged)");
  again.time_utc = "2026-11-25T12:00:00.000001Z";
  EXPECT_TRUE(told.take(again, false)) << "at another time it is another one";
  AlarmEvent of_wall = again;
  of_wall.role = "wall";
  EXPECT_TRUE(told.take(of_wall, false));
  for (std::size_t i = 0; i < ToldEvents::kKept; ++i)
    EXPECT_TRUE(told.take(event(std::to_string(i), "wall"), false));
  EXPECT_TRUE(told.take(again, false)) << "it does not remember for ever";
}

TEST(ToldEventsTest, ThatADeviceWorksIsToldAfterSomethingElseOfIt) {
  ToldEvents told;
  const auto at = [&](const std::string& time, const std::string& what, bool works) {
    return told.take({"devices", time, "device", what}, works);
  };
  EXPECT_FALSE(at("1", "ball: ok (Spaceball)", true)) << "as at every start";
  EXPECT_TRUE(at("2", "glove: ok (no key x)", false)) << "it complains";
  EXPECT_TRUE(at("3", "ball: absent (unplugged)", false));
  EXPECT_TRUE(at("4", "ball: ok (Spaceball)", true)) << "it is back";
  EXPECT_FALSE(at("5", "ball: ok (Spaceball)", true));
}

}  // namespace
}  // namespace merlin::alarms
