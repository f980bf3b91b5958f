#include <fstream>

#include <gtest/gtest.h>

#include "nn/io/data_set_file.h"
#include "tests/nn/files.h"
#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

using test::contentOf;

std::string wrongWith(const std::string& text) {
  const auto read = parseRecording(text, "f.csv");
  return read ? "" : read.error().what;
}

// Returns a CSV text: a header with 22 sensor names, and one row whose values are the column
// numbers plus 0.5.
std::string twentyTwo(const std::string& end, const std::string& label = "fist") {
  std::string header = "Label", line = label;
  for (int i = 0; i < 22; ++i) {
    header += ",sensor_" + std::to_string(i);
    line += "," + std::to_string(i) + ".5";
  }
  return header + end + line + end;
}

TEST(Recording, TakesEveryEndOfALine) {
  for (const char* end : {"\n", "\r", "\r\n"}) {
    const auto read = parseRecording(twentyTwo(end), "f");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(read->hands.size(), 1u);
    EXPECT_EQ(read->hands[0].posture, "fist");
    EXPECT_EQ(read->hands[0].value[6], 6.5F);
    EXPECT_EQ(read->hands[0].value[8], 7.5F) << "22 sensors lack slot 7";
    EXPECT_EQ(read->unit, InputUnit::kRaw) << "beyond 6.3";
  }
}

TEST(Recording, TakesSlotsByNameInAnyOrder) {
  const auto read = parseRecording("s4;gesture;wrist-yaw\n0.5; ILY ;-0.25\n", "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->hands[0].posture, "ILY");
  EXPECT_EQ(read->hands[0].value[4], 0.5F);
  EXPECT_EQ(read->hands[0].value[22], -0.25F);
  EXPECT_TRUE(read->measured[4]);
  EXPECT_FALSE(read->measured[5]);
  EXPECT_EQ(read->unit, InputUnit::kRadians);
}

// The header is that of another program. The chosen columns say which sensor each column holds; all
// other columns are skipped.
TEST(Recording, TakesTheColumnsThatWereChosen) {
  const std::string text = "Frame,Symbol,ThumbRotate,IndexInner,Battery\n7,fist,0.5,0.25,99\n";
  const auto columns = [&](std::vector<ChosenColumn> chosen) {
    return parseRecording(text, "f", {}, chosen);
  };
  const auto read = columns({{"posture", "symbol"}, {"s0", "ThumbRotate"}, {"index-mcp", "4"}});
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->hands[0].posture, "fist");
  EXPECT_EQ(read->hands[0].value[0], 0.5F);
  EXPECT_EQ(read->hands[0].value[4], 0.25F);
  EXPECT_EQ(std::count(read->measured.begin(), read->measured.end(), true), 2);
  EXPECT_EQ(read->unit, InputUnit::kRadians) << "the battery is not an angle";
  const auto label_alone =
      parseRecording("Symbol,s4\nfist,0.5\n", "f", {}, std::vector<ChosenColumn>{{"posture", "1"}});
  ASSERT_TRUE(label_alone) << label_alone.error().what;
  EXPECT_EQ(label_alone->hands[0].value[4], 0.5F) << "sensors by their names, as always";
  const std::pair<std::vector<ChosenColumn>, const char*> faults[] = {
      {{{"posture", "Sign"}},
       "f:1: found no column \"Sign\" for posture; allowed: 1 to 5, or frame"},
      {{{"posture", "0"}}, "found no column \"0\""},
      {{{"posture", "6"}}, "found no column \"6\""},
      {{{"palm", "3"}},
       "found a column for \"palm\"; allowed: for posture, s0 to s22 or thumb-roll"},
      {{{"posture", "3"}, {"s0", "3"}}, "found column \"ThumbRotate\" as label and as sensor"},
      {{{"posture", "2"}, {"s0", "3"}, {"s0", "4"}}, "found two columns \"IndexInner\""},
      {{{"s0", "3"}}, "found no column for the label"}};
  for (const auto& [chosen, says] : faults) {
    const auto wrong = columns(chosen);
    ASSERT_FALSE(wrong) << says;
    EXPECT_NE(wrong.error().what.find(says), std::string::npos) << wrong.error().what;
  }
}

TEST(Recording, IsItsOwnInverse) {
  Recording recording;
  recording.hands = test::people(hand::shapes(), 1, 2, 3, 1);
  recording.measured.fill(true);
  recording.synthetic = true;
  const std::string text = formatRecording(recording);
  const auto read = parseRecording(text, "f");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->synthetic);
  ASSERT_EQ(read->hands.size(), recording.hands.size());
  for (std::size_t n = 0; n < read->hands.size(); ++n)
    EXPECT_EQ(read->hands[n].value, recording.hands[n].value);
  EXPECT_EQ(formatRecording(*read), text);
}

TEST(Recording, FaultsNameFileLineFoundAndAllowed) {
  EXPECT_EQ(wrongWith("posture,s0\nfist\n"),
            "f.csv:2: found 1 fields; allowed: 2, as many as the header has");
  for (const std::string value : {"x", "nan", "1e30"})
    EXPECT_EQ(wrongWith("posture,s0\nfist," + value + "\n"),
              "f.csv:2: found s0 \"" + value + "\"; allowed: a number from -1000000 to 1000000");
  EXPECT_EQ(wrongWith("posture,s0\n,1\n"),
            "f.csv:2: found posture \"\"; allowed: 1 to 19 letters, digits, - or _");
  EXPECT_EQ(wrongWith("posture,s0,s0\nfist,1,1\n"),
            "f.csv:1: found two columns \"s0\"; allowed: one a sensor");
  EXPECT_EQ(wrongWith("posture,s0\n"),
            "f.csv:1: found no hands; allowed: at least one line after the header");
  EXPECT_NE(wrongWith("a,b\n1,2\n").find("no column for the label"), std::string::npos);
  EXPECT_NE(wrongWith("posture,x,y2\nf,1,2\n").find("2 columns of sensors"), std::string::npos);
  EXPECT_EQ(wrongWith(""),
            "f.csv: found no header, the file is empty; needed are a header and at least one line "
            "after it");
  EXPECT_EQ(wrongWith("# mine\n"),
            "f.csv: found no header; needed are a header and at least one line after it");
}

TEST(Recording, OneWrongByteNeverLoadsHalf) {
  Recording recording;
  recording.hands = test::people(hand::shapes(), 1, 1, 1, 1);
  recording.measured.fill(true);
  const std::string good = formatRecording(recording);
  for (std::size_t at = 0; at < good.size(); at += 3) {
    for (const char c : {'\0', ',', '\n', 'x', '\xFF'}) {
      std::string text = good;
      text[at] = c;
      const auto read = parseRecording(text, "f");
      if (!read) {
        EXPECT_TRUE(read.error().what.starts_with("f:")) << read.error().what;
      }
    }
  }
}

using RecordingFiles = test::FilesTest;

TEST_F(RecordingFiles, AreReplacedWholeOrNotAtAll) {
  Recording recording;
  recording.hands = test::people(hand::shapes(), 1, 1, 2, 1);
  recording.measured.fill(true);
  ASSERT_TRUE(saveRecording(path("a.csv"), recording));
  const std::string before = contentOf(path("a.csv"));
  recording.hands[0].posture = "no posture's name, this";
  EXPECT_FALSE(saveRecording(path("a.csv"), recording));
  EXPECT_EQ(contentOf(path("a.csv")), before);
  EXPECT_EQ(loadRecording(path("none.csv")).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace merlin::nn
