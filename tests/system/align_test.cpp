// Alignment by script in the real daemon: the signal of an output moves by the right number of
// pixels, also after undo, redo, a restart and a kill. Also tests which alignments the daemon
// keeps.
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "render/image/image_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr int kWidth = 320, kHeight = 240;

class Align : public testing::Test {
 protected:
  Align() { start(); }

  // Starts a wall that shows its background alone, with the state of an earlier start.
  void start() {
    wall_.reset();
    const json tile = json::array({{{"tile", "left"}}});
    const json outputs = json::array({{{"kind", "shared_memory"}},
                                      {{"kind", "png"},
                                       {"name", "left"},
                                       {"path", dir_ / "left.png"},
                                       {"interval_s", 86400},
                                       {"tiles", tile}}});
    MerlindOptions options;
    options.script = "still";
    options.also = {{"wall",
                     {{"scene", {{"model_distance_m", 1000}}},
                      {"render", {{"background", {1, 1, 1}}}},
                      {"tiles",
                       {{"tile_width", kWidth},
                        {"tile_height", kHeight},
                        {"frame_width", 2 * kWidth},
                        {"frame_height", kHeight},
                        {"tiles", json::array({{{"name", "left"}, {"turns", 1}},
                                               {{"name", "right"}, {"x", kWidth}}})}}},
                      {"contents", json::array({{{"model", other_}}})},
                      {"outputs", outputs}}}};
    options.also.merge_patch(also_);
    wall_ = std::make_unique<Merlind>(dir_, model_, "align", options);
    ASSERT_TRUE(wall_->ready()) << wall_->process().output();
  }
  Outcome merlin(std::vector<std::string> words) const {
    words.insert(words.begin(), kMerlin);
    words.insert(words.end(), {"--instance", wall_->instance()});
    return run(words);
  }
  Outcome align(std::vector<std::string> words) const {
    words.insert(words.begin(), {"wall", "align"});
    return merlin(words);
  }
  Outcome moveCorner(const std::string& corner, const std::string& x, const std::string& y) const {
    return align({"--output", "left", "--corner", corner, "--by", x, y});
  }

  // Returns the output's present signal. The background is white; pixels that show nothing are
  // black.
  render::image::ImageFile signal(const std::string& output = "left") const {
    const std::string file = dir_ / "signal.png";
    const Outcome taken = merlin({"snapshot", "--output", output, "-o", file});
    EXPECT_EQ(taken.status, 0) << taken.output;
    auto read = render::image::readImage(file);
    EXPECT_TRUE(read);
    return read ? *std::move(read) : render::image::ImageFile{};
  }
  // blackLeft() returns the number of black columns at the left of a row, blackTop() the number of
  // black rows at the top of a column. The daemon answers a move before the new correction is in
  // use, so a test has to wait for the expected number.
  int blackLeft(int row) const {
    const render::image::ImageFile picture = signal();
    int x = 0;
    while (x < kWidth && at(picture, x, row) < 128) ++x;
    return x;
  }
  int blackTop(int column) const {
    const render::image::ImageFile picture = signal();
    int y = 0;
    while (y < kHeight && at(picture, column, y) < 128) ++y;
    return y;
  }
  static int at(const render::image::ImageFile& p, int x, int y) {
    return p.pixels.at(static_cast<std::size_t>(3 * (y * kWidth + x)));
  }
  std::string stateFile() const { return dir_ / "align.state.json"; }

  TempDir dir_;
  std::string model_ = makeModel(dir_, 2), other_ = makeFullModel(dir_);
  json also_ = json::object();
  std::unique_ptr<Merlind> wall_;
};

TEST_F(Align, MovesTheSignalByTheRightPixelsUndoneRedoneAndAfterARestart) {
  EXPECT_EQ(blackLeft(0), 0);
  const Outcome moved = moveCorner("top_left", "20", "0");
  EXPECT_EQ(moved.status, 0) << moved.output;
  EXPECT_NE(moved.output.find("top_left      +20 +0  (configured +0 +0, moved +20 +0)"),
            std::string::npos)
      << moved.output;
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  EXPECT_EQ(blackLeft(kHeight - 1), 0);
  EXPECT_EQ(moveCorner("top_left", "-10", "12").status, 0);
  EXPECT_TRUE(eventually([&] { return blackTop(12) == 12; }))
      << "the upper edge rises from (10, 12) to (320, 0)";
  EXPECT_EQ(align({"--undo"}).status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  wall_->process().kill(SIGTERM);
  start();
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  EXPECT_EQ(align({"--redo"}).status, 0);
  EXPECT_TRUE(eventually([&] { return blackTop(12) == 12; }));
  EXPECT_EQ(align({"--undo"}).status, 0);
  EXPECT_EQ(align({"--undo"}).status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 0; }));
  EXPECT_EQ(align({"--redo"}).status, 0);
  EXPECT_EQ(align({"--output", "left", "--reset"}).status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 0; }));
}

TEST_F(Align, TheConfiguredCorrectionIsTheBase) {
  wall_->process().kill(SIGTERM);
  also_ = {{"wall", {{"outputs", json::array()}}}};
  also_["wall"]["outputs"] =
      json::array({{{"kind", "shared_memory"}},
                   {{"kind", "png"},
                    {"name", "left"},
                    {"path", dir_ / "left.png"},
                    {"interval_s", 86400},
                    {"tiles", json::array({{{"tile", "left"}}})},
                    {"correction", {{"corners", {10, 0, 0, 0, 10, 0, 0, 0}}}}}});
  start();
  EXPECT_TRUE(eventually([&] { return blackLeft(100) == 10; }));
  EXPECT_EQ(moveCorner("top_left", "5", "0").status, 0);
  EXPECT_EQ(moveCorner("bottom_left", "5", "0").status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(100) == 15; }));
}

class AlignedExport : public Align {
 protected:
  // Exports the configuration as MPCDI; returns the output of the export, and the correction that
  // an import of the exported file prints.
  std::pair<std::string, std::string> exported(const std::string& config) const {
    const std::string mpcdi = dir_ / "wall.mpcdi";
    const Outcome done = run({kMerlin, "wall", "mpcdi", "export", mpcdi, "-c", config});
    EXPECT_EQ(done.status, 0) << done.output;
    return {done.output, run({kMerlin, "wall", "mpcdi", "import", mpcdi}).output};
  }
  // Returns the path of a copy of the wall's configuration with another correction. If `running` is
  // false, the copy belongs to another instance, which does not run.
  std::string changed(const json& correction, bool running) const {
    json config = json::parse(readText(wall_->config()));
    if (!running) config["instance"] = privateName("other");
    if (!running) config["state_file"] = dir_ / "other.state.json";
    config["wall"]["outputs"][1]["correction"] = correction;
    writeText(dir_ / "changed.json", config.dump());
    return dir_ / "changed.json";
  }
};

// The exported file equals that of a configuration whose corners are set to where the alignment
// moved them.
TEST_F(AlignedExport, HasMovedCorners) {
  EXPECT_EQ(moveCorner("top_left", "20", "12.5").status, 0);
  const auto [said, moved] = exported(wall_->config());
  EXPECT_NE(said.find("left: what merlin wall align has moved is in the file; once the "
                      "configuration uses the file, run merlin wall align --reset --output left"),
            std::string::npos)
      << said;
  const json there = {{"corners", {20, 12.5, 0, 0, 0, 0, 0, 0}}},
             elsewhere = {{"corners", {1, 0, 0, 0, 0, 0, 0, 0}}};
  EXPECT_EQ(exported(changed(there, false)).second, moved);
  const auto [foreign, without] = exported(changed(elsewhere, true));
  EXPECT_NE(foreign.find("left: what merlin wall align has moved is not in the file: the wall runs "
                         "with another size, mesh or corners"),
            std::string::npos)
      << foreign;
  EXPECT_NE(without, moved);
  const std::string stopped = exported(changed(elsewhere, false)).first;
  EXPECT_NE(
      stopped.find("if merlin wall align has moved anything, it is not in the file, since the "
                   "wall cannot be asked: "),
      std::string::npos)
      << stopped;
}

TEST_F(AlignedExport, HasMovedCornersAlsoOfAWallThatDoesNotRun) {
  EXPECT_EQ(moveCorner("top_left", "20", "12.5").status, 0);
  const std::string running = exported(wall_->config()).second;
  wall_->process().kill(SIGTERM);
  const auto [said, kept] = exported(wall_->config());
  EXPECT_EQ(kept, running);
  EXPECT_NE(said.find("what merlin wall align has moved is read from the state file " +
                      stateFile() + ", since the wall cannot be asked: "),
            std::string::npos)
      << said;
  const std::string foreign =
      exported(changed({{"corners", {1, 0, 0, 0, 0, 0, 0, 0}}}, true)).first;
  EXPECT_NE(foreign.find("left: what merlin wall align has moved is not in the file: it was made "
                         "for another size, mesh or corners"),
            std::string::npos)
      << foreign;
}

TEST_F(AlignedExport, HasMovedPointsOfTheMesh) {
  const auto meshed = [](double x, double y) {
    const auto point = [](double px, double py) { return json{{"x", px}, {"y", py}}; };
    return json{{"mesh",
                 {{"columns", 2},
                  {"rows", 2},
                  {"points", {point(0, 0), point(1, 0), point(0, 1), point(x, y)}}}}};
  };
  wall_->process().kill(SIGTERM);
  also_ = {{"wall", {{"outputs", json::array()}}}};
  also_["wall"]["outputs"] = json::parse(readText(wall_->config()))["wall"]["outputs"];
  also_["wall"]["outputs"][1]["correction"] = meshed(1, 1);
  start();
  EXPECT_EQ(align({"--output", "left", "--point", "1", "1", "--by", "-32", "-12"}).status, 0);
  const std::string moved = exported(wall_->config()).second;
  EXPECT_EQ(moved, exported(changed(meshed(0.9, 0.95), false)).second);
  EXPECT_NE(moved, exported(changed(meshed(1, 1), false)).second);
}

TEST_F(Align, WhatCannotBeIsRefusedWithAMessageAndChangesNothing) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& what) {
    const Outcome outcome = align(words);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(what), std::string::npos) << outcome.output;
  };
  refused({"--output", "left", "--corner", "top_left", "--by", "300", "230"}, "convex picture");
  refused({"--output", "top", "--corner", "top_left", "--by", "1", "1"},
          "merlin: there is no output \"top\"; those that can be aligned are left");
  refused({"--output", "shared_memory", "--corner", "top_left", "--by", "1", "1"},
          "holds the frame without correction");
  refused({"--output", "left", "--corner", "upper_left", "--by", "1", "1"}, "top_left");
  refused({"--output", "left", "--by", "1", "1"}, "--by needs --corner NAME or --point");
  refused({"--corner", "top_left", "--by", "1", "1"}, "--by needs --output NAME");
  refused({"--output", "left", "--corner", "top_left", "--by", "nan", "1"}, "--by");
  refused({"--undo"}, "merlin: there is nothing to undo");
  refused({"--undo", "--redo"}, "at most 1 options");
  EXPECT_EQ(blackLeft(0), 0);
  EXPECT_FALSE(std::filesystem::exists(stateFile()));
  EXPECT_EQ(merlin({"snapshot", "--output", "top", "-o", dir_ / "x.png"}).status, 2);
}

TEST_F(Align, RateAndContentAreThereAfterARestart) {
  EXPECT_EQ(merlin({"wall", "--rate", "12"}).status, 0);
  EXPECT_EQ(merlin({"next_content"}).status, 0);
  EXPECT_TRUE(
      eventually([&] { return readText(stateFile()).find("full.mrm") != std::string::npos; }));
  wall_->process().kill(SIGTERM);
  start();
  EXPECT_EQ(wall_->wall().rate_asked_hz, 12);
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(wall_->instance(), "wall"));
  ASSERT_TRUE(segment);
  EXPECT_TRUE(eventually([&] {
    const auto shown = (*segment)->interaction.read();
    return shown && shown->content == 1;
  }));
  EXPECT_EQ(merlin({"wall", "--rate", "auto"}).status, 0);
  EXPECT_TRUE(
      eventually([&] { return readText(stateFile()).find("rate_hz") == std::string::npos; }));
}

TEST_F(Align, APlaylistThatIsOffIsOffAfterARestartUntilOn) {
  const auto restart = [this] {
    wall_->process().kill(SIGTERM);
    start();
  };
  const auto isPlaylist = [this](const std::string& state) {
    return eventually([&] { return wall_->status()["playlist"] == state; });
  };
  also_ = {{"wall", {{"playlist", {{"after_s", 3600}}}}}};
  restart();
  EXPECT_TRUE(isPlaylist("waiting"));
  EXPECT_EQ(merlin({"playlist", "off"}).status, 0);
  EXPECT_TRUE(isPlaylist("off"));
  restart();
  EXPECT_TRUE(isPlaylist("off"));
  EXPECT_EQ(merlin({"playlist", "on"}).status, 0);
  EXPECT_TRUE(isPlaylist("running"));
  restart();
  EXPECT_TRUE(isPlaylist("waiting"));
  const Outcome bare = merlin({"playlist"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_NE(bare.output.find("on, off or next is required"), std::string::npos) << bare.output;
}

// The state file is written at each step, and the process is killed while it writes.
TEST_F(Align, AKillAmongManyWritesLeavesAStateThatIsRead) {
  for (int round = 0; round < 5; ++round) {
    const std::string script = fmt::format(
        "i=0; while {} wall align --instance {} --output left --corner top_left --by 0.01 0 "
        ">/dev/null 2>&1; do i=$((i+1)); done; echo $i",
        kMerlin, wall_->instance());
    Process moves({"/bin/sh", "-c", script});
    const std::string before = readText(stateFile());
    EXPECT_TRUE(eventually([&] { return readText(stateFile()) != before; }));
    wall_->process().kill(SIGKILL);
    EXPECT_EQ(moves.wait(), 0);
    start();
    EXPECT_EQ(wall_->process().output().find("damaged"), std::string::npos);
    const json left = json::parse(align({"--json"}).output)["outputs"][0];
    const double moved = left["corners"]["top_left"]["moved"][0];
    EXPECT_GE(moved, 0.01 * (round + 1) - 1e-9);
  }
}

TEST_F(Align, ADamagedStateIsSaidAndThePreviousOneUsed) {
  moveCorner("top_left", "20", "0");
  moveCorner("top_left", "20", "0");
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 40; }));
  wall_->process().kill(SIGTERM);
  std::filesystem::resize_file(stateFile(), std::filesystem::file_size(stateFile()) / 2);
  start();
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  EXPECT_TRUE(wall_->process().saysEventually("the state file is damaged: " + stateFile()))
      << wall_->process().output();
  EXPECT_TRUE(std::filesystem::exists(stateFile() + ".damaged"));
}

TEST_F(Align, ANewerStateIsLeftAloneAndStatusSaysSo) {
  wall_->process().kill(SIGTERM);
  const std::string newer = R"({"merlin_state": 4, "more": []})";
  writeText(stateFile(), newer);
  start();
  EXPECT_EQ(moveCorner("top_left", "20", "0").status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  EXPECT_EQ(readText(stateFile()), newer);
  EXPECT_TRUE(
      eventually([&] { return wall_->status()["services"]["state"]["health"] == "failed"; }));
  const std::string reason = wall_->status()["services"]["state"]["reason"];
  EXPECT_NE(reason.find("a newer merlind wrote the file"), std::string::npos) << reason;
}

TEST_F(Align, AFileThatIsReadCannotBeTheStateFile) {
  for (const std::string& file : {model_, wall_->config()}) {
    json config = json::parse(readText(wall_->config()));
    config["state_file"] = file;
    writeText(dir_ / "bad.json", config.dump());
    if (file == wall_->config()) {
      config["state_file"] = dir_ / "bad.json";
      writeText(dir_ / "bad.json", config.dump());
    }
    const Outcome checked = run({kMerlind, "--check-config", dir_ / "bad.json"});
    EXPECT_EQ(checked.status, 2) << checked.output;
    EXPECT_NE(checked.output.find("/state_file names "), std::string::npos) << checked.output;
  }
}

// People tune blends by trial and error, so a changed blend must not restart the wall.
TEST_F(Align, AChangedCorrectionIsTakenByAReloadWhileTheWallRuns) {
  EXPECT_EQ(moveCorner("top_right", "-10", "0").status, 0);
  EXPECT_TRUE(eventually([&] { return at(signal(), 318, 100) < 128; }));
  auto config = json::parse(readText(wall_->config()));
  config["wall"]["outputs"][1]["correction"] = {{"blend", {{"left", 80}}}};
  writeText(wall_->config(), config.dump());
  const Outcome done = merlin({"reload"});
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("/wall/outputs/1/correction/blend/left: 0 -> 80"), std::string::npos)
      << done.output;
  EXPECT_TRUE(eventually([&] { return at(signal(), 2, 120) < 60; })) << "the ramp";
  EXPECT_LT(at(signal(), 318, 100), 128) << "the corner stays moved";
  EXPECT_EQ(done.output.find("started again"), std::string::npos) << done.output;
}

// A wrong number in the configuration must not delete an alignment.
TEST_F(Align, AnAlignmentIsSetAsideWhileItsOutputHasAnotherSizeAndComesBack) {
  EXPECT_EQ(moveCorner("top_left", "20", "0").status, 0);
  const std::string good = readText(wall_->config());
  auto config = json::parse(good);
  config["wall"]["tiles"]["tile_width"] = 160;
  writeText(wall_->config(), config.dump());
  const std::string note =
      "set aside: it was made for 320 x 240 pixels and a mesh of 0 x 0 points, but the output now "
      "has 160 x 240 pixels and a mesh of 0 x 0 points; it comes back, with its undo steps, when "
      "the output is again as it was then";
  const Outcome checked = merlin({"reload", "--check"}), wrong = merlin({"reload"});
  EXPECT_NE(checked.output.find("note: the alignment of output left would be " + note),
            std::string::npos)
      << checked.output;
  EXPECT_NE(wrong.output.find("note: the alignment of output left is " + note), std::string::npos)
      << wrong.output;
  EXPECT_NE(align({"--list"}).output.find("steps that can be undone: 0"), std::string::npos);
  writeText(wall_->config(), good);
  const std::string back = "note: the alignment of output left, which was set aside, ";
  const Outcome first = merlin({"reload", "--check"}), right = merlin({"reload"});
  EXPECT_NE(first.output.find(back + "would be in effect again"), std::string::npos)
      << first.output;
  EXPECT_NE(right.output.find(back + "is in effect again"), std::string::npos) << right.output;
  EXPECT_EQ(right.output.find("is set aside"), std::string::npos) << right.output;
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 20; }));
  EXPECT_EQ(align({"--undo"}).status, 0);
  EXPECT_TRUE(eventually([&] { return blackLeft(0) == 0; }));
}

TEST_F(Align, AnOutputThatWouldBeIgnoredOrIsNotThereIsRefused) {
  const auto refused = [&](std::vector<std::string> words, const std::string& what) {
    words.insert(words.begin(), {"wall", "align"});
    const Outcome done = merlin(words);
    EXPECT_EQ(done.status, 2) << done.output;
    EXPECT_NE(done.output.find(what), std::string::npos) << done.output;
  };
  refused({"--undo", "--output", "beamer"}, "--undo takes back the last step, whichever output");
  refused({"--redo", "--output", "beamer"},
          "--redo repeats the step that was undone last, whichever");
  refused({"--list", "--output", "bemaer"},
          "\"bemaer\" is not an output that can be aligned; there are ");
}

TEST_F(Align, ATestCardIsShownAndCorrected) {
  EXPECT_EQ(merlin({"wall", "testcard", "grid"}).status, 0);
  const render::image::ImageFile card = signal();
  EXPECT_EQ(at(card, 10, 2), 0);
  EXPECT_EQ(at(card, 10, 0), 255);
  moveCorner("top_left", "20", "0");
  moveCorner("bottom_left", "20", "0");
  EXPECT_TRUE(eventually([&] {
    const render::image::ImageFile corrected = signal();
    return at(corrected, 10, 0) == 0 && at(corrected, 20, 100) > 200;
  })) << "the grid's border has moved";
  EXPECT_EQ(merlin({"wall", "testcard", "off"}).status, 0);
  EXPECT_EQ(at(signal(), 100, 2), 255);
  const Outcome wrong = merlin({"wall", "testcard", "gird"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.output.find("merlin: there is no test card \"gird\"; "), std::string::npos)
      << wrong.output;
  EXPECT_NE(
      wrong.output.find("there are grid, edges, ramps, names, focus, black, grey, white, and off"),
      std::string::npos)
      << wrong.output;
}

// A program that runs on a pseudo-terminal of its own.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> words) {
    const winsize size{24, 80, 0, 0};
    pid_ = ::forkpty(&master_, nullptr, nullptr, &size);
    if (pid_ != 0) return;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Terminal() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys) const {
    EXPECT_EQ(::write(master_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  // Waits until the terminal shows this text after all texts that earlier calls found; false if it
  // never does.
  bool shows(const std::string& text) {
    return eventually([&] {
      pollfd item{master_, POLLIN, 0};
      char bytes[4096];
      while (::poll(&item, 1, 0) > 0) {
        const ssize_t n = ::read(master_, bytes, sizeof bytes);
        if (n <= 0) break;
        output_.append(bytes, static_cast<std::size_t>(n));
      }
      const std::size_t found = output_.find(text);
      if (found == std::string::npos) return false;
      output_.erase(0, found + text.size());
      return true;
    });
  }
  // Returns whether the terminal is in its usual mode, as for a shell: it echoes keys and edits
  // lines.
  bool isUsual() const {
    termios now{};
    ::tcgetattr(master_, &now);
    return (now.c_lflag & (ICANON | ECHO)) == (ICANON | ECHO);
  }
  pid_t pid() const { return pid_; }

 private:
  int master_ = -1;
  pid_t pid_ = -1;
  std::string output_;
};

TEST_F(Align, KeysInATerminalMoveTheCornerAndTheTerminalIsAsBefore) {
  const std::vector<std::string> words = {kMerlin, "wall", "align", "--instance",
                                          wall_->instance()};
  {
    Terminal terminal(words);
    EXPECT_TRUE(terminal.shows("Output left (1 of 1), 320 x 240 pixels"));
    EXPECT_FALSE(terminal.isUsual());
    terminal.type("LL\x1b[C");
    EXPECT_TRUE(terminal.shows("moved     +21.0      +0.0"));
    EXPECT_TRUE(eventually([&] { return blackLeft(0) == 21; }));
    terminal.type("3LLl");
    EXPECT_TRUE(terminal.shows("> 3 bottom_left       +21.0"));
    EXPECT_TRUE(eventually([&] { return blackLeft(200) == 21; }));
    terminal.type("t");
    EXPECT_TRUE(terminal.shows("test card on"));
    terminal.type("u");
    EXPECT_TRUE(terminal.shows("left bottom_left by -1, 0"));
    terminal.type("2" + std::string(40, 'H'));
    EXPECT_TRUE(terminal.shows("stays where it is"));
    terminal.type("q");
    EXPECT_TRUE(eventually([&] { return terminal.isUsual(); }));
    EXPECT_TRUE(eventually([&] { return at(signal(), 60, 205) == 255; })) << "without the card";
  }
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGABRT, SIGSEGV}) {
    Terminal terminal(words);
    EXPECT_TRUE(terminal.shows("Output left"));
    ::kill(terminal.pid(), signal);
    EXPECT_TRUE(terminal.shows("\033[?1049l")) << signal;
    EXPECT_TRUE(terminal.isUsual()) << signal;
  }
}

}  // namespace
}  // namespace merlin::test
