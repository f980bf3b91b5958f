// What `merlin` prints where all is well, for those who script it.
#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class Cli : public testing::Test {
 protected:
  TempDir dir_;
  std::string scan_ = kSource + "/config/models/ankylosaurus.ply";
};

TEST_F(Cli, ReduceInfoExportAgree) {
  const Outcome reduced = run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--json"});
  ASSERT_EQ(reduced.status, 0) << reduced.output;
  const auto report =
      nlohmann::json::parse(reduced.output.substr(reduced.output.find("{\"output\"")));
  EXPECT_EQ(report["triangles"], 69636);
  EXPECT_GT(report["collapses_per_second"], 0);
  EXPECT_NE(reduced.output.find("collapses/s"), std::string::npos)
      << "progress, also without a terminal";

  const auto info =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a.mrm", "--json"}).output);
  EXPECT_EQ(info["triangles"], 69636);
  EXPECT_EQ(info["vertices"], 34820);
  EXPECT_EQ(info["levels"], report["collapses"].get<int>() + 1);
  EXPECT_EQ(info["features"][0]["name"], "colour");
  EXPECT_EQ(info["box"]["low"].size(), 3u);

  ASSERT_EQ(
      run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--percent", "5", "-o", dir_ / "a5.ply"})
          .status,
      0);
  const auto exported =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a5.ply", "--json"}).output);
  EXPECT_LE(exported["triangles"], 3481);
  EXPECT_GE(exported["triangles"], 3478) << "exact to one collapse";
}

TEST_F(Cli, TheSameInputGivesTheSameBytes) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "b.mrm"}).status, 0);
  EXPECT_TRUE(readText(dir_ / "a.mrm") == readText(dir_ / "b.mrm"));
}

TEST_F(Cli, ReduceStopsWhereItIsTold) {
  const Outcome reduced =
      run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--percent", "50", "--cost",
           "pattern", "--preset", "typical1998", "--preserve-topology"});
  EXPECT_NE(reduced.output.find("(percent)"), std::string::npos) << reduced.output;
}

TEST_F(Cli, PicturesModelsSideBySide) {
  ASSERT_EQ(run({kMerlin, "mesh", "export", scan_, "-o", dir_ / "a.ply"}).status, 0);
  const Outcome picture = run({kMerlin, "mesh", "picture", dir_ / "a.ply", dir_ / "a.ply", "-o",
                               dir_ / "p.png", "--width", "64", "--height", "48"});
  EXPECT_NE(picture.output.find("p.png: 128 x 48"), std::string::npos) << picture.output;
}

// A square of two triangles `height` above the ground, as ASCII PLY.
std::string squarePly(double height) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 {0}\n3 0 {0}\n3 "
      "4 "
      "{0}\n0 4 {0}\n3 0 1 2\n3 0 2 3\n",
      height);
}

// The JSON that ends what a command printed, after its progress.
nlohmann::json jsonOf(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return nlohmann::json::parse(outcome.output.substr(outcome.output.find("{\"")));
}

TEST_F(Cli, CompareMeasuresBothWays) {
  writeText(dir_ / "a.ply", squarePly(0));
  writeText(dir_ / "b.ply", squarePly(0.5));
  const auto c = jsonOf(run(
      {kMerlin, "mesh", "compare", dir_ / "a.ply", dir_ / "b.ply", "--samples", "5000", "--json"}));
  EXPECT_EQ(c["diagonal"], 5);
  for (const auto& part : {c, c["forward"], c["backward"]}) {
    EXPECT_NEAR(part["rms"], 0.5, 1e-12);
    EXPECT_NEAR(part["mean"], 0.5, 1e-12);
    EXPECT_NEAR(part["max_low"], 0.5, 1e-12);
    EXPECT_LE(part["max_high"], 0.5005);
    EXPECT_NEAR(part["rms_percent"], 10, 1e-9);
    EXPECT_LE(part["max_high_percent"], 10.01);
    EXPECT_EQ(part["normal_rms_deg"], 0);
    EXPECT_TRUE(part["colour_rms_255"].is_null());
    EXPECT_EQ(part["features"], nlohmann::json::object());
  }
  EXPECT_GE(c["seconds"], 0);
}

TEST_F(Cli, CompareTakesAResolutionOfAModel) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  const auto error = [&](const std::string& percent) {
    return jsonOf(run({kMerlin, "mesh", "compare", scan_, dir_ / "a.mrm", "--percent", percent,
                       "--samples", "5000", "--width", "1", "--json"}));
  };
  const auto half = error("50"), twentieth = error("5");
  EXPECT_GT(half["rms"], 0);
  EXPECT_GT(twentieth["rms"], 2 * half["rms"].get<double>());
  EXPECT_GT(twentieth["colour_rms_255"], half["colour_rms_255"]);
  EXPECT_NEAR(half["colour_rms_255"], 255 * half["features"]["colour"].get<double>(), 1e-9);
  EXPECT_GT(half["vertex_normal_rms_deg"], 0);
  EXPECT_LE(half["max_high_percent"].get<double>() - half["max_low_percent"].get<double>(), 1);
  const Outcome table = run({kMerlin, "mesh", "compare", scan_, dir_ / "a.mrm", "--percent", "5",
                             "--samples", "5000", "--width", "1"});
  for (const char* word : {"A to B", "RMS", "max, at least", "colour RMS of 255", "points/s"})
    EXPECT_NE(table.output.find(word), std::string::npos) << word;
}

// A row of the curve is what compare says of that resolution.
TEST_F(Cli, CurveSaysWhatCompareSays) {
  const std::string model = dir_ / "a.mrm", csv = dir_ / "a.csv", svg = dir_ / "a<b.svg";
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", model}).status, 0);
  const Outcome done = run({kMerlin, "mesh", "curve", model, "--csv", csv, "--svg", svg,
                            "--samples", "500", "--width", "2"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("max, at most"), std::string::npos);
  std::istringstream rows(readText(csv));
  std::string header, row;
  std::getline(rows, header);
  EXPECT_EQ(header.rfind("triangles,level,estimate,rms,mean,max_low,max_high,", 0), 0u);
  std::getline(rows, row);
  const auto compared =
      jsonOf(run({kMerlin, "mesh", "compare", model, model, "--triangles",
                  row.substr(0, row.find(',')), "--samples", "500", "--width", "2", "--json"}));
  EXPECT_NE(row.find(fmt::format(",{:.9g},", compared["rms"].get<double>())), std::string::npos)
      << row;
  EXPECT_NE(row.find(fmt::format(",{:.9g},", compared["max_high"].get<double>())),
            std::string::npos)
      << row;
  EXPECT_EQ(readText(svg).rfind("<svg ", 0), 0u);
  EXPECT_EQ(run({kMerlin, "mesh", "curve", scan_}).status, 2) << "one resolution has no curve";
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", model, "--percent", "60"}).status, 0);
  const Outcome short_one = run({kMerlin, "mesh", "curve", model, "--csv", csv, "--svg", svg,
                                 "--samples", "500", "--width", "2"});
  EXPECT_EQ(short_one.status, 0) << short_one.output;
  EXPECT_EQ(std::ranges::count(readText(csv), '\n'), 2) << "the coarsest, with a header";
}

TEST_F(Cli, CompareDrawsPictures) {
  const auto changed = [&](const std::string& percent) {
    return jsonOf(run({kMerlin, "mesh", "compare", scan_, dir_ / "a.mrm", "--percent", percent,
                       "--samples", "1000", "--width", "5", "--pictures", dir_ / "new/pictures",
                       "--json"}))["changed_pixels_percent"]
        .get<double>();
  };
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  EXPECT_EQ(changed("100"), 0);
  EXPECT_TRUE(readText(dir_ / "new/pictures/a.png") == readText(dir_ / "new/pictures/b.png"))
      << "from one eye, at one scale";
  const double fifth = changed("20"), hundredth = changed("1");
  EXPECT_GT(fifth, 0);
  EXPECT_GT(hundredth, 2 * fifth);
  EXPECT_LT(hundredth, 100);
  for (const char* name : {"a", "b", "a_wire", "b_wire", "beside", "difference", "edges"})
    EXPECT_EQ(readText(dir_ / fmt::format("new/pictures/{}.png", name)).substr(1, 3), "PNG");
}

TEST_F(Cli, TheShippedPostureNetworkIsTestedOnHeldOutHands) {
  const auto score = nlohmann::json::parse(
      run({kMerlin, "posture", "test", "--network", kSource + "/config/postures.json", "--json"})
          .output);
  EXPECT_EQ(score["total"], 8000);
  EXPECT_GE(score["accuracy"], 0.999);
  EXPECT_EQ(score["synthetic"], true);
}

TEST_F(Cli, EachDeviceIsEmulatedOnALinkThatGoesWithIt) {
  for (const char* device : {"cyberglove", "fastrak", "spaceball"}) {
    Process emulator({kMerlin, "emulate", device, "--link", dir_ / "line", "--script", "still"});
    EXPECT_TRUE(emulator.saysEventually(fmt::format("{} on pty:{}", device, dir_ / "line")))
        << emulator.output();
    EXPECT_TRUE(std::filesystem::is_symlink(dir_ / "line"));
    EXPECT_EQ(emulator.kill(SIGTERM), 0);
    EXPECT_FALSE(std::filesystem::is_symlink(dir_ / "line"));
  }
}

TEST_F(Cli, WatchPrintsALineASecond) {
  Merlind m(dir_, makeModel(dir_, 5), "watch");
  ASSERT_TRUE(m.ready()) << m.process().output();
  const Outcome watched = run({kMerlin, "watch", "--for", "2", "--instance", m.instance()});
  EXPECT_EQ(watched.status, 0) << watched.output;
  const auto lines = std::count(watched.output.begin(), watched.output.end(), '\n');
  EXPECT_GE(lines, 2) << watched.output;
  EXPECT_LE(lines, 5) << watched.output;
  for (const char* word : {"Hz", "triangles", "% late", "posture", "glove", "tracker", "ball"}) {
    EXPECT_NE(watched.output.find(word), std::string::npos) << word;
  }
}

TEST_F(Cli, PrintConfigGivesAConfigurationThatIsValid) {
  const Outcome printed =
      run({kMerlind, "--config", kSource + "/config/wall.json", "--print-config"});
  ASSERT_EQ(printed.status, 0) << printed.output;
  writeText(dir_ / "c.json", printed.output);
  EXPECT_EQ(run({kMerlind, "--check-config", dir_ / "c.json"}).status, 0);
}

}  // namespace
}  // namespace merlin::test
