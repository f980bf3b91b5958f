#include <fstream>

#include <gtest/gtest.h>

#include "nn/io/gesture_file.h"
#include "nn/io/path_file.h"
#include "tests/nn/files.h"
#include "tests/nn/moving.h"

namespace merlin::nn {
namespace {

using test::contentOf;

GestureFile small() {
  std::size_t lost = 0;
  PathRecording recording = test::gesturesOf(1, 4, 3, 1);
  test::join(recording, test::ordinaryOf(1, 4, 60, 1));
  const auto model = trainGestures(strokesOf(recording, 0.8, lost), {});
  EXPECT_TRUE(model);
  return {*model, {"a test \"quoted\"", 120, 300, true}};
}

std::string wrongWith(const std::string& text) {
  const auto read = parseGestures(text, "g.json");
  return read ? "" : read.error().what;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(GestureFileTest, IsItsOwnInverse) {
  const GestureFile file = small();
  const std::string text = formatGestures(file);
  const auto read = parseGestures(text, "g.json");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(formatGestures(*read), text);
  ASSERT_EQ(read->model.gestures.size(), 10u);
  EXPECT_EQ(read->model.gestures[3].strokes.whitening, file.model.gestures[3].strokes.whitening);
  EXPECT_EQ(read->model.gestures[3].discriminant, file.model.gestures[3].discriminant);
  EXPECT_EQ(read->trained.how, "a test \"quoted\"");
}

TEST(GestureFileTest, FaultsNameThePlaceWhatWasFoundAndWhatIsAllowed) {
  const std::string good = formatGestures(small());
  EXPECT_NE(wrongWith(replaced(good, "\"version\": 1", "\"version\": 2")).find("g.json: /version"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"right\"", "\"left\"")).find("g.json: /features/0"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"name\": \"pull\"", "\"name\": \"none\""))
                .find("/gestures/2/name"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"name\": \"pull\"", "\"name\": \"push\""))
                .find("a name that no other gesture has"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"limit\": ", "\"limit\": -")).find("/gestures/0/limit"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"whitening\": [", "\"whitening\": [-"))
                .find("/gestures/0/whitening/0"),
            std::string::npos)
      << "a deviation is above 0";
  EXPECT_NE(wrongWith(replaced(good, "\"mean\": [", "\"mean\": [1, ")).find("/gestures/0/mean"),
            std::string::npos);
  EXPECT_NE(wrongWith(replaced(good, "\"trained\"", "\"drained\"")).find("trained"),
            std::string::npos);
}

TEST(GestureFileTest, NoPrefixAndNoWrongByteLoadsHalf) {
  const std::string good = formatGestures(small());
  for (std::size_t size = 0; size + 2 < good.size(); size += 97)
    EXPECT_FALSE(parseGestures(good.substr(0, size), "g.json")) << size;
  for (std::size_t at = 0; at < good.size(); at += 131) {
    for (const char c : {'\0', '"', ',', '\xFF'}) {
      std::string text = good;
      text[at] = c;
      const auto read = parseGestures(text, "g.json");
      if (!read) {
        EXPECT_TRUE(read.error().what.starts_with("g.json")) << read.error().what;
      }
    }
  }
}

TEST(GestureFileTest, TheShippedOneHasTheTenReadyGestures) {
  const auto file = loadGestures(MERLIN_SOURCE_DIR "/config/gestures.json");
  ASSERT_TRUE(file) << file.error().what;
  ASSERT_EQ(file->model.gestures.size(), hand::movingGestures().size());
  for (const TrainedGesture& gesture : file->model.gestures)
    EXPECT_TRUE(hand::findMovingGesture(gesture.name)) << gesture.name;
  EXPECT_TRUE(file->trained.synthetic);
  EXPECT_EQ(formatGestures(*file), contentOf(MERLIN_SOURCE_DIR "/config/gestures.json"));
}

using GestureFiles = test::FilesTest;

TEST_F(GestureFiles, AreReplacedWholeOrNotAtAll) {
  GestureFile file = small();
  ASSERT_TRUE(saveGestures(path("g.json"), file));
  const std::string before = contentOf(path("g.json"));
  file.model.gestures[0].limit = -1;
  const auto saved = saveGestures(path("g.json"), file);
  ASSERT_FALSE(saved);
  EXPECT_TRUE(saved.error().what.starts_with("not written: ")) << saved.error().what;
  EXPECT_EQ(contentOf(path("g.json")), before);
}

std::string wrongPath(const std::string& rows) {
  const auto read = parsePaths("gesture,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n" + rows, "p.csv");
  return read ? "" : read.error().what;
}

TEST(PathFileTest, IsItsOwnInverse) {
  const PathRecording recording = test::gesturesOf(1, 1, 1, 1);
  const std::string text = formatPaths(recording);
  const auto read = parsePaths(text, "p.csv");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->synthetic);
  ASSERT_EQ(read->poses.size(), recording.poses.size());
  for (std::size_t n = 0; n < read->poses.size(); ++n) {
    ASSERT_EQ(read->poses[n].pose.position_m, recording.poses[n].pose.position_m);
    ASSERT_NEAR(static_cast<double>(read->poses[n].pose.at_ns),
                static_cast<double>(recording.poses[n].pose.at_ns), 501);
    ASSERT_EQ(read->labels[read->poses[n].label], recording.labels[recording.poses[n].label]);
  }
  EXPECT_EQ(formatPaths(*read), text);
}

TEST(PathFileTest, FaultsNameFileLineFoundAndAllowed) {
  EXPECT_EQ(wrongPath("wave,1,0,0,0,1,0,0,0\n"), "");
  EXPECT_EQ(wrongPath("wave,1,0,0,0,1,0,0,0\r\nnone,2,0,0,0,1,0,0,0"), "");
  EXPECT_EQ(wrongPath(""), "p.csv:1: found no poses; allowed: at least one line after the header");
  EXPECT_EQ(wrongPath("a wave,1,0,0,0,1,0,0,0\n"),
            "p.csv:2: found gesture \"a wave\"; allowed: 1 to 31 letters, digits, - or _; "
            "\"none\" for ordinary motion");
  EXPECT_NE(wrongPath("wave,1,0,0,x,1,0,0,0\n").find("number 4 of the line"), std::string::npos);
  EXPECT_NE(wrongPath("wave,1,0,0,nan,1,0,0,0\n").find("number 4 of the line"), std::string::npos);
  EXPECT_NE(wrongPath("wave,1,0,0,101,1,0,0,0\n").find("from -100 to 100"), std::string::npos);
  EXPECT_NE(wrongPath("wave,1,0,0,0,1,0,0\n").find("p.csv:2"), std::string::npos);
  EXPECT_NE(wrongPath("wave,1,0,0,0,1,0,0,0,0\n").find("number 8"), std::string::npos);
  EXPECT_NE(wrongPath("wave,1,0,0,0,0.1,0,0,0\n").find("a quaternion of length 0.100"),
            std::string::npos);
  const auto header = parsePaths("posture,s0\n", "p.csv");
  ASSERT_FALSE(header);
  EXPECT_NE(header.error().what.find("p.csv:1: found the header \"posture,s0\""),
            std::string::npos);
}

TEST(PathFileTest, OneWrongByteNeverLoadsHalf) {
  PathRecording recording = test::gesturesOf(1, 1, 1, 1);
  recording.poses.resize(40);
  const std::string good = formatPaths(recording);
  for (std::size_t at = 0; at < good.size(); at += 3) {
    for (const char c : {'\0', ',', '\n', 'x', '\xFF'}) {
      std::string text = good;
      text[at] = c;
      const auto read = parsePaths(text, "p.csv");
      if (!read) {
        EXPECT_TRUE(read.error().what.starts_with("p.csv:")) << read.error().what;
      }
    }
  }
}

}  // namespace
}  // namespace merlin::nn
