// merlin watch on a real terminal: the table, its keys, a change of the terminal's size, and a
// daemon that is restarted.
#include <gtest/gtest.h>

#include "tests/support/pty_process.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class Watch : public testing::Test {
 protected:
  void start() {
    daemon_.reset();  // frees the daemon's addresses before the next start
    daemon_ =
        std::make_unique<Merlind>(dir_, model_, "watched", MerlindOptions{.script = "turning"});
    ASSERT_TRUE(daemon_->ready()) << daemon_->process().output();
  }
  TempDir dir_;
  std::string model_ = makeModel(dir_, 5);
  std::unique_ptr<Merlind> daemon_;
};

TEST_F(Watch, ShowsTheStateOnATerminalUntilQ) {
  start();
  PtyProcess watch({kMerlin, "watch", "--instance", daemon_->instance()}, 40, 100);
  EXPECT_TRUE(watch.showsEventually("of 10 Hz, moving")) << watch.screen().text();
  for (const char* part :
       {"merlin watch: ", "q quits", "late ", "triangles, step", "model (model)", "glove", "Hz  ",
        "ball", "tracker", "shared_memory", "last events", "frame times of the last minute", " ms"})
    EXPECT_TRUE(watch.showsEventually(part)) << part << "\n" << watch.screen().text();
  EXPECT_TRUE(watch.showsEventually("\xE2\x96")) << "bars\n" << watch.screen().text();
  watch.type("q");
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_NE(watch.output().find("\x1b[?1049l"), std::string::npos) << "the old screen is back";
}

TEST_F(Watch, FollowsTheTerminalsSize) {
  start();
  PtyProcess watch({kMerlin, "watch", "--instance", daemon_->instance()}, 40, 100);
  ASSERT_TRUE(watch.showsEventually("last events")) << watch.screen().text();
  watch.resize(6, 60);
  EXPECT_TRUE(watch.showsEventually(" more rows: make the terminal taller"))
      << watch.screen().text();
  watch.resize(50, 120);
  EXPECT_TRUE(watch.showsEventually("last events")) << watch.screen().text();
  ::kill(watch.pid(), SIGTERM);
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_NE(watch.output().find("\x1b[?1049l"), std::string::npos) << "the old screen is back";
}

TEST_F(Watch, SurvivesTheDaemonsRestart) {
  const std::string instance = privateName("watched");
  PtyProcess watch({kMerlin, "watch", "--instance", instance}, 40, 100);
  EXPECT_TRUE(watch.showsEventually("no merlind runs as")) << watch.screen().text();
  for (int times = 0; times < 2; ++times) {
    start();
    ASSERT_EQ(daemon_->instance(), instance);
    EXPECT_TRUE(watch.showsEventually("of 10 Hz, moving")) << watch.screen().text();
    EXPECT_TRUE(eventually([&] { return !watch.screen().shows("no merlind"); }))
        << watch.screen().text();
    EXPECT_EQ(daemon_->process().kill(times == 0 ? SIGTERM : SIGKILL), times == 0 ? 0 : 137);
    EXPECT_TRUE(watch.showsEventually("no merlind runs as")) << watch.screen().text();
    EXPECT_TRUE(watch.screen().shows("of 10 Hz")) << "the last state stays";
  }
  watch.type("\x03");  // Ctrl-C
  EXPECT_EQ(watch.wait(), 0);
}

TEST_F(Watch, SaysThatARoleWasKilled) {
  Merlind devices(dir_, model_, "half", MerlindOptions{.role = "devices", .emulate = true});
  ASSERT_TRUE(devices.ready()) << devices.process().output();
  {
    Merlind wall(dir_, model_, "half", MerlindOptions{.role = "wall"});
    ASSERT_TRUE(wall.ready()) << wall.process().output();
    wall.process().kill(SIGKILL);
    PtyProcess watch({kMerlin, "watch", "--instance", devices.instance()}, 40, 100);
    EXPECT_TRUE(watch.showsEventually("wall      does not run; it ended "))
        << watch.screen().text();
    EXPECT_TRUE(watch.screen().shows("ball")) << "the devices have their rows";
  }
}

TEST_F(Watch, LinesStayWhereTheyAreAskedForOrTheTerminalCannotPlaceText) {
  start();
  // A status document is published once a second, on a busy machine less often.
  const std::vector<std::string> words = {kMerlin, "watch",      "--for",
                                          "8",     "--instance", daemon_->instance()};
  auto lines = words, json = words;
  lines.emplace_back("--lines");
  json.emplace_back("--json");
  PtyProcess asked(lines, 40, 200), dumb(words, 40, 200, {{"TERM", "dumb"}}), text(json, 40, 2000);
  for (PtyProcess* process : {&asked, &dumb, &text}) {
    EXPECT_EQ(process->wait(), 0);
    EXPECT_EQ(process->output().find('\x1b'), std::string::npos) << process->output();
  }
  EXPECT_NE(asked.output().find("of 10 Hz"), std::string::npos) << asked.output();
  EXPECT_TRUE(text.output().starts_with("{")) << text.output();
  PtyProcess strange(words, 40, 100, {{"TERM", "no-such-terminal"}});
  EXPECT_NE(strange.wait(), 0);
  EXPECT_NE(strange.output().find("use merlin watch --lines, which works on any terminal"),
            std::string::npos)
      << strange.output();
}

}  // namespace
}  // namespace merlin::test
