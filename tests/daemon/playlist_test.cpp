// A day of a wall, in seconds of a virtual clock: when people touch the wall, and what it shows.
#include "daemon/wall/playlist.h"

#include <array>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "daemon/wall/attendance.h"
#include "daemon/wall/wall_checks.h"

namespace merlin::wall {
namespace {

using std::chrono::seconds;

constexpr float kSixDegrees = 0.104720F;

// The playlist begins after 5 minutes, shows each content for 2 hours, and dims the wall after 4
// hours.
PlaylistSettings settings() {
  PlaylistSettings s;
  s.after_s = 300;
  s.hold_s = 7200;
  s.dim_after_s = 14'400;
  s.dim_to = 0.25;
  return s;
}

constexpr int at(int hour, int minute) { return 60 * (60 * hour + minute); }

class Day : public testing::Test {
 protected:
  // Commands by the second of the day in which they are sent. `pushed`: returns whether somebody
  // pushes the ball in that second.
  using Act = std::function<void(Attendance&)>;
  std::map<int, Act> commands;
  std::function<bool(int)> pushed = [](int) { return false; };
  // number of fingers on a touch surface
  std::function<std::uint32_t(int)> fingers = [](int) { return 0U; };

  // Runs the day; returns each change as "HH:MM:SS CHANGE".
  std::vector<std::string> run(const PlaylistSettings& playlist, int until = at(24, 0)) {
    Attendance attendance(playlist);
    std::vector<std::string> table;
    Seen before;
    for (int second = 0; second < until; ++second) {
      if (const auto found = commands.find(second); found != commands.end())
        found->second(attendance);
      WallInput input;
      input.scene.ball.emplace();
      input.scene.ball->rotation[1] = pushed(second) ? 0.5F : 0.0F;
      input.scene.touch.fingers = fingers(second);
      const auto frame = attendance.update(input, Timestamp(seconds(100 + second)));
      const Seen now = seen(attendance, frame, input);
      for (const std::string& what : changes(before, now)) {
        table.push_back(fmt::format("{:02}:{:02}:{:02} {}", second / 3600, second / 60 % 60,
                                    second % 60, what));
      }
      before = now;
    }
    return table;
  }

 private:
  struct Seen {
    Attendance::Shown shown = Attendance::Shown::kPicture;
    bool running = false, next = false, turns = false;
    float light = 1;
  };
  static Seen seen(const Attendance& attendance, const Attendance::Frame& frame,
                   const WallInput& input) {
    EXPECT_EQ(frame.held, attendance.shown() != Attendance::Shown::kPicture);
    EXPECT_TRUE(!frame.held || !input.scene.ball) << "held, nothing moves the scene";
    EXPECT_TRUE(input.scene.turn_rad_s == 0 ||
                std::abs(input.scene.turn_rad_s - kSixDegrees) < 1e-5);
    return {attendance.shown(), attendance.playlist() == Playlist::State::kRunning,
            frame.playlist.next, input.scene.turn_rad_s != 0, frame.playlist.light};
  }
  static std::vector<std::string> changes(const Seen& before, const Seen& now) {
    constexpr const char* kShown[] = {"the picture", "black", "frozen"};
    std::vector<std::string> what;
    if (now.shown != before.shown) what.emplace_back(kShown[static_cast<int>(now.shown)]);
    if (now.running != before.running) what.emplace_back(now.running ? "begins" : "ends");
    if (now.turns != before.turns) what.emplace_back(now.turns ? "turns" : "stands");
    if (now.next) what.emplace_back("next");
    const bool settled = now.light == 0 || now.light == 0.25F || now.light == 1;
    if (now.light != before.light && settled) what.push_back(fmt::format("light {}", now.light));
    return what;
  }
};

TEST_F(Day, WithVisitorsAnOperatorAndNights) {
  pushed = [](int s) { return (s >= at(9, 0) && s < at(9, 20)) || s == at(15, 30); };
  commands[at(12, 0)] = [](Attendance& a) { a.toggleBlank(); };
  commands[at(13, 0)] = [](Attendance& a) { a.toggleBlank(); };
  commands[at(15, 0)] = [](Attendance& a) { a.toggleFreeze(); };
  commands[at(16, 0)] = [](Attendance& a) { a.switchPlaylist(false); };
  commands[at(20, 0)] = [](Attendance& a) { a.switchPlaylist(true); };
  commands[at(23, 0)] = [](Attendance& a) { a.nextOfPlaylist(); };
  const std::vector<std::string> expected = {
      "00:05:00 begins",       // nobody came
      "00:05:00 turns",        //
      "02:05:00 next",         //
      "04:00:03 light 0.25",   // three seconds after the light began to fall
      "04:05:00 next",         //
      "06:05:00 next",         //
      "08:05:00 next",         //
      "09:00:00 ends",         // a visitor, for 20 minutes
      "09:00:00 stands",       //
      "09:00:00 light 1",      //
      "09:24:59 begins",       // the playlist returns 5 minutes after the last touch
      "09:24:59 turns",        //
      "11:24:59 next",         //
      "12:00:00 black",        // the operator
      "12:00:00 stands",       //
      "12:00:00 light 0",      //
      "13:00:00 the picture",  // the operator again: the picture goes on
      "13:00:00 turns",        //
      "13:00:00 light 1",      //
      "14:20:02 light 0.25",   // 4 hours after the last touch, not counting the black time
      "14:24:59 next",         // likewise
      "15:00:00 frozen",       //
      "15:00:00 stands",       //
      "15:30:00 the picture",  // a visitor
      "15:30:00 ends",         //
      "15:30:00 light 1",      //
      "15:35:00 begins",       //
      "15:35:00 turns",        //
      "16:00:00 ends",         // switched off: the playlist does not return
      "16:00:00 stands",       //
      "20:00:00 begins",       // at once
      "20:00:00 turns",        //
      "22:00:00 next",         //
      "23:00:00 next",         // requested by command
  };
  EXPECT_EQ(run(settings()), expected);
}

TEST_F(Day, WithoutAPlaylistNothingHappens) { EXPECT_TRUE(run({}).empty()); }

TEST_F(Day, AnObjectThatStandsOnATouchSurfaceKeepsNothingAway) {
  fingers = [](int s) { return s >= 60 ? 1U : 0U; };
  PlaylistSettings s = settings();
  s.dim_after_s = 600;
  EXPECT_EQ(run(s, at(1, 0)),
            (std::vector<std::string>{"00:06:00 begins", "00:06:00 turns", "00:11:03 light 0.25"}));
}

TEST_F(Day, ThePictureIsDimmedWithoutAPlaylistToo) {
  PlaylistSettings s = settings();
  s.after_s = 0;
  pushed = [](int second) { return second == at(10, 0); };
  EXPECT_EQ(run(s), (std::vector<std::string>{"04:00:03 light 0.25", "10:00:00 light 1",
                                              "14:00:03 light 0.25"}));
}

TEST_F(Day, APlaylistThatOnlyACommandBeginsComesBackByCommandAlone) {
  PlaylistSettings s;
  commands[60] = [](Attendance& a) { a.switchPlaylist(true); };
  pushed = [](int second) { return second == 100; };
  EXPECT_EQ(run(s), (std::vector<std::string>{"00:01:00 begins", "00:01:00 turns", "00:01:40 ends",
                                              "00:01:40 stands"}));
}

TEST_F(Day, APlaylistWaitsWhileATestCardIsShown) {
  for (int second = 0; second < at(1, 0); ++second)
    commands[second] = [](Attendance& a) { a.attend(); };
  EXPECT_EQ(run(settings(), at(2, 0)),
            (std::vector<std::string>{"01:04:59 begins", "01:04:59 turns"}));
}

TEST_F(Day, NextIsShownWithoutAPlaylistToo) {
  commands[60] = [](Attendance& a) { a.nextOfPlaylist(); };
  EXPECT_EQ(run({}), std::vector<std::string>{"00:01:00 next"});
}

TEST_F(Day, AMachineThatSleptShowsOneContentMore) {
  Playlist playlist(settings());
  playlist.on();
  EXPECT_TRUE(playlist.update(seconds(1), false).begins);
  EXPECT_TRUE(playlist.update(seconds(100'000), false).next);
  EXPECT_FALSE(playlist.update(seconds(1), false).next);
}

TEST_F(Day, ThePlaylistSaysWhatComesNextAndWhen) {
  const auto due = [](const Playlist& p) {
    const Playlist::Due d = p.due();
    return std::array{d.begins_s, d.next_s, d.dims_s};
  };
  Playlist playlist(settings());
  EXPECT_EQ(due(playlist), (std::array{300.0, -1.0, 14'400.0}));
  playlist.update(seconds(100), false);
  EXPECT_EQ(due(playlist), (std::array{200.0, -1.0, 14'300.0}));
  playlist.update(seconds(200), false);
  EXPECT_EQ(due(playlist), (std::array{-1.0, 7200.0, 14'100.0})) << "it has begun";
  playlist.update(seconds(200), false);
  EXPECT_EQ(due(playlist), (std::array{-1.0, 7000.0, 13'900.0}));
  playlist.update(seconds(1), true);
  EXPECT_EQ(due(playlist), (std::array{300.0, -1.0, 14'400.0})) << "a touch";
  playlist.off();
  EXPECT_EQ(due(playlist), (std::array{-1.0, -1.0, -1.0}));
  EXPECT_EQ(due(Playlist({})), (std::array{-1.0, -1.0, -1.0})) << "without settings";
}

std::string findings(const std::string& names) {
  LoadedSettings loaded = loadSettings(
      R"({"wall": {"model": "bone.mrm", "contents": [{"slides": "talk"}, {"picture": "a.tif",
          "name": "hall"}], "playlist": {"contents": [)" +
          names + "]}}}",
      "");
  checkPlaylist(loaded);
  std::string text;
  for (const Finding& finding : loaded.findings) text += toText("f.json", finding) + "\n";
  return text;
}

TEST(PlaylistCheck, NamesAreThoseOfContentsOnceEach) {
  EXPECT_EQ(findings(R"("hall", "talk", "bone")"), "");
  EXPECT_EQ(findings(R"("hall", "attic")"),
            "f.json:2: /wall/playlist/contents/1 is \"attic\", which is not the name of a content; "
            "contents are bone, talk, hall\n");
  EXPECT_EQ(findings(R"("hall", "talk", "hall")"),
            "f.json:2: /wall/playlist/contents/2 is \"hall\", which is already in the list\n");
  EXPECT_EQ(findings(R"("attic", 7)"),
            "f.json:2: /wall/playlist/contents/1 is the number 7; allowed is a string\n");
}

std::string nameFindings(const std::string& wall) {
  LoadedSettings loaded = loadSettings("{\"wall\": {" + wall + "}}", "");
  checkPlaylist(loaded);
  std::string text;
  for (const Finding& finding : loaded.findings) text += toText("f.json", finding) + "\n";
  return text;
}

// If two contents had one name, commands and playlists would find only the first.
TEST(ContentNames, ThoseOfFilesAreComparedToo) {
  EXPECT_EQ(
      nameFindings(R"("contents": [{"model": "bust.mrm"}, {"picture": "bust.tif"}])"),
      "f.json:1: /wall/contents/1 has the name \"bust\", as /wall/contents/0 has; give one of "
      "them another name\n");
  EXPECT_EQ(
      nameFindings(R"("contents": [{"picture": "a/hall.tif"}, {"slides": "b/hall/"}])"),
      "f.json:1: /wall/contents/1 has the name \"hall\", as /wall/contents/0 has; give one of "
      "them another name\n");
  EXPECT_EQ(
      nameFindings(R"("model": "bust.mrm", "contents": [{"model": "x.mrm", "name": "bust"}])"),
      "f.json:1: /wall/contents/0 has the name \"bust\", as /wall/model has; give one of them "
      "another name\n");
  EXPECT_EQ(
      nameFindings(R"("model": "bust.mrm", "contents": [{"model": "bust.mrm", "name": "again"},
                           {"picture": "again.tif", "name": "bust.tif"}])"),
      "");
  EXPECT_EQ(nameFindings(R"("contents": [{"model": "a.mrm", "name": "x"},
                           {"model": "b.mrm", "name": "x"}])"),
            "f.json:2: /wall/contents/1/name is \"x\", the name of another content; give each its "
            "own name\n")
      << "said once";
}

TEST_F(Day, ThePictureGetsDarkerGradually) {
  Playlist playlist(settings());
  EXPECT_EQ(playlist.update(seconds(14'400), false).light, 1);
  EXPECT_FLOAT_EQ(playlist.update(seconds(1), false).light, 0.75F);
  EXPECT_FLOAT_EQ(playlist.update(seconds(1), false).light, 0.5F);
  EXPECT_EQ(playlist.update(seconds(1), true).light, 1) << "bright again at once";
}

}  // namespace
}  // namespace merlin::wall
