// merlin gesture, run as a person would run it, on recordings of an emulated hand and of synthetic
// people.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "nn/io/path_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

TEST(GestureRecord, TakesPosesOfALiveHandAndAppendsThem) {
  const TempDir dir;
  Merlind merlind(dir, "", "gestures", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("tracker", HealthState::kOk));
  const std::string file = dir / "takes.csv";
  ASSERT_TRUE(nn::savePaths(file, {{"wave"}, {{0, {}}}}));
  const auto record = [&](const std::string& label) {
    return run({kMerlin, "gesture", "record", label, "-o", file, "--times", "2", "--seconds", "0.5",
                "--pause", "0.6", "--instance", merlind.instance()});
  };
  const Outcome none = record("none");
  ASSERT_EQ(none.status, 0) << none.output;
  EXPECT_NE(none.output.find("now: none"), std::string::npos) << none.output;
  const auto recording = nn::loadPaths(file);
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_EQ(recording->labels, (std::vector<std::string>{"wave", "none"}));
  EXPECT_GT(recording->poses.size(), 50u);
  EXPECT_EQ(nn::sessionsOf(*recording).size(), 3u) << "a session for each take";
  // The emulated hand is 0.6 m from the transmitter, to the right and above: along z, -x, -y.
  EXPECT_NEAR(recording->poses.back().pose.position_m[2], 0.6, 0.05);
  const Outcome wave = record("wave");
  EXPECT_EQ(wave.status, 2) << "a hand that rests makes no gesture: " << wave.output;
  EXPECT_NE(wave.output.find("this take cannot be used: the hand made no stroke: it moved 0 cm"),
            std::string::npos)
      << wave.output;
  EXPECT_NE(wave.output.find("hand \"hand\": 5 takes in a row could not be used"),
            std::string::npos)
      << wave.output;
  EXPECT_EQ(nn::loadPaths(file)->poses.size(), recording->poses.size());
  const Outcome name = record("two words");
  EXPECT_EQ(name.status, 2) << name.output;
  EXPECT_NE(name.output.find("LABEL \"two words\": allowed are 1 to 31 letters"), std::string::npos)
      << name.output;
}

TEST(GestureRecord, KeepsTheTakesUntilASignalAndChecksItsFileBeforeTheFirst) {
  const TempDir dir;
  Merlind merlind(dir, "", "kept", {.script = "still", .role = "devices"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("tracker", HealthState::kOk));
  const auto record = [&](const std::string& file) {
    return std::vector<std::string>{
        kMerlin, "gesture",   "record", "none",    "-o",  file,         "--times",
        "100",   "--seconds", "0.5",    "--pause", "0.6", "--instance", merlind.instance()};
  };
  const std::string file = dir / "takes.csv";
  Process process(record(file));
  ASSERT_TRUE(process.saysEventually("3 of 100")) << process.output();
  EXPECT_EQ(process.kill(SIGINT), 1) << process.output();
  EXPECT_NE(process.output().find("ended by a signal; 2 of 100 takes were recorded"),
            std::string::npos)
      << process.output();
  const auto recording = nn::loadPaths(file);
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_EQ(nn::sessionsOf(*recording).size(), 2u);

  writeText(dir / "other.csv", "a,b\n1,2\n");
  for (const std::string& wrong : {dir / "no/such/takes.csv", dir / "other.csv"}) {
    const Outcome refused = run(record(wrong));
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_NE(refused.output.find(wrong), std::string::npos) << refused.output;
    EXPECT_EQ(refused.output.find("hold the hand still"), std::string::npos) << refused.output;
  }
}

// The hands and their tracker have other names than in the default configuration.
TEST(GestureRecord, TakesTheFirstHandOrTheNamedOneWhateverTheyAreCalled) {
  using nlohmann::json;
  const TempDir dir;
  const json hands = {{{"name", "right"}, {"station", 1}}, {{"name", "left"}, {"station", 2}}};
  Merlind merlind(
      dir, "", "gestures",
      {.script = "still",
       .role = "devices",
       .also = {{"devices", json::array({deviceEntry("eyes", "fastrak")})}, {"hands", hands}}});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("eyes", HealthState::kOk));
  const auto record = [&](const std::string& hand) {
    std::vector<std::string> words = {kMerlin,      "gesture",
                                      "record",     "none",
                                      "-o",         dir / ("takes" + hand + ".csv"),
                                      "--times",    "1",
                                      "--seconds",  "0.5",
                                      "--pause",    "0.6",
                                      "--instance", merlind.instance()};
    if (!hand.empty()) words.insert(words.end(), {"--hand", hand});
    return run(words);
  };
  for (const char* hand : {"", "left"}) {
    const Outcome taken = record(hand);
    EXPECT_EQ(taken.status, 0) << taken.output;
    EXPECT_TRUE(nn::loadPaths(dir / (std::string("takes") + hand + ".csv"))) << hand;
  }
  const Outcome none = record("hand");
  EXPECT_EQ(none.status, 2) << none.output;
  EXPECT_NE(none.output.find("has no hand named \"hand\"; its hands are right, left"),
            std::string::npos)
      << none.output;
}

TEST(GestureRecord, SaysWhereTheStationOfASilentHandStands) {
  using nlohmann::json;
  const TempDir dir;
  const json hands = {{{"name", "right"}, {"station", 1}}, {{"name", "left"}, {"station", 2}}};
  Merlind merlind(
      dir, "", "silent",
      {.role = "devices",
       .emulate = false,
       .also = {{"devices", json::array({deviceEntry("eyes", "fastrak")})}, {"hands", hands}}});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  const Outcome silent = run({kMerlin, "gesture", "record", "wave", "-o", dir / "takes.csv",
                              "--pause", "4", "--hand", "left", "--instance", merlind.instance()});
  EXPECT_EQ(silent.status, 1) << silent.output;
  EXPECT_NE(silent.output.find("the hand \"left\" has sent nothing for 3 s"), std::string::npos)
      << silent.output;
  EXPECT_NE(silent.output.find("/hands/1/station"), std::string::npos) << silent.output;
  const Outcome nobody = run({kMerlin, "gesture", "record", "wave", "-o", dir / "takes.csv",
                              "--instance", privateName("nobody")});
  EXPECT_EQ(nobody.status, 2) << nobody.output;
  EXPECT_NE(nobody.output.find("no merlind with devices runs as"), std::string::npos)
      << nobody.output;
}

TEST(GestureTrain, LearnsFromTakesAndIsTestedOnOthers) {
  const TempDir dir;
  const auto synthesize = [&](const char* file, const char* first) {
    return run({kMerlin, "gesture", "synthesize", "-o", dir / file, "--people", "4", "--times", "4",
                "--first", first, "--ordinary", "120"});
  };
  ASSERT_EQ(synthesize("train.csv", "1").status, 0);
  ASSERT_EQ(synthesize("test.csv", "701").status, 0);
  const Outcome trained =
      run({kMerlin, "gesture", "train", dir / "train.csv", "-o", dir / "g.json"});
  ASSERT_EQ(trained.status, 0) << trained.output;
  EXPECT_NE(trained.output.find("10 gestures from 1"), std::string::npos) << trained.output;
  const Outcome tested =
      run({kMerlin, "gesture", "test", dir / "g.json", dir / "test.csv", "--json"});
  ASSERT_EQ(tested.status, 0) << tested.output;
  const auto json = nlohmann::json::parse(tested.output);
  EXPECT_EQ(json["takes"], 160);
  EXPECT_GT(json["accuracy"], 0.5);
  EXPECT_EQ(json["synthetic"], true);
  EXPECT_EQ(json["gestures"].size(), 10u);
  const Outcome wrong = run({kMerlin, "gesture", "train", dir / "g.json", "-o", dir / "h.json"});
  EXPECT_EQ(wrong.status, 2) << wrong.output;
  EXPECT_NE(wrong.output.find("g.json:1: found the header"), std::string::npos) << wrong.output;
  EXPECT_FALSE(std::filesystem::exists(dir / "h.json"));
}

TEST(GestureTrain, ChecksItsOutputBeforeItsData) {
  const Outcome refused =
      run({kMerlin, "gesture", "train", "/no/such.csv", "-o", "/nowhere/g.json"});
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("/nowhere/g.json: No such file"), std::string::npos)
      << refused.output;
}

TEST(GestureTrain, SaysThatTheHandRestedInTheOrdinaryMotion) {
  const TempDir dir;
  nn::PathRecording rest{{"none"}, {}};
  for (std::int64_t n = 0; n < 100; ++n) rest.poses.push_back({0, {n * 30'000'000}});
  ASSERT_TRUE(nn::savePaths(dir / "rest.csv", rest));
  Process training({kMerlin, "gesture", "train", dir / "rest.csv", "-o", dir / "g.json"});
  EXPECT_TRUE(training.saysEventually(
      "rest.csv: its ordinary motion (the label none) has no stroke to learn from, so the ordinary "
      "motion of 40 synthetic people is used"))
      << training.output();
}

}  // namespace
}  // namespace merlin::test
