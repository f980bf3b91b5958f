// A day of a wall on a virtual clock, with the classes that merlind runs: visitors and an operator,
// the playlist, the projectors' schedule, PJLink, and two restarts. The table lists what happened
// and when.
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/devices/projectors.h"
#include "daemon/state/state.h"
#include "daemon/wall/attendance.h"
#include "drivers/gpio/panel.h"
#include "tests/support/emulated_connection.h"

namespace merlin {
namespace {

using std::chrono::seconds;
using test::EmulatedProjector;

constexpr pjlink::LocalMinute kMonday = 20605 * 24 * 60;  // 2026-06-01 00:00

constexpr int at(int hour, int minute) { return 60 * (60 * hour + minute); }

// A clock that performs the acts of each second, whoever advances it. A projector that answers
// slowly therefore delays nothing else, as in merlind, where each projector has its own thread.
class DayClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return now_; }
  bool sleepUntil(Timestamp when, const std::stop_token&) noexcept override {
    advance(when - now_);
    return true;
  }
  void advance(Duration by) {
    const Timestamp end = now_ + by;
    for (; next_ <= end; next_ += seconds(1)) {
      now_ = next_;
      each_second();
    }
    now_ = end;
  }
  // Returns the seconds since the day's midnight.
  int second() const {
    return static_cast<int>(std::chrono::duration_cast<seconds>(now_ - kMidnight).count());
  }
  std::function<void()> each_second = [] {};

 private:
  static constexpr Timestamp kMidnight{seconds(1000)};
  Timestamp now_ = kMidnight, next_ = kMidnight + seconds(1);
};

using Connection = test::EmulatedConnection<DayClock>;

// The connection of one projector.
struct Link {
  EmulatedProjector device;
  Duration answer_time{};
  bool gone = false;
};

class Day : public testing::Test {
 protected:
  // Adds an act at a second of the day, and its row in the report.
  void when(int second, const std::string& row, std::function<void()> act) {
    acts_.insert({second, {row, std::move(act)}});
  }
  void visit(int from, int until) {
    for (int second = from; second < until; ++second) pushed_.insert(second);
  }
  void switchAll(bool on) {
    const auto done = projectors_->switchAll(on);
    say(done ? "  done" : "  " + done.error().what);
  }
  void switchPlaylist(bool on) {
    attendance_->switchPlaylist(on);
    kept_.playlist_off = !on;
  }

  std::string run() {
    start();
    clock_.each_second = [this] { second(); };
    while (clock_.second() < at(24, 0)) {
      projectors_->round();
      clock_.advance(seconds(1));
      if (restart_at_.erase(clock_.second()) > 0) restart();
    }
    return table_;
  }
  void restartAt(int hour, int minute) { restart_at_.insert(at(hour, minute)); }

  Link left_, middle_, right_;
  std::optional<wall::Attendance> attendance_;
  std::optional<devices::Projectors> projectors_;
  state::State kept_;

 private:
  struct Seen {
    wall::Attendance::Shown shown = wall::Attendance::Shown::kPicture;
    bool running = false;
    float light = 1;
    std::uint32_t panel = 0;
  };

  void start() {
    PlaylistSettings playlist;
    playlist.after_s = 300;
    playlist.hold_s = 7200;
    playlist.dim_after_s = 14'400;
    playlist.dim_to = 0.25;
    attendance_.emplace(playlist);
    if (kept_.playlist_off) attendance_->switchPlaylist(false);
    panel_.emplace(GpioSettings{.chip = "gpiochip0", .projector_line = 0}, clock_.now());
    DevicesSettings devices;
    devices.projectors = {{.name = "left", .address = "10.0.0.7"},
                          {.name = "middle", .address = "10.0.0.8"},
                          {.name = "right", .address = "10.0.0.9"}};
    devices.projector_schedule = {{{"mon"}, "09:00", "18:00"}};
    projectors_.emplace(devices, parts());
    std::optional<devices::PersonsSwitch> last;
    if (kept_.projectors) last = {kept_.projectors->on, kept_.projectors->local_minute};
    projectors_->remember(last, [this](const devices::PersonsSwitch& person) {
      kept_.projectors = {person.on, person.at};
    });
  }
  // Simulates a restart: the settings that people changed are restored from the text of the state
  // file.
  void restart() {
    say("merlind is restarted");
    const auto read = state::parseState(state::stateText(kept_), "state");
    ASSERT_TRUE(read) << read.error().what;
    kept_ = *read;
    seen_ = {};
    start();
  }
  devices::Projectors::Parts parts() {
    return {[this](const std::string& command) { return panel_->execute(command, clock_.now()); },
            [this](const TcpAddress& to) { return connect(to); },
            [this] { return kMonday + clock_.second() / 60; }, clock_};
  }
  Result<std::unique_ptr<ByteStream>> connect(const TcpAddress& to) {
    Link& link = to.host == "10.0.0.7" ? left_ : to.host == "10.0.0.8" ? middle_ : right_;
    if (link.gone) return Error{Errc::kTimeout, "Connection timed out"};
    return std::unique_ptr<ByteStream>(
        std::make_unique<Connection>(link.device, clock_, link.answer_time));
  }

  void second() {
    const auto [first, last] = acts_.equal_range(clock_.second());
    for (auto act = first; act != last; ++act) {
      say(act->second.first);
      act->second.second();
    }
    panel_->step(false, clock_.now());
    projectors_->tend();
    for (const Event& event : projectors_->takeEvents()) say("  " + event.what);
    wall::WallInput input;
    input.scene.ball.emplace();
    input.scene.ball->rotation[1] = pushed_.contains(clock_.second()) ? 0.5F : 0.0F;
    const auto frame = attendance_->update(input, clock_.now());
    sayChanges(frame.playlist.next,
               {attendance_->shown(), attendance_->playlist() == wall::Playlist::State::kRunning,
                attendance_->light(), panel_->sample(clock_.now()).power});
  }
  void sayChanges(bool next, const Seen& now) {
    constexpr const char* kShown[] = {"the picture", "black", "frozen"};
    constexpr const char* kPowers[] = {"off", "warming", "on", "cooling"};
    if (now.shown != seen_.shown)
      say(fmt::format("  wall: {}", kShown[static_cast<int>(now.shown)]));
    if (now.running != seen_.running)
      say(fmt::format("  playlist {}", now.running ? "begins" : "ends"));
    if (next) say("  playlist: the next content");
    const bool settled = now.light == 0 || now.light == 0.25F || now.light == 1;
    if (settled && now.light != seen_.light) say(fmt::format("  light {}", now.light));
    if (now.panel != seen_.panel) say(fmt::format("  panel: {}", kPowers[now.panel]));
    const float light = settled ? now.light : seen_.light;
    seen_ = now;
    seen_.light = light;
  }
  void say(const std::string& what) {
    const int s = clock_.second();
    table_ += fmt::format("{:02}:{:02}:{:02} {}\n", s / 3600, s / 60 % 60, s % 60, what);
  }

  DayClock clock_;
  std::multimap<int, std::pair<std::string, std::function<void()>>> acts_;
  std::set<int> pushed_, restart_at_;
  std::optional<gpio::Panel> panel_;
  Seen seen_;
  std::string table_ = "\n";
};

TEST_F(Day, OfVisitorsAnOperatorProjectorsAndTwoRestarts) {
  when(at(8, 55), "the middle projector answers after 2 s, the right one refuses", [this] {
    middle_.answer_time = seconds(2);
    right_.device.refusal = "ERR3";
  });
  when(at(9, 2), "the right one obeys again", [this] { right_.device.refusal.clear(); });
  when(at(9, 10), "the middle one answers at once", [this] { middle_.answer_time = {}; });
  visit(at(9, 30), at(9, 50));
  when(at(11, 0), "blank", [this] { attendance_->toggleBlank(); });
  when(at(11, 30), "blank", [this] { attendance_->toggleBlank(); });
  when(at(12, 0), "freeze", [this] { attendance_->toggleFreeze(); });
  visit(at(12, 15), at(12, 15) + 1);
  when(at(13, 0), "the left projector vanishes, the middle one answers after 9 s", [this] {
    left_.gone = true;
    middle_.answer_time = seconds(9);
  });
  when(at(13, 5), "projector_off", [this] { switchAll(false); });
  when(at(13, 10), "both are there again", [this] {
    left_.gone = false;
    middle_.answer_time = {};
  });
  when(at(13, 12), "projector_on", [this] { switchAll(true); });
  when(at(15, 0), "projector_off", [this] { switchAll(false); });
  when(at(15, 10), "playlist off", [this] { switchPlaylist(false); });
  restartAt(15, 30);
  when(at(16, 30), "playlist on", [this] { switchPlaylist(true); });
  visit(at(17, 0), at(17, 10));
  when(at(19, 0), "projector_on", [this] { switchAll(true); });
  restartAt(20, 0);
  when(at(22, 0), "projector_off", [this] { switchAll(false); });
  EXPECT_EQ(run(), R"(
00:00:01   projectors: switched off by the schedule
00:00:01   projector left: off, ok
00:00:01   projector middle: off, ok
00:00:01   projector right: off, ok
00:05:01   playlist begins
02:05:01   playlist: the next content
04:00:04   light 0.25
04:05:01   playlist: the next content
06:05:01   playlist: the next content
08:05:01   playlist: the next content
08:55:00 the middle projector answers after 2 s, the right one refuses
09:00:00   projectors: switched on by the schedule
09:00:00   panel: warming
09:00:07   projector right: off, refused (refuses to be switched on (ERR3, not available at this time); it is tried again)
09:00:08   projector left: warming, ok
09:00:13   projector middle: warming, ok
09:00:30   panel: on
09:00:34   projector left: on, ok
09:00:39   projector middle: on, ok
09:02:00 the right one obeys again
09:02:01   projector right: off, failed (is still off though it was to be on by now; refuses to be switched on (ERR3, not available at this time); it is tried again)
09:02:05   projector right: off, failed (is still off though it was to be on by now)
09:02:07   projector right: warming, failed (is still warming though it was to be on by now)
09:02:39   projector right: on, ok
09:10:00 the middle one answers at once
09:30:00   playlist ends
09:30:00   light 1
09:54:59   playlist begins
11:00:00 blank
11:00:00   wall: black
11:00:00   light 0
11:30:00 blank
11:30:00   wall: the picture
11:30:00   light 1
12:00:00 freeze
12:00:00   wall: frozen
12:15:00   wall: the picture
12:15:00   playlist ends
12:20:00   playlist begins
13:00:00 the left projector vanishes, the middle one answers after 9 s
13:00:01   projector left: unknown, unreachable (Connection timed out)
13:00:14   projector middle: unknown, unreachable (does not answer within 5 s)
13:05:00 projector_off
13:05:00   left: Connection timed out; it is switched off when it answers; middle: does not answer within 5 s; it is switched off when it answers
13:05:00   panel: cooling
13:05:06   projector right: cooling, ok
13:06:30   panel: off
13:06:34   projector right: off, ok
13:10:00 both are there again
13:10:05   projector left: on, ok
13:10:07   projector left: cooling, ok
13:10:09   projector middle: on, ok
13:10:11   projector middle: cooling, ok
13:11:35   projector left: off, ok
13:11:39   projector middle: off, ok
13:12:00 projector_on
13:12:00   done
13:12:00   panel: warming
13:12:03   projector left: warming, ok
13:12:03   projector middle: warming, ok
13:12:03   projector right: warming, ok
13:12:30   panel: on
13:12:31   projector left: on, ok
13:12:31   projector middle: on, ok
13:12:31   projector right: on, ok
14:20:00   playlist: the next content
15:00:00 projector_off
15:00:00   done
15:00:00   panel: cooling
15:00:03   projector left: cooling, ok
15:00:03   projector middle: cooling, ok
15:00:03   projector right: cooling, ok
15:01:30   panel: off
15:01:31   projector left: off, ok
15:01:31   projector middle: off, ok
15:01:31   projector right: off, ok
15:10:00 playlist off
15:10:00   playlist ends
15:30:00 merlind is restarted
15:30:01   projectors: switched off again, as by a person before
15:30:01   projector left: off, ok
15:30:01   projector middle: off, ok
15:30:01   projector right: off, ok
16:30:00 playlist on
16:30:00   playlist begins
17:00:00   playlist ends
17:14:59   playlist begins
18:00:00   projectors: switched off by the schedule
19:00:00 projector_on
19:00:00   done
19:00:00   panel: warming
19:00:03   projector left: warming, ok
19:00:03   projector middle: warming, ok
19:00:03   projector right: warming, ok
19:00:30   panel: on
19:00:31   projector left: on, ok
19:00:31   projector middle: on, ok
19:00:31   projector right: on, ok
19:14:59   playlist: the next content
20:00:00 merlind is restarted
20:00:01   projectors: switched on again, as by a person before
20:00:01   projector left: on, ok
20:00:01   projector middle: on, ok
20:00:01   projector right: on, ok
20:00:05   panel: warming
20:00:35   panel: on
20:05:01   playlist begins
22:00:00 projector_off
22:00:00   done
22:00:00   panel: cooling
22:00:03   projector left: cooling, ok
22:00:03   projector middle: cooling, ok
22:00:03   projector right: cooling, ok
22:01:30   panel: off
22:01:31   projector left: off, ok
22:01:31   projector middle: off, ok
22:01:31   projector right: off, ok
22:05:01   playlist: the next content
)");
}

}  // namespace
}  // namespace merlin
