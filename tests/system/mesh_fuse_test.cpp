// `merlin mesh fuse` on scans made by `merlin mesh scan`: the result is near the model, and each
// refusal has a message.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class MeshFuse : public testing::Test {
 protected:
  MeshFuse() {
    const Mesh ball = sphere(4);
    std::string text;
    for (std::size_t i = 0; i < ball.positions.size(); i += 3)
      text += fmt::format("v {} {} {}\n", ball.positions[i], ball.positions[i + 1],
                          ball.positions[i + 2]);
    for (std::size_t i = 0; i < ball.triangles.size(); i += 3)
      text += fmt::format("f {} {} {}\n", ball.triangles[i] + 1, ball.triangles[i + 1] + 1,
                          ball.triangles[i + 2] + 1);
    writeText(model_, text);
  }
  // Makes twelve scans around the model, four at each of three heights; returns the files.
  std::vector<std::string> scanned() {
    std::vector<std::string> files;
    for (int i = 0; i < 12; ++i) {
      const double yaw = 1.5708 * i, y = 3.0 * (i / 4 - 1);
      files.push_back(dir_ / fmt::format("scan{}.pgm", i));
      const Outcome scan =
          run({kMerlin, "mesh", "scan", model_, "--width", "80", "--height", "60", "--camera",
               fmt::format("{:.3f}", 4 * std::cos(yaw)), fmt::format("{:.3f}", y),
               fmt::format("{:.3f}", 4 * std::sin(yaw)), "-o", files.back()});
      EXPECT_EQ(scan.status, 0) << scan.output;
    }
    return files;
  }
  Outcome fuse(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {kMerlin, "mesh", "fuse"});
    return run(std::move(arguments));
  }
  static nlohmann::json jsonOf(const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const auto start = outcome.output.find("{\"");
    return start == std::string::npos ? nlohmann::json()
                                      : nlohmann::json::parse(outcome.output.substr(start));
  }

  TempDir dir_;
  std::string model_ = dir_ / "ball.obj", out_ = dir_ / "out.ply";
};

TEST_F(MeshFuse, TwelveScansOfAModelGiveItBackClosed) {
  auto arguments = scanned();
  arguments.insert(arguments.end(), {"--voxel", "0.08", "--close", "-o", out_, "--json"});
  const auto json = jsonOf(fuse(arguments));
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["measured_vertices"], json["vertices"]);
  EXPECT_EQ(json["vertices"].get<long>() - json["triangles"].get<long>() / 2, 2) << "one sphere";
  const auto c = jsonOf(run(
      {kMerlin, "mesh", "compare", model_, out_, "--samples", "5000", "--width", "0.2", "--json"}));
  EXPECT_LT(c["max_high"], 0.5 * 0.08) << "half a voxel";
  EXPECT_GT(c["max_high"], 0);
}

TEST_F(MeshFuse, RefusesScansThatDoNotSayWhereTheyStood) {
  const std::string scan = "P5\n# angles: 40 30\n4 4\n255\n" + std::string(16, '\x64');
  writeText(dir_ / "a.pgm", scan);
  writeText(dir_ / "b.pgm", scan);
  const Outcome refused = fuse({dir_ / "a.pgm", dir_ / "b.pgm", "-o", out_});
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("key camera"), std::string::npos) << refused.output;
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(MeshFuse, TakesTheOptionsOfAnImportForAllScans) {
  const std::string scan = dir_ / "a.pgm", pose = dir_ / "pose.txt";
  writeText(scan, "P5\n# feature: heat=absent.pgm\n8 8\n255\n" + std::string(64, '\x64'));
  writeText(pose, "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  const Outcome bare = fuse({scan, "--pose", pose, "-o", out_});
  EXPECT_EQ(bare.status, 2);
  EXPECT_NE(bare.output.find("the angles of the image are not known"), std::string::npos)
      << bare.output;
  const Outcome done = fuse({scan, "--pose", pose, "--angles", "40", "30", "--scale", "0.01",
                             "--spikes", "5%", "-o", out_});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("the feature is left out (put it where the image names it)"),
            std::string::npos)
      << done.output;
  const auto info = jsonOf(run({kMerlin, "mesh", "info", out_, "--json"}));
  EXPECT_NEAR(info["box"]["high"][2], -0.86, 0.1) << "1 m away, not 100";
  const Outcome gone = fuse(
      {scan, "--pose", pose, "--angles", "40", "30", "--between", "1", "2", "-o", dir_ / "b.ply"});
  EXPECT_NE(gone.output.find("the filters removed all of its 64 returns"), std::string::npos)
      << gone.output;
  const Outcome taken = fuse({"--angles", dir_ / "beams.txt", scan, "-o", dir_ / "b.ply"});
  EXPECT_EQ(taken.status, 2);
  EXPECT_NE(taken.output.find(scan + ": is taken for a value of --angles"), std::string::npos)
      << taken.output;
}

TEST_F(MeshFuse, KeepsTheOriginAndWhatTheScansSayOfTheirFeatures) {
  const auto scan = [&](const std::string& name, const std::string& unit, double most) {
    writeText(dir_ / name + ".heat.pgm",
              fmt::format("P5\n# unit: {}\n# minimum: 10\n# maximum: {}\n8 8\n255\n", unit, most) +
                  std::string(64, '\x32'));
    writeText(dir_ / name + ".pgm",
              "P5\n# angles: 40 30\n# scale: 0.01\n# feature: heat=" + name +
                  ".heat.pgm\n# camera: 1 0 0 450000.25 0 1 0 5400000.5 0 0 1 7\n8 8\n255\n" +
                  std::string(64, '\x64'));
    return dir_ / name + ".pgm";
  };
  const std::string a = scan("a", "degC", 50), b = scan("b", "degC", 61), c = scan("c", "K", 50);
  const std::string model = dir_ / "out.mrm";
  const auto json = jsonOf(fuse({a, b, "-o", model, "--json"}));
  EXPECT_EQ(json["origin"], nlohmann::json({450000.0, 5400000.0, 0.0}));
  const auto info = jsonOf(run({kMerlin, "mesh", "info", model, "--json"}));
  const std::string about = info["about"];
  EXPECT_NE(about.find("mesh.origin=450000 5400000 0"), std::string::npos) << about;
  EXPECT_NE(about.find("feature.heat.unit=degC\nfeature.heat.range=10 61\n"), std::string::npos)
      << about;
  EXPECT_EQ(info["unit"], "m");
  EXPECT_NEAR(info["box"]["high"][2], 7 - 0.86, 0.1);
  EXPECT_LT(info["box"]["high"][0], 2) << "relative to the origin";
  const auto mesh = jsonOf(fuse({a, b, "-o", dir_ / "out.obj", "--json"}));
  EXPECT_EQ(mesh["origin_added"], true);
  EXPECT_NE(readText(dir_ / "out.obj").find("\nv 45000"), std::string::npos);
  EXPECT_EQ(jsonOf(fuse({a, b, "-o", dir_ / "out.obj", "--local", "--json"}))["origin_added"],
            false);
  EXPECT_EQ(readText(dir_ / "out.obj").find("\nv 45000"), std::string::npos);
  const Outcome mixed = fuse({a, c, "-o", out_});
  EXPECT_EQ(mixed.status, 0) << mixed.output;
  EXPECT_NE(mixed.output.find("the scans give the feature heat in different units"),
            std::string::npos)
      << mixed.output;
}

TEST_F(MeshFuse, TakesPosesFromFilesOfTheirOwn) {
  const std::string scan = dir_ / "a.pgm", pose = dir_ / "pose.txt";
  writeText(scan, "P5\n# angles: 40 30\n8 8\n255\n" + std::string(64, '\x64'));
  writeText(pose, "1 0 0 1000\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(fuse({scan, "--pose", pose, "-o", out_}).status, 0);
  const auto info = jsonOf(run({kMerlin, "mesh", "info", out_, "--json"}));
  EXPECT_GT(info["box"]["low"][0], 900);
  writeText(pose, "1 0 0 1000\n0 1 0 0\n0 0 1\n");
  const Outcome short_one = fuse({scan, "--pose", pose, "-o", dir_ / "b.ply"});
  EXPECT_EQ(short_one.status, 2);
  EXPECT_NE(short_one.output.find("is not a pose"), std::string::npos) << short_one.output;
  writeText(pose, "2 0 0 0\n0 1 0 0\n0 0 1 0\n");
  EXPECT_NE(fuse({scan, "--pose", pose, "-o", dir_ / "b.ply"}).output.find("not a rotation"),
            std::string::npos);
  EXPECT_NE(fuse({scan, scan, "--pose", pose, "-o", out_}).output.find("1 files for 2 scans"),
            std::string::npos);
}

}  // namespace
}  // namespace merlin::test
