// merlin posture collect and merlin calibrate glove, run as a person would run them, with an
// emulated glove and with a recording of one.
#include <filesystem>

#include <gtest/gtest.h>

#include "nn/io/data_set_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

std::vector<std::string> collect(Merlind& merlind, const std::string& label,
                                 const std::string& file) {
  return {kMerlin, "posture",   "collect", label,        "-o",
          file,    "--seconds", "0.5",     "--instance", merlind.instance()};
}

std::size_t handsOf(const nn::Recording& recording, const std::string& posture) {
  return static_cast<std::size_t>(
      std::count_if(recording.hands.begin(), recording.hands.end(),
                    [&](const nn::LabelledHand& h) { return h.posture == posture; }));
}

// The emulated hand remains open, whatever posture the command asks for.
TEST(PostureCollect, TakesHandsOfALiveGloveAndWarnsOfTwoThatLookAlike) {
  const TempDir dir;
  Merlind merlind(dir, "", "collect", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("glove", HealthState::kOk));
  const std::string file = dir / "hands.csv";
  const Outcome open = run(collect(merlind, "open", file));
  ASSERT_EQ(open.status, 0) << open.output;
  EXPECT_NE(open.output.find("hold \"open\" for 0.5 s"), std::string::npos) << open.output;
  EXPECT_EQ(open.output.find("warning"), std::string::npos) << open.output;

  const Outcome fist = run(collect(merlind, "fist", file));
  ASSERT_EQ(fist.status, 0) << fist.output;
  EXPECT_NE(fist.output.find("warning: \"fist\" and \"open\" are hard to tell apart"),
            std::string::npos)
      << fist.output;
  const auto recording = nn::loadRecording(file);
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_GT(handsOf(*recording, "open"), 20u);
  EXPECT_GT(handsOf(*recording, "fist"), 20u);
  EXPECT_EQ(recording->unit, nn::InputUnit::kRadians);
  EXPECT_TRUE(recording->measured[5]);
  EXPECT_FALSE(recording->measured[7]) << "no glove has that sensor";
}

TEST(PostureCollect, ShowsTheSensorsAsBarsOnATerminal) {
  const TempDir dir;
  Merlind merlind(dir, "", "bars", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  std::string command;
  for (const std::string& word : collect(merlind, "open", dir / "hands.csv")) command += word + " ";
  const Outcome shown = run({"script", "-qec", command, "/dev/null"});
  EXPECT_EQ(shown.status, 0) << shown.output;
  EXPECT_NE(shown.output.find("index-pip"), std::string::npos) << shown.output;
  EXPECT_NE(shown.output.find("[###"), std::string::npos) << shown.output;
}

TEST(PostureCollect, TakesHandsOfARecording) {
  const TempDir dir;
  Process glove({kMerlin, "emulate", "cyberglove", "--link", dir / "glove", "--script", "still"});
  ASSERT_TRUE(glove.saysEventually("cyberglove on")) << glove.output();
  const Outcome recorded = run({kMerlin, "record", "pty:" + dir / "glove", "--device", "cyberglove",
                                "-o", dir / "glove.bytes", "--seconds", "2"});
  ASSERT_EQ(recorded.status, 0) << recorded.output;
  Merlind merlind(
      dir, "", "replayed",
      {.role = "devices",
       .emulate = false,
       .also = onlyDevice(deviceEntry("glove", "cyberglove", "replay:" + dir / "glove.bytes"))});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("glove", HealthState::kOk)) << merlind.process().output();
  const std::string file = dir / "hands.csv";
  const Outcome open = run(collect(merlind, "open", file));
  ASSERT_EQ(open.status, 0) << open.output << merlind.process().output();
  const auto recording = nn::loadRecording(file);
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_GT(handsOf(*recording, "open"), 20u);
}

TEST(PostureCollect, KeepsTheHandsUntilASignal) {
  const TempDir dir;
  Merlind merlind(dir, "", "kept", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("glove", HealthState::kOk));
  const std::string file = dir / "hands.csv";
  Process process({kMerlin, "posture", "collect", "open", "-o", file, "--seconds", "600",
                   "--instance", merlind.instance()});
  ASSERT_TRUE(process.saysEventually("hold \"open\"")) << process.output();
  const auto& samples = *merlind.devices()->glove("")->samples;
  const std::uint64_t enough = samples.count() + 30;
  ASSERT_TRUE(eventually([&] { return samples.count() >= enough; }));
  EXPECT_EQ(process.kill(SIGINT), 1) << process.output();
  EXPECT_NE(process.output().find("ended by a signal; "), std::string::npos) << process.output();
  const auto recording = nn::loadRecording(file);
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_GT(handsOf(*recording, "open"), 10u);
}

// A fault that prevents the recording is reported before the person is asked to hold the posture.
TEST(PostureCollect, ChecksItsFileAndTheGloveBeforeThePersonHoldsThePosture) {
  const TempDir dir;
  Merlind merlind(dir, "", "checked", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("glove", HealthState::kOk));
  writeText(dir / "columns.csv", "posture,s0\nopen,0.5\n");
  writeText(dir / "other.csv", "a,b\n1,2\n");
  writeText(dir / "counts.csv", "posture,s0\nopen,92\n");
  const auto refuses = [&](std::vector<std::string> words, std::vector<std::string> more,
                           const std::string& why) {
    words.insert(words.end(), more.begin(), more.end());
    const Outcome refused = run(words);
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_NE(refused.output.find(why), std::string::npos) << refused.output;
    EXPECT_EQ(refused.output.find("hold \""), std::string::npos) << refused.output;
  };
  const auto into = [&](const char* file) { return collect(merlind, "open", dir / file); };
  refuses(into("no/such/hands.csv"), {}, "no/such/hands.csv: No such file");
  refuses(into("other.csv"), {}, "other.csv:1: found no column for the label");
  refuses(into("columns.csv"), {}, "columns.csv: was recorded with a glove that has other sensors");
  refuses(into("columns.csv"), {"--units", "raw"},
          "columns.csv: has angles in radians (thumb-roll is 0.5), and --units raw records raw "
          "counts");
  refuses(into("counts.csv"), {},
          "counts.csv: has raw counts (values beyond +-6.3), and --units "
          "rad records radians");
  refuses(into("hands.csv"), {"--device", "left"}, "has no glove named left; its gloves: glove");
  refuses({kMerlin, "posture", "collect", "open", "-o", dir / "hands.csv", "--instance", "nobody"},
          {}, "no merlind with devices runs as \"nobody\"");
  EXPECT_FALSE(std::filesystem::exists(dir / "hands.csv"));
}

TEST(PostureTrain, ChecksItsOutputBeforeItsData) {
  const Outcome refused =
      run({kMerlin, "posture", "train", "/no/such.csv", "-o", "/nowhere/x.json"});
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("/nowhere/x.json: No such file"), std::string::npos)
      << refused.output;
}

TEST(PostureCollect, SaysWhyThereAreNoHands) {
  const TempDir dir;
  Merlind merlind(dir, "", "silent", {.role = "devices", .emulate = false});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  const Outcome silent = run(collect(merlind, "open", dir / "hands.csv"));
  EXPECT_EQ(silent.status, 1) << silent.output;
  EXPECT_NE(silent.output.find("glove has sent nothing for 3 s"), std::string::npos);
  const Outcome name = run(collect(merlind, "two words", dir / "hands.csv"));
  EXPECT_EQ(name.status, 2) << name.output;
  EXPECT_NE(name.output.find("LABEL \"two words\": allowed are 1 to 19 letters"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir / "hands.csv"));
}

// A hand that stays open in all poses does not show the range of its sensors.
TEST(CalibrateGlove, NamesTheSensorsThatDidNotMoveAndLeavesTheFile) {
  const TempDir dir;
  Process glove({kMerlin, "emulate", "cyberglove", "--link", dir / "glove", "--script", "still"});
  ASSERT_TRUE(glove.saysEventually("cyberglove on")) << glove.output();
  const std::string config = dir / "merlin.json";
  writeText(config, "{\"instance\": \"kept\"}");
  const Outcome done = run({kMerlin, "calibrate", "glove", "pty:" + dir / "glove", "-o", config,
                            "--pause", "0.1", "--hold", "0.2"});
  EXPECT_EQ(done.status, 2) << done.output;
  EXPECT_NE(done.output.find("CyberGlove"), std::string::npos) << "who it is: " << done.output;
  EXPECT_NE(done.output.find("fist: "), std::string::npos) << "what to do: " << done.output;
  EXPECT_NE(done.output.find("sensors hardly moved"), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("in \"wrist aside\""), std::string::npos) << done.output;
  EXPECT_EQ(readText(config), "{\"instance\": \"kept\"}");
}

TEST(CalibrateGlove, OpensThePortOfTheConfigurationUnlessOneIsGiven) {
  const TempDir dir;
  Process glove({kMerlin, "emulate", "cyberglove", "--link", dir / "glove", "--script", "still"});
  ASSERT_TRUE(glove.saysEventually("cyberglove on")) << glove.output();
  const std::string config = dir / "merlin.json";
  const auto calibrate = [&](const std::string& port) {
    writeText(config, onlyDevice(deviceEntry("left", "cyberglove", port)).dump());
    return run({kMerlin, "calibrate", "glove", "-o", config, "--pause", "0.1", "--hold", "0.1"});
  };
  const Outcome done = calibrate("pty:" + dir / "glove");
  EXPECT_NE(done.output.find("left: CyberGlove, 22 sensors"), std::string::npos) << done.output;
  const Outcome none = calibrate("");
  EXPECT_EQ(none.status, 2) << none.output;
  EXPECT_NE(none.output.find("/devices/0 (\"left\") has no port: give one on the command line"),
            std::string::npos)
      << none.output;
}

}  // namespace
}  // namespace merlin::test
