// What a running wall reports about pictures with wrong contents, slides that change or vanish, and
// ports that are in use. The test prints a table with the message for each case. The wall must go
// on showing its content.
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/net/connection_server.h"
#include "tests/support/pyramids.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

std::string plainPyramid(Rgb colour) {
  return pyramidBytes(
      {.width = 300, .height = 200, .colour = [colour](int, int) { return colour; }});
}

// Returns the pyramid with another value in a field of its first directory.
std::string withField(std::string bytes, int tag, std::uint64_t value) {
  detail::putAt(bytes, fieldAt(bytes, directoriesOf(bytes)[0], tag), value);
  return bytes;
}

// Returns the pyramid with another offset of a next directory in its last level.
std::string withNextOfLast(std::string bytes, std::uint64_t next) {
  const std::size_t last = directoriesOf(bytes).back();
  detail::putAt(bytes, last + 8 + 20 * numberAt(bytes, last), next);
  return bytes;
}

// Returns a pyramid whose header declares 400,000 x 250,000 pixels. If `with_places`, the header
// lists as many tiles as that size needs.
std::string gigapixels(bool with_places) {
  std::string bytes = withField(withField(pyramidBytes(), 256, 400'000), 257, 250'000);
  const std::size_t directory = directoriesOf(bytes)[0];
  for (const int tag : {324, 325}) {
    if (with_places) detail::putAt(bytes, fieldAt(bytes, directory, tag) - 8, 1563 * 977);
  }
  return bytes;
}

// Returns a pyramid in which all tiles of the coarsest level lie in the header.
std::string withTilesInTheHeader() {
  std::string bytes = pyramidBytes({.width = 200, .height = 100});
  return withField(bytes, 324, 8);
}

// Returns a pyramid in which all tiles of the finest level are at the place of the first one.
std::string withTilesOverOneAnother() {
  std::string bytes = pyramidBytes();
  const std::size_t directory = directoriesOf(bytes)[0];
  for (const int tag : {324, 325}) {
    const std::size_t table = numberAt(bytes, fieldAt(bytes, directory, tag));
    for (std::size_t i = 1; i < 6; ++i) detail::putAt(bytes, table + 8 * i, numberAt(bytes, table));
  }
  return bytes;
}

struct Case {
  std::string what;
  std::string bytes;
  std::string said;  // part of the message; empty: the picture is shown
};

std::vector<Case> pictures() {
  const std::string good = pyramidBytes(), small = pyramidBytes({.width = 200, .height = 100});
  const std::string pixel = pyramidBytes({.width = 1, .height = 1});
  return {
      {"an empty file", "", "is not a TIFF file"},
      {"a text", "this is no picture", "is not a TIFF file"},
      {"it lies about its width", withField(small, 256, 1 << 20),
       "has 1048576 x 100 pixels, which are 4096 tiles, and lists the places of 1"},
      {"a width of 4294967295 pixels", withField(small, 256, 0xFFFF'FFFF),
       "has 4294967295 x 100 pixels; 1 to 2147483647 are supported"},
      {"a height of 0 pixels", withField(small, 257, 0), "has 200 x 0 pixels; 1 to"},
      {"100 gigapixels by its header", gigapixels(false), "is not half of 400000 x 250000"},
      {"the same, with as many tiles listed", gigapixels(true), "end beyond the file's"},
      {"cut after its header", good.substr(0, 20), "lies beyond the file's 20 bytes"},
      {"cut in the middle", good.substr(0, good.size() / 2), "lies beyond the file's"},
      {"cut by one byte", good.substr(0, good.size() - 1), "the directory at byte"},
      {"its levels loop", withNextOfLast(good, directoriesOf(good)[0]),
       "600 x 300 pixels, which is not half of 150 x 75"},
      {"a level is its own next one", withNextOfLast(pixel, directoriesOf(pixel)[0]),
       "the directories loop"},
      {"its tiles lie in the header", withTilesInTheHeader(), "level 0, tile 0 of row 0"},
      {"its tiles lie over one another", withTilesOverOneAnother(), ""},
  };
}

// One wall serves all cases; the table is printed at the end.
class HostilePictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    writeText(*dir_ / "red.tif", plainPyramid({250, 0, 0}));
    writeText(*dir_ / "blue.tif", plainPyramid({0, 0, 250}));
    fs::create_directory(*dir_ / "slides");
    for (const char* const name : {"a", "b", "c"})
      writeText(slide(name), plainPyramid({0, 250, 0}));
    const nlohmann::json wall = {{"model", ""},
                                 {"contents",
                                  {{{"picture", *dir_ / "red.tif"}},
                                   {{"slides", *dir_ / "slides"}},
                                   {{"picture", *dir_ / "blue.tif"}}}}};
    m_ = new Merlind(*dir_, "", "hostile",
                     MerlindOptions{.emulate = false, .also = {{"wall", wall}}});
    EXPECT_TRUE(m_->ready()) << m_->process().output();
  }
  static void TearDownTestSuite() {
    EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
    delete m_;
    delete dir_;
    fmt::print("{}", std::exchange(table_, "\n"));
  }

  static std::string slide(const std::string& name) { return *dir_ / "slides/" + name + ".tif"; }
  // Returns the path of a file in the content folder, as if a client had put it there without
  // merlin show.
  static std::string shared(const std::string& name) {
    return *dir_ / (m_->instance() + ".shown/" + name);
  }
  static Outcome merlin(std::vector<std::string> words) {
    words.insert(words.begin(), kMerlin);
    words.insert(words.end(), {"--instance", m_->instance()});
    return run(words);
  }
  static bool isShown(const std::string& name, const std::string& slide = "") {
    return eventually([&] {
      const auto content = m_->status()["content"];
      return content["name"] == name && content["slide"] == slide;
    });
  }
  static std::string shown() {
    const auto content = m_->status()["content"];
    return fmt::format("{} {}", content.value("name", ""), content.value("slide", ""));
  }
  // Adds a row to the table, and removes the folder's path from the message.
  static void row(const std::string& what, std::string said) {
    while (!said.empty() && said.back() == '\n') said.pop_back();
    for (std::size_t at = 0; (at = said.find(*dir_ / "")) != std::string::npos;)
      said.erase(at, dir_->path().size() + 1);
    table_ += fmt::format("{:40} {}\n", what, said);
  }
  // Waits for an event whose text contains `said`, and adds its row.
  static void rowOf(const std::string& what, const std::string& said) {
    EXPECT_TRUE(m_->process().saysEventually(said)) << m_->process().output();
    const std::string log = m_->process().output();
    const std::size_t at = log.rfind(said);
    if (at == std::string::npos) return;
    const std::size_t begin = log.rfind('\n', at) + 1;
    row(what, log.substr(begin, log.find('\n', at) - begin));
  }

  static TempDir* dir_;
  static Merlind* m_;
  static inline std::string table_ = "\n";
};
TempDir* HostilePictures::dir_ = nullptr;
Merlind* HostilePictures::m_ = nullptr;

TEST_F(HostilePictures, OfEachTheMessageSaysWhatIsWrongAndTheWallGoesOn) {
  int number = 0;
  for (const Case& c : pictures()) {
    const std::string name = fmt::format("case-{}", ++number), file = shared(name + ".tif");
    writeText(file, c.bytes);
    const Outcome shown = merlin({"show", file});
    row(c.what, shown.status == 0 ? "is shown" : shown.output);
    EXPECT_EQ(shown.status, c.said.empty() ? 0 : 2) << c.what << ": " << shown.output;
    EXPECT_NE(shown.output.find(c.said), std::string::npos) << c.what << ": " << shown.output;
    EXPECT_TRUE(isShown(c.said.empty() ? name : "red")) << c.what;
    if (c.said.empty())
      merlin({"show", "red"});
    else
      EXPECT_NE(shown.output.find(file + ": "), std::string::npos) << shown.output;
  }
  ASSERT_EQ(::mkfifo(shared("pipe.tif").c_str(), 0600), 0);
  const Outcome pipe = merlin({"show", shared("pipe.tif")});
  row("a pipe", pipe.output);
  EXPECT_EQ(pipe.status, 2);
  EXPECT_NE(pipe.output.find("pipe.tif: is not a regular file"), std::string::npos) << pipe.output;
}

TEST_F(HostilePictures, AFolderOfSlidesThatChangesOrVanishesKeepsNothingFromItsTurn) {
  ASSERT_EQ(merlin({"show", "slides"}).status, 0);
  EXPECT_TRUE(isShown("slides", "a"));
  const auto next = [] { merlin({"next_content"}); };

  writeText(slide("aa"), plainPyramid({0, 200, 0}));
  fs::remove(slide("b"));
  next();
  EXPECT_TRUE(isShown("slides", "aa"));
  row("a slide is put between, another removed", shown());

  writeText(slide("c"), "damaged");
  next();
  EXPECT_TRUE(isShown("slides", "a")) << "from the beginning, since c was to come";
  next();
  EXPECT_TRUE(isShown("slides", "aa"));
  rowOf("the last slide is damaged", "a slide is left out: ");
  next();
  EXPECT_TRUE(isShown("blue"));

  merlin({"show", "slides"});
  EXPECT_TRUE(isShown("slides", "a"));
  for (const auto& entry : fs::directory_iterator(*dir_ / "slides")) fs::remove(entry.path());
  next();
  EXPECT_TRUE(isShown("blue"));
  rowOf("the folder is emptied while it is shown", "has no pyramid (.tif)");

  for (const char* const name : {"a", "b", "c"}) writeText(slide(name), plainPyramid({0, 9, 0}));
  merlin({"show", "slides"});
  next();
  EXPECT_TRUE(isShown("slides", "b"));
  fs::remove_all(*dir_ / "slides");
  next();
  EXPECT_TRUE(isShown("blue"));
  rowOf("the folder vanishes while it is shown", "slides: No such file or directory");
  rowOf("the same, of the slide", "is gone or is no longer a regular file");
  next();
  EXPECT_TRUE(isShown("red"));
  next();
  EXPECT_TRUE(isShown("slides", "b")) << "the one that was read last";

  fs::create_directory(*dir_ / "slides");
  writeText(slide("x"), plainPyramid({0, 9, 0}));
  next();
  EXPECT_TRUE(isShown("slides", "x"));
  row("the folder is there again, with another slide", shown());
  merlin({"show", "red"});
}

// A port at which another program listens.
class BusyPort : public HostilePictures {
 protected:
  void SetUp() override {
    auto taken = net::listenTcp("127.0.0.1", 0);
    ASSERT_TRUE(taken);
    taken_ = *std::move(taken);
    port_ = net::portOf(taken_.get());
  }
  // Writes the configuration of another process that uses the port; returns its path.
  std::string config(const std::string& name, nlohmann::json settings) {
    settings["instance"] = privateName(name);
    settings["run_directory"] = dir_->path();
    writeText(*dir_ / name + ".json", settings.dump());
    return *dir_ / name + ".json";
  }
  void expectSaid(const std::string& what, const std::vector<std::string>& command,
                  const std::string& said) {
    Process process(command);
    EXPECT_TRUE(process.saysEventually(said)) << process.output();
    const std::string log = process.output();
    const std::size_t at = log.find(said), begin = log.rfind('\n', at) + 1;
    if (at != std::string::npos) row(what, log.substr(begin, log.find('\n', at) - begin));
  }

  UniqueFd taken_;
  int port_ = 0;
};

TEST_F(BusyPort, IsNamedByWhoeverNeedsItAndTheWallIsShown) {
  const std::string rfb = MERLIN_BIN_DIR "/merlin-rfb";
  const std::string port = std::to_string(port_);
  expectSaid(
      "the page's port is taken",
      {kMerlind, "--role", "page", "--config", config("page", {{"page", {{"port", port_}}}})},
      "page: failed (/page/port " + port);
  if (fs::exists(rfb)) {
    expectSaid("the VNC port is taken",
               {rfb, "--instance", m_->instance(), "--listen", "127.0.0.1:" + port},
               "another program listens there");
  }
  ASSERT_EQ(run({kMerlin, "keys", "-o", *dir_ / "keys"}).status, 0);
  writeText(*dir_ / "clients", "");
  const nlohmann::json serve = {{"samples_endpoint", "tcp://127.0.0.1:" + port},
                                {"samples_keys", *dir_ / "keys"},
                                {"samples_clients", *dir_ / "clients"},
                                {"vrpn_port", port_}};
  const std::vector<std::string> devices = {kMerlind, "--role", "devices", "--config",
                                            config("serve", {{"serve", serve}})};
  expectSaid("the samples' port is taken", devices, "samples for other machines: failed (");
  expectSaid("the VRPN port is taken", devices, "VRPN: failed (");
  const Outcome second = run({kMerlind, "--config", m_->config()});
  row("the status socket is another merlind's", second.output);
  EXPECT_EQ(second.status, 3) << second.output;
  EXPECT_TRUE(isShown("red"));
}

}  // namespace
}  // namespace merlin::test
