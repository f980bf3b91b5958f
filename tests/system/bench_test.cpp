// Every benchmark whose subject is missing or ends early must fail, name the subject and print no
// figure. The code that benchmarks share for this is tested in tests/bench/figures_test.cpp.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

const std::string kBin = MERLIN_BIN_DIR;
const std::string kBench = MERLIN_SOURCE_DIR "/tests/bench";
const std::string kDemo = MERLIN_SOURCE_DIR "/config/demo.json";
const std::string kScan = MERLIN_SOURCE_DIR "/config/models/ankylosaurus.ply";

struct Said {
  int status;
  std::string output, message;
};

class Bench : public testing::Test {
 protected:
  // Runs the command, its words quoted, and captures standard output and standard error separately.
  Said said(const std::vector<std::string>& command) const {
    std::string line;
    for (const std::string& word : command) line += fmt::format("'{}' ", word);
    const int status =
        run({"/bin/sh", "-c", fmt::format("{} >'{}' 2>'{}'", line, dir_ / "out", dir_ / "err")})
            .status;
    return {status, readText(dir_ / "out"), readText(dir_ / "err")};
  }

  // Expects that `bench` failed with its own message, which contains `words`, and printed no
  // figures.
  void expectNoFigures(const Said& s, const std::string& bench,
                       const std::vector<std::string>& words) const {
    EXPECT_EQ(s.status, 1) << bench;
    EXPECT_EQ(s.output, "") << bench;
    EXPECT_NE(s.message.find("bench " + bench + ": no figures: "), std::string::npos) << s.message;
    for (const std::string& word : words)
      EXPECT_NE(s.message.find(word), std::string::npos) << word << " in: " << s.message;
  }
  // Runs the command without options and with --json, and expects both times that `bench` failed
  // and printed no figures.
  void expectNoFigures(std::vector<std::string> command, const std::string& bench,
                       const std::vector<std::string>& words) const {
    expectNoFigures(said(command), bench, words);
    command.emplace_back("--json");
    expectNoFigures(said(command), bench, words);
  }

  // Makes a program `name` that runs the shell script `script`; returns its folder.
  std::string fake(const std::string& name, const std::string& script) const {
    const std::string folder = dir_ / "fake", path = folder + "/" + name;
    std::filesystem::create_directories(folder);
    writeText(path, "#!/bin/sh\n" + script + "\n");
    EXPECT_EQ(::chmod(path.c_str(), 0755), 0);
    return folder;
  }

  // Returns the path of a copy of the demo's configuration that uses `model`, which need not exist.
  std::string demoOn(const std::string& model) const {
    auto config = nlohmann::json::parse(readText(kDemo));
    config["wall"]["model"] = model;
    config["postures"]["file"] = kSource + "/config/postures.json";
    writeText(dir_ / "demo.json", config.dump());
    return dir_ / "demo.json";
  }

  TempDir dir_;
};

TEST_F(Bench, WallWithoutMerlindOrModelOrConfigurationHasNoFigures) {
  const std::string wall = kBin + "/wall_bench";
  expectNoFigures({wall, "--bin", "/nonexistent", "--config", kDemo}, "wall",
                  {"/nonexistent/merlind", "no such program"});
  expectNoFigures({wall, "--bin", kBin, "--config", demoOn(dir_ / "none.mrm")}, "wall",
                  {"merlind --role all", "it shows none of its contents", "none.mrm"});
  expectNoFigures({wall, "--bin", kBin, "--config", "/nonexistent.json"}, "wall",
                  {"/nonexistent.json is not there"});
}

TEST_F(Bench, WallWhoseMerlindEndsOrPublishesNothingHasNoFigures) {
  const std::string wall = kBin + "/wall_bench";
  for (const char* script : {"echo ready", "echo ready; exec sleep 60"}) {
    expectNoFigures({wall, "--bin", fake("merlind", script), "--config", kDemo}, "wall",
                    {"merlind --role all"});
  }
}

// merlind is killed in the middle of the 30 s measurement, so its shared memory segments are still
// there.
TEST_F(Bench, WallWhoseMerlindDiesWhileItIsMeasuredHasNoFigures) {
  const std::string log = dir_ / "log";
  const std::string bin =
      fake("merlind", fmt::format("'{0}/merlind' \"$@\" >'{1}' 2>&1 & child=$!\n"
                                  "until grep -q 'ready' '{1}'; do sleep 0.1; done\n"
                                  "cat '{1}'; sleep 6; kill -9 $child; wait $child",
                                  kBin, log));
  const Said s = said({kBin + "/wall_bench", "--bin", bin, "--config", demoOn(makeModel(dir_, 5)),
                       "--seconds", "30", "--rounds", "1"});
  expectNoFigures(s, "wall", {"merlind --role all"});
}

TEST_F(Bench, WallThatNeverMovesHasNoFigures) {
  const std::string bin =
      fake("merlind", fmt::format("sed -i 's/\"script\":\"[a-z]*\"/\"script\":\"still\"/' \"$2\"\n"
                                  "exec '{}/merlind' \"$@\"",
                                  kBin));
  const Said s = said({kBin + "/wall_bench", "--bin", bin, "--config", demoOn(makeModel(dir_, 5)),
                       "--seconds", "1", "--rounds", "1"});
  expectNoFigures(s, "wall", {"the wall"});
}

// Without an X server there is no window, and an output that shows nothing has no cost to measure.
TEST_F(Bench, OutputsWithoutAnXServerHaveNoFigures) {
  const std::string bench = kBin + "/outputs_bench";
  if (::access(bench.c_str(), X_OK) != 0) GTEST_SKIP() << "built without SDL2";
  expectNoFigures({"env", "PATH=/nonexistent", bench, "--seconds", "1", "--rounds", "1"}, "outputs",
                  {"Xvfb", "there is no such program"});
}

TEST_F(Bench, LatencyWithoutMerlindHasNoFigures) {
  const std::string latency = kBin + "/latency_bench";
  expectNoFigures({latency, "--bin", "/nonexistent", "--config", kDemo}, "latency",
                  {"/nonexistent/merlind", "no such program"});
  expectNoFigures(
      {latency, "--bin", fake("merlind", "echo no devices >&2; exit 1"), "--config", kDemo},
      "latency", {"it ended before it was ready", "no devices"});
}

TEST_F(Bench, MissingScansTracesAndModelsGiveNoFigures) {
  const std::string none = dir_ / "none";
  expectNoFigures({kBin + "/rate_bench", "--scan", none + ".ply"}, "rates", {"none.ply"});
  expectNoFigures({kBin + "/cut_bench", "--hgt", none, "--out", dir_ / "cut"}, "cut", {none});
  expectNoFigures({kBin + "/governor_bench", "--trace", none}, "governor", {none});
  expectNoFigures({kBin + "/frame_hashes", none + ".mrm"}, "frames", {"none.mrm"});
  expectNoFigures({kBin + "/cut_bench", "--small", "--out", "/proc/none"}, "cut", {"/proc/none"});
}

TEST_F(Bench, HostileShapesOfNoTriangleAreNotReduced) {
  expectNoFigures({kBin + "/hostile_bench", "--triangles", "0", "--turns", "1"}, "hostile", {});
  expectNoFigures({kBin + "/hostile_bench", "--turns", "0"}, "hostile", {"regular mesh"});
}

TEST_F(Bench, AScanOfTooFewTrianglesIsNotThatOfTheRates) {
  writeText(dir_ / "one.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  expectNoFigures({kBin + "/rate_bench", "--scan", dir_ / "one.ply"}, "rates", {"triangles"});
}

TEST_F(Bench, ParsersThatRecoverNothingGiveNoFigures) {
  expectNoFigures({kBin + "/fuzz_bench", "--bytes", "1"}, "fuzz", {"parser", "recovered none"});
}

TEST_F(Bench, SizeWithoutItsProgramsOrScanHasNoFigures) {
  const auto size = [](const std::string& merlin, const std::string& tile_scan,
                       const std::string& scan) {
    return std::vector<std::string>{"python3",  "-B",     kBench + "/size_bench.py",
                                    "--merlin", merlin,   "--tile-scan",
                                    tile_scan,  "--scan", scan,
                                    "--most",   "1e4"};
  };
  const std::string tile_scan = kBin + "/tile_scan";
  expectNoFigures(size("/nonexistent", tile_scan, kScan), "size", {"/nonexistent"});
  expectNoFigures(size(kMerlin, "/nonexistent", kScan), "size", {"/nonexistent"});
  expectNoFigures(size(kMerlin, tile_scan, "/nonexistent.ply"), "size", {"/nonexistent.ply"});
  const std::string idle = fake("idle",
                                "echo '{\"collapses\": 0, \"seconds_all\": 1, "
                                "\"collapses_per_second\": 0, \"peak_memory_mb\": 1, "
                                "\"blocks\": 1}'; : > \"$5\"");
  expectNoFigures(size(idle + "/idle", tile_scan, kScan), "size", {"no collapses"});
}

TEST_F(Bench, AttackWithoutMerlindOrFloodHasNoFigures) {
  const auto attack = [](const std::string& bin) {
    return std::vector<std::string>{"python3",   "-B",       kBench + "/attack/attack.py",
                                    "--bin",     bin,        "--source",
                                    kSource,     "--rounds", "1",
                                    "--seconds", "1",        "pty-newlines"};
  };
  expectNoFigures(attack("/nonexistent"), "attack", {"/nonexistent"});
  std::filesystem::create_directories(dir_ / "fake");
  std::filesystem::create_symlink(kMerlin, dir_ / "fake/merlin");
  expectNoFigures(attack(fake("merlind", "echo no wall >&2; exit 1")), "attack",
                  {"merlind", "it ended", "no wall"});
}

TEST_F(Bench, KillPageAndSoakWithoutMerlindHaveNoFigures) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> benches = {
      {"kill", {"python3", "-B", kBench + "/kill_bench.py", "--times", "1"}},
      {"page", {"python3", "-B", kBench + "/page_bench.py", "--seconds", "1", "--open", "1"}},
      {"soak", {"python3", "-B", kBench + "/soak/soak.py", "60s"}}};
  std::filesystem::create_directories(dir_ / "fake");
  std::filesystem::create_symlink(kMerlin, dir_ / "fake/merlin");
  const std::string ends = fake("merlind", "echo no role >&2; exit 1");
  for (const auto& [name, command] : benches) {
    auto missing = command, ended = command;
    missing.insert(missing.end(), {"--bin", "/nonexistent"});
    expectNoFigures(missing, name, {"/nonexistent/merlind", "no such program"});
    if (name == "kill") continue;  // the kill benchmark waits for READY up to its own deadline
    ended.insert(ended.end(), {"--bin", ends});
    expectNoFigures(ended, name, {"merlind", "it ended", "no role"});
  }
}

TEST_F(Bench, ADurationThatIsNoneIsBadUsage) {
  for (const char* duration : {"", "2x", "-5m", "59s", "h"}) {
    const Said s = said({"python3", "-B", kBench + "/soak/soak.py", "--bin", kBin, "--", duration});
    EXPECT_EQ(s.status, 2) << duration;
    EXPECT_EQ(s.output, "");
    EXPECT_NE(s.message.find("is not a duration of at least 60s"), std::string::npos) << s.message;
  }
}

// Expects only that figures are printed: whether memory is steady cannot be judged after some
// minutes.
nlohmann::json soakOnVirtualTime(const Said& s) {
  const auto object = nlohmann::json::parse(s.output, nullptr, false);
  EXPECT_TRUE(object.is_object()) << s.output;
  return object["figures"];
}

TEST_F(Bench, ADayOnVirtualTimeIsTheSameForTheSameSeed) {
  const auto day = [this](const char* seed) {
    return soakOnVirtualTime(
        said({kBin + "/soak_bench", "--hours", "0.2", "--seed", seed, "--json"}));
  };
  const auto first = day("3"), again = day("3"), other = day("4");
  EXPECT_GE(first["events"]["value"], 8);
  EXPECT_EQ(first["wrong"]["value"], 0);
  for (const char* figure : {"digest", "events", "late_first_hour", "descriptors_last"})
    EXPECT_EQ(first[figure]["value"], again[figure]["value"]) << figure;
  EXPECT_NE(first["digest"]["value"], other["digest"]["value"]);
}

// Expects only that figures are printed: whether they keep their limits depends on the machine.
TEST_F(Bench, AKillOfEachRoleHasFigures) {
  const Said s =
      said({"python3", "-B", kBench + "/kill_bench.py", "--bin", kBin, "--times", "1", "--json"});
  const auto object = nlohmann::json::parse(s.output, nullptr, false);
  ASSERT_TRUE(object.is_object()) << s.message;
  for (const char* figure : {"kill_-9_wall_to_picture.maximum", "kill_-9_devices_to_data.maximum",
                             "start_to_READY_wall.maximum", "start_to_READY_devices.maximum"})
    EXPECT_GT(object["figures"][figure]["value"], 0) << figure << s.output;
}

// Expects only that figures are printed: whether they keep their limits depends on the machine.
TEST_F(Bench, AnAttackThatReachesTheWallHasFigures) {
  const Said s = said({"python3", "-B", kBench + "/attack/attack.py", "--bin", kBin, "--source",
                       kSource, "--rounds", "1", "--seconds", "2", "pty-newlines", "--json"});
  const auto object = nlohmann::json::parse(s.output, nullptr, false);
  ASSERT_TRUE(object.is_object()) << s.message;
  EXPECT_GE(object["figures"]["pty-newlines.merlind.late"]["count"], 1) << s.output;
  EXPECT_GE(object["figures"]["pty-newlines.sink.late"]["count"], 1) << s.output;
}

TEST_F(Bench, ReductionWithoutMerlinHasNoFigures) {
  const auto reduction = [&](const std::string& bin) {
    return std::vector<std::string>{
        "python3",          "-B",     kBench + "/reduction/bench.py", "--bin", bin, "--out",
        dir_ / "reduction", "--quick"};
  };
  expectNoFigures(reduction("/nonexistent"), "reduction", {"/nonexistent/bench/bench_merlin"});
  // The programs exist, but they fail.
  const std::string bin = dir_ / "idle";
  for (const char* name : {"/bench/bench_merlin", "/bin/merlin"}) {
    std::filesystem::create_directories(std::filesystem::path(bin + name).parent_path());
    writeText(bin + name, "#!/bin/sh\necho no room >&2\nexit 1\n");
    ASSERT_EQ(::chmod((bin + name).c_str(), 0755), 0);
  }
  expectNoFigures(reduction(bin), "reduction", {"no mesh to reduce"});
}

TEST_F(Bench, WhatRanIsOneObjectForPrograms) {
  const std::vector<std::vector<std::string>> benches = {
      {kBin + "/torn_bench", "--reads", "1e5", "--kills", "5"},
      {kBin + "/mesh_fuzz_bench", "--count", "100"},
      {kBin + "/fuzz_bench", "--bytes", "1e5"},
      {"python3", "-B", kBench + "/size_bench.py", "--merlin", kMerlin, "--tile-scan",
       kBin + "/tile_scan", "--scan", kScan, "--most", "1e4"}};
  for (auto bench : benches) {
    EXPECT_EQ(said(bench).status, 0);
    bench.emplace_back("--json");
    const Said s = said(bench);
    EXPECT_EQ(s.status, 0) << s.message;
    const auto object = nlohmann::json::parse(s.output, nullptr, false);
    ASSERT_TRUE(object.is_object()) << s.output;
    EXPECT_GE(object["machine"]["cores"], 1);
    EXPECT_GE(object["figures"].size(), 1U) << s.output;
    for (const auto& figure : object["figures"]) EXPECT_GE(figure["count"], 1) << s.output;
  }
}

TEST_F(Bench, ACorrectionIsGivenAsAShareOfAFrameToo) {
  const Said s = said({kBin + "/correct_bench", "--frames", "3", "--json"});
  const auto object = nlohmann::json::parse(s.output, nullptr, false);
  ASSERT_TRUE(object.is_object()) << s.message;
  const auto& figures = object["figures"];
  ASSERT_TRUE(figures.contains("all_per_frame")) << s.output;
  EXPECT_NEAR(figures["all_per_frame"]["value"].get<double>(),
              figures["all_ms"]["value"].get<double>() * 30 / 1000, 1e-4)
      << "of a frame at 30 Hz";
}

}  // namespace
}  // namespace merlin::test
