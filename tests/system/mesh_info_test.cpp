// merlin mesh info: what it reports about files of every kind.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {
namespace {

const std::string kInfoMerlin = MERLIN_BIN_DIR "/merlin";

class MeshInfo : public testing::Test {
 protected:
  nlohmann::json infoOf(const std::string& path) {
    const Outcome info = run({kInfoMerlin, "mesh", "info", path, "--json"});
    EXPECT_EQ(info.status, 0) << info.output;
    const std::size_t json = info.output.find("{\"file\"");
    return nlohmann::json::parse(info.output.substr(json), nullptr, false);
  }

  // Writes a square pyramid without its base, and a vertex with a feature, as a PLY file.
  std::string roof() {
    writeText(dir_ / "roof.ply",
              "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
              "property float z\nproperty float heat\nelement face 4\n"
              "property list uchar int vertex_indices\nend_header\n"
              "0 0 0 20\n2 0 0 21\n2 2 0 22\n0 2 0 23\n1 1 1 40\n"
              "3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n");
    return dir_ / "roof.ply";
  }

  TempDir dir_;
};

TEST_F(MeshInfo, APointCloudIsCountedWithoutASurface) {
  writeText(dir_ / "cloud", "500000.5 1 2 7\n500001 1 2 8\n500001 1 2 9\n500001 5 2 9\n");
  const auto info = infoOf(dir_ / "cloud");
  EXPECT_EQ(info["format"], "XYZ text");
  EXPECT_EQ(info["triangles"], 0);
  EXPECT_EQ(info["cloud"]["points"], 4);
  EXPECT_EQ(info["cloud"]["coincident"], 1);
  EXPECT_EQ(info["cloud"]["origin"], (std::vector<double>{500'000, 0, 0}));
  EXPECT_EQ(info["box"]["low"], (std::vector<double>{0.5, 1, 2}));
  EXPECT_EQ(info["box"]["high"], (std::vector<double>{1, 5, 2}));
  ASSERT_EQ(info["features"].size(), 1U);
  EXPECT_EQ(info["features"][0]["name"], "intensity");
  EXPECT_EQ(info["features"][0]["range"], (std::vector<double>{7, 9}));
}

TEST_F(MeshInfo, AMeshHasHolesAndRanges) {
  const auto info = infoOf(roof());
  EXPECT_EQ(info["format"], "mesh");
  EXPECT_EQ(info["vertices"], 5);
  EXPECT_EQ(info["components"], 1);
  EXPECT_EQ(info["closed_components"], 0);
  EXPECT_EQ(info["holes"]["count"], 1);
  EXPECT_EQ(info["holes"]["length"], 8.0);
  ASSERT_EQ(info["features"].size(), 1u) << "no normals, which the file has not";
  EXPECT_EQ(info["features"][0]["name"], "heat");
  EXPECT_EQ(info["features"][0]["range"], nlohmann::json({20.0, 40.0}));
  for (const auto& [what, count] : info["odd"].items()) EXPECT_EQ(count, 0) << what;
}

TEST_F(MeshInfo, AModelHasThoseOfItsFinestLevel) {
  ASSERT_EQ(run({kInfoMerlin, "mesh", "reduce", roof(), "-o", dir_ / "roof.mrm"}).status, 0);
  const auto info = infoOf(dir_ / "roof.mrm");
  EXPECT_EQ(info["format"], "multiresolution model");
  EXPECT_EQ(info["triangles"], 4);
  EXPECT_EQ(info["holes"]["length"], 8.0);
  EXPECT_EQ(info["features"][0]["range"], nlohmann::json({20.0, 40.0}));
}

TEST_F(MeshInfo, ARangeImageHasRowsColumnsAndReturns) {
  writeText(dir_ / "map.asc",
            "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9\n"
            "1 2 3 4\n1 2 3 -9\n1 2 3 4\n");
  const auto info = infoOf(dir_ / "map.asc");
  EXPECT_EQ(info["image"]["columns"], 4);
  EXPECT_EQ(info["image"]["rows"], 3);
  EXPECT_EQ(info["image"]["returns"], 11);
  EXPECT_EQ(info["image"]["geometry"], "elevation");
  EXPECT_EQ(info["holes"]["count"], 1);
  const Outcome text = run({kInfoMerlin, "mesh", "info", dir_ / "map.asc"});
  EXPECT_NE(text.output.find("4 columns x 3 rows, 11 pixels with a return"), std::string::npos)
      << text.output;
}

TEST_F(MeshInfo, TakesTheScaleOfARangeImageAndALimitOfMemory) {
  const std::string file = dir_ / "a.pgm";
  writeText(file, "P5\n# angles: 40 30\n4 4\n255\n" + std::string(16, '\x64'));
  EXPECT_EQ(infoOf(file)["unit"], "") << "nothing says it";
  const auto scaled = run({kInfoMerlin, "mesh", "info", file, "--json", "--scale", "0.01"});
  ASSERT_EQ(scaled.status, 0) << scaled.output;
  const auto info = nlohmann::json::parse(scaled.output);
  EXPECT_EQ(info["unit"], "m");
  EXPECT_LT(info["diagonal"], 2);
  const auto small = run({kInfoMerlin, "mesh", "info", file, "--memory", "1k"});
  EXPECT_EQ(small.status, 2) << small.output;
  EXPECT_NE(small.output.find("the limit (--memory"), std::string::npos) << small.output;
}

TEST_F(MeshInfo, OfAFileThatIsAbsentItSaysThat) {
  for (const char* const name : {"absent", "absent.ply", "absent.mrm"}) {
    const Outcome info = run({kInfoMerlin, "mesh", "info", dir_ / name});
    EXPECT_EQ(info.status, 2) << info.output;
    EXPECT_EQ(info.output, "merlin: " + (dir_ / name) + ": No such file or directory\n");
  }
}

TEST_F(MeshInfo, WritesNothing) {
  const std::string file = roof();
  infoOf(file);
  const std::filesystem::directory_iterator folder(dir_.path());
  EXPECT_EQ(std::distance(folder, {}), 1);
}

TEST_F(MeshInfo, OptionsForRangeImagesAreForThose) {
  const Outcome refused = run({kInfoMerlin, "mesh", "info", roof(), "--angles", "60", "45"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("roof.ply: --angles is for range images"), std::string::npos)
      << refused.output;
  const Outcome scaled = run({kInfoMerlin, "mesh", "info", roof(), "--scale", "2"});
  EXPECT_NE(scaled.output.find("roof.ply: --scale is for range images"), std::string::npos)
      << scaled.output;
}

}  // namespace
}  // namespace merlin::test
