// What an output of kind window does without a desktop: its settings, its geometry, the commands
// from mouse and keys, and the link to programs that take the place of merlin-window.
#include "render/out/window/window_link.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "render/out/window/fit.h"
#include "render/out/window/window_commands.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::render::out {
namespace {

using Strings = std::vector<std::string>;
using Drag = WindowCommands::Drag;

TEST(WindowFit, KeepsTheProportionsAndLiesInTheMiddle) {
  EXPECT_EQ(fit({640, 480}, {640, 480}, true), (PixelRectangle{0, 0, 640, 480}));
  EXPECT_EQ(fit({640, 480}, {300, 300}, true), (PixelRectangle{0, 37, 300, 225}));
  EXPECT_EQ(fit({640, 480}, {1920, 1080}, true), (PixelRectangle{240, 0, 1440, 1080}));
  EXPECT_EQ(fit({1920, 480}, {1280, 720}, true), (PixelRectangle{0, 200, 1280, 320}));
  EXPECT_EQ(fit({3, 2}, {2, 2}, true), (PixelRectangle{0, 0, 2, 1})) << "4/3 rows, rounded";
  EXPECT_EQ(fit({32768, 1}, {10, 10}, true), (PixelRectangle{0, 4, 10, 1})) << "at least one row";
}

TEST(WindowFit, UnscaledItMayBeCutOff) {
  EXPECT_EQ(fit({640, 480}, {1920, 1080}, false), (PixelRectangle{640, 300, 640, 480}));
  EXPECT_EQ(fit({640, 480}, {600, 500}, false), (PixelRectangle{-20, 10, 640, 480}));
}

TEST(WindowSettings, FaultsNameTheirSetting) {
  const auto pointers = [](const WindowSettings& w) {
    Strings all;
    for (const SettingFault& fault : validate(w)) all.push_back(fault.pointer);
    return all;
  };
  EXPECT_EQ(pointers({}), Strings{});
  EXPECT_EQ(pointers({.x = 5, .y = 0, .width = 100, .height = 80, .border = false}), Strings{});
  EXPECT_EQ(pointers({.title = std::string(127, 'a')}), Strings{});
  EXPECT_EQ(pointers({.title = std::string(128, 'a')}), Strings{"/title"});
  EXPECT_EQ(pointers({.width = 100}), Strings{"/height"});
  EXPECT_EQ(pointers({.height = 100}), Strings{"/width"});
  EXPECT_EQ(pointers({.fullscreen = true}), Strings{});
  EXPECT_EQ(
      pointers({.x = 5, .y = 0, .width = 9, .height = 9, .fullscreen = true, .border = false}),
      (Strings{"/x", "/y", "/width", "/height", "/border"}));
}

Strings pressed(const PressedKey& key) {
  WindowCommands commands;
  commands.press(key);
  return commands.take();
}

TEST(WindowCommands, AKeyIsACommandAndWithCtrlOneOfTheAlignment) {
  WindowCommands commands;
  for (const char* key : {"Home", "M", "F5", "U", "T"}) commands.press({key});
  EXPECT_EQ(commands.take(), (Strings{"reset_view", "next_mode", "next_testcard"}));
  EXPECT_EQ(commands.take(), Strings{});
  for (const char* key : {"PageUp", "P", "PageDown"}) commands.press({key});
  EXPECT_EQ(commands.take(), (Strings{"previous_content", "previous_content", "next_content"}));
  for (const char* key : {"Left", "H", "Tab", "R", "M"})
    commands.press({.name = key, .ctrl = true});
  EXPECT_EQ(commands.take(),
            (Strings{"align_left", "align_left", "align_corner_next", "align_redo"}));
}

TEST(WindowCommands, ArrowsTurnAndWithShiftTheyShift) {
  EXPECT_EQ(pressed({"Right"}), Strings{"move 0.0000 0.0000 0.0000 0.000 5.000 0"});
  EXPECT_EQ(pressed({"Up"}), Strings{"move 0.0000 0.0000 0.0000 -5.000 0.000 0"});
  EXPECT_EQ(pressed({.name = "Left", .shift = true}),
            Strings{"move -0.0500 0.0000 0.0000 0.000 0.000 0"});
  EXPECT_EQ(pressed({.name = "Down", .shift = true}),
            Strings{"move 0.0000 -0.0500 0.0000 0.000 0.000 0"});
  EXPECT_EQ(pressed({"="}), Strings{"move 0.0000 0.0000 0.1000 0.000 0.000 0"});
  EXPECT_EQ(pressed({"Keypad -"}), Strings{"move 0.0000 0.0000 -0.1000 0.000 0.000 0"});
}

TEST(WindowCommands, AHeldKeyRepeatsMotionsOnly) {
  EXPECT_EQ(pressed({.name = "M", .repeats = true}), Strings{});
  EXPECT_EQ(pressed({.name = "U", .ctrl = true, .repeats = true}), Strings{});
  EXPECT_EQ(pressed({.name = "J", .ctrl = true, .repeats = true}), Strings{"align_down"});
  EXPECT_EQ(pressed({.name = "Right", .repeats = true}).size(), 1u);
}

// A drag over the window's whole height turns by half a turn: a drag to the right about y, a drag
// down about x.
TEST(WindowCommands, MotionsAddUpToOneCommand) {
  WindowCommands commands;
  commands.drag(Drag::kTurn, 10, 0, 360);
  commands.drag(Drag::kTurn, 80, -30, 360);
  EXPECT_EQ(commands.take(), Strings{"move 0.0000 0.0000 0.0000 -15.000 45.000 0"});
  commands.drag(Drag::kShift, 90, 45, 360);
  commands.wheel(2);
  EXPECT_EQ(commands.take(), Strings{"move 0.3750 -0.1875 0.2000 0.000 0.000 0"});
  commands.drag(Drag::kTurn, 10, 0, 360);
  commands.drag(Drag::kTurn, -10, 0, 360);
  EXPECT_EQ(commands.take(), Strings{}) << "it is back where it began";
}

// The sum of motions is limited to what one command may have, so that `move` never refuses it.
TEST(WindowCommands, NoMotionIsLargerThanOneCommandMayBe) {
  WindowCommands commands;
  commands.drag(Drag::kTurn, 1e6, -1e6, 0);
  commands.drag(Drag::kShift, 1e6, 1e6, 10);
  commands.wheel(-1e6);
  EXPECT_EQ(commands.take(), Strings{"move 10.0000 -10.0000 -10.0000 -360.000 360.000 0"});
}

TEST(PictureSlots, AReaderSeesWhatTheWriterWrites) {
  auto written = PictureSlots::make(5, 3);
  ASSERT_TRUE(written) << written.error().what;
  const auto read = PictureSlots::open(UniqueFd(::dup(written->fd())), 5, 3);
  ASSERT_TRUE(read) << read.error().what;
  for (std::uint32_t i = 0; i < PictureSlots::kCount; ++i) {
    ASSERT_EQ(written->slot(i).size(), 60u);
    std::fill(written->slot(i).begin(), written->slot(i).end(), static_cast<std::uint8_t>(i + 1));
  }
  for (std::uint32_t i = 0; i < PictureSlots::kCount; ++i) {
    EXPECT_EQ(read->slot(i).front(), i + 1);
    EXPECT_EQ(read->slot(i).back(), i + 1);
  }
  for (const int height : {4, 0, -3})
    EXPECT_EQ(PictureSlots::open(UniqueFd(::dup(written->fd())), 5, height).error().code,
              Errc::kMalformed);
}

// A clock that a test advances while the link's thread reads it.
class SharedClock final : public Clock {
 public:
  Timestamp now() const noexcept override { return fromNanoseconds(now_ns_); }
  bool sleepUntil(Timestamp, const std::stop_token&) noexcept override { return false; }
  void advance(Duration by) noexcept { now_ns_ += by.count(); }

 private:
  std::atomic<std::int64_t> now_ns_{1'000'000'000'000};
};

// A link whose program is a shell script.
class WindowLinkTest : public testing::Test {
 protected:
  void start(const std::string& script, WindowActs acts = {}, const WindowSettings& settings = {}) {
    const std::string program = dir_ / "program";
    test::writeText(program, "#!/bin/sh\n" + script + "\n");
    ::chmod(program.c_str(), 0755);
    link_ = std::make_unique<WindowLink>(settings, std::move(acts), program, watch_, clock_);
  }
  Result<bool> show() {
    return link_->show(8, 6, std::vector<std::uint8_t>(std::size_t{4} * 8 * 6, 7));
  }
  bool becomes(const std::string& fault) {
    return test::eventually([&] { return link_->fault().find(fault) != std::string::npos; });
  }

  // Waits until the link's thread has repeated its loop more than 20 times.
  bool looksAgain() {
    const auto rounds = [&] { return watch_.threads().front().progress; };
    const auto before = rounds();
    return test::eventually([&] {
      static_cast<void>(show());
      return rounds() > before + 20;
    });
  }

  test::TempDir dir_;
  ThreadWatch watch_;
  SharedClock clock_;
  std::unique_ptr<WindowLink> link_;
};

TEST_F(WindowLinkTest, AProgramThatEndsIsAFaultAndIsStartedAgainAfterASecond) {
  const std::string starts = dir_ / "starts";
  start("echo >>" + starts);
  const auto count = [&] { return test::readText(starts).size(); };
  EXPECT_EQ(link_->fault(), "") << "nothing is known before the first frame";
  EXPECT_FALSE(*show());
  ASSERT_TRUE(becomes("has ended"));
  EXPECT_EQ(show().error().code, Errc::kIo);
  ASSERT_TRUE(looksAgain());
  EXPECT_EQ(count(), 1u) << "a second has not passed";
  clock_.advance(WindowLink::kRetry);
  EXPECT_TRUE(test::eventually([&] { return count() == 2; }));
}

TEST_F(WindowLinkTest, AProgramThatCannotBeStartedIsNamed) {
  start("");
  ::chmod((dir_ / "program").c_str(), 0644);
  ASSERT_TRUE(show());
  EXPECT_TRUE(becomes((dir_ / "program") + " cannot be started: Permission denied"));
}

// The program neither reads nor answers. Presenting must go on, the health must report it, and the
// end must not wait for the program.
TEST_F(WindowLinkTest, AProgramThatHangsHoldsNothingUp) {
  start("echo $$ >" + (dir_ / "pid") + "; exec sleep 1000");
  ASSERT_TRUE(show());
  const auto pid = [&] { return test::readText(dir_ / "pid"); };
  ASSERT_TRUE(test::eventually([&] { return pid().ends_with('\n'); }));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(*show()) << "no window shows it";
  clock_.advance(WindowLink::kSlow);
  EXPECT_TRUE(becomes("the display does not answer: the window has taken no frame for 2 s"));
  EXPECT_FALSE(show());
  const std::string first = pid();
  clock_.advance(WindowLink::kStuck);
  EXPECT_TRUE(test::eventually([&] { return pid().ends_with('\n') && pid() != first; }));
  const int second = std::stoi(pid());
  link_.reset();
  EXPECT_EQ(::kill(second, 0), -1) << "it has ended with its output";
}

// All pixels of a frame have the same value. The program reads its slot repeatedly before it
// answers.
TEST_F(WindowLinkTest, AFramesPixelsStayUntilTheProgramHasAnswered) {
  const std::string script = dir_ / "double.py", torn = dir_ / "torn", seen = dir_ / "seen";
  test::writeText(script, R"(
import mmap, socket, struct, sys
to = socket.socket(fileno=0)
form = to.recv(4096)
width, height = struct.unpack_from("ii", form, len(form) - 8)
pictures = mmap.mmap(1, 0, prot=mmap.PROT_READ)
to.send(struct.pack("I252s", 1, b""))
values = set()
while True:
    slot, = struct.unpack("I", to.recv(4))
    size = 4 * width * height
    first = pictures[slot * size]
    for _ in range(15):
        if pictures[slot * size:(slot + 1) * size] != bytes([first]) * size:
            open(sys.argv[1], "w").write("torn")
    values.add(first)
    if len(values) == 40:
        open(sys.argv[2], "w").write("done")
    to.send(struct.pack("I252s", 2, b""))
)");
  start("exec python3 -B " + script + " " + torn + " " + seen);
  int shown = 0, all = 0;
  EXPECT_TRUE(test::eventually([&] {
    const std::vector<std::uint8_t> pixels(std::size_t{4} * 320 * 240,
                                           static_cast<std::uint8_t>(all));
    const auto presented = link_->show(320, 240, pixels);
    shown += presented && *presented ? 1 : 0;
    ++all;
    return std::filesystem::exists(seen);
  }));
  EXPECT_FALSE(std::filesystem::exists(torn));
  EXPECT_GE(shown, 39);
  EXPECT_LE(shown, all);
}

// The person's commands reach merlind, and a window that was closed is not opened again.
TEST_F(WindowLinkTest, CommandsAndTheCloseArePassedOn) {
  const std::string script = dir_ / "double.py";
  test::writeText(script, R"(
import socket, struct
to = socket.socket(fileno=0)
to.recv(4096)
for kind, text in (1, b""), (5, b"next_mode"), (5, b"move 0 0 0 1 2 3"), (3, b""):
    to.send(struct.pack("I252s", kind, text))
to.recv(4)
)");
  std::mutex mutex;
  Strings commands, stops;
  const WindowActs acts{[&](const std::string& name, const std::string& argument) {
                          const std::lock_guard lock(mutex);
                          commands.push_back(name + "|" + argument);
                          return Result<std::string>(std::string());
                        },
                        [&](const std::string& why) {
                          const std::lock_guard lock(mutex);
                          stops.push_back(why);
                        }};
  start("echo >>" + (dir_ / "starts") + "; exec python3 -B " + script, acts,
        {.title = "wall", .on_close = OnClose::kStop});
  ASSERT_TRUE(show());
  ASSERT_TRUE(becomes("a person closed the window; restart merlind to open it again"));
  EXPECT_TRUE(test::eventually([&] {
    const std::lock_guard lock(mutex);
    return !stops.empty();
  }));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(commands, (Strings{"next_mode|", "move|0 0 0 1 2 3"}));
  EXPECT_EQ(stops, Strings{"the window \"wall\" was closed"});
  EXPECT_TRUE(link_->isClosed());
  EXPECT_EQ(show().error().code, Errc::kClosed);
  clock_.advance(2 * WindowLink::kRetry);
  const auto before = watch_.threads().front().progress;
  ASSERT_TRUE(test::eventually([&] { return watch_.threads().front().progress > before + 2; }));
  EXPECT_EQ(test::readText(dir_ / "starts"), "\n") << "it is started once";
}

}  // namespace
}  // namespace merlin::render::out
