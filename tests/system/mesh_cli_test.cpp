// `merlin mesh` with formats, repairs and labels: what it prints and what it leaves.
#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class MeshCli : public testing::Test {
 protected:
  nlohmann::json infoOf(const std::string& path) {
    const Outcome info = run({kMerlin, "mesh", "info", path, "--json"});
    EXPECT_EQ(info.status, 0) << info.output;
    return nlohmann::json::parse(info.output);
  }

  TempDir dir_;
  std::string scan_ = kSource + "/config/models/ankylosaurus.ply";
};

TEST_F(MeshCli, ExportsToEveryFormatAndSaysWhatIsLeftOut) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  for (const char* ending : {"ply", "obj", "glb", "gltf", "stl", "iv"}) {
    const std::string out = dir_ / "a." + ending;
    const Outcome done =
        run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--triangles", "1000", "-o", out});
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_NE(done.output.find("1000 triangles"), std::string::npos) << done.output;
    const bool says = done.output.find("no place for colour, normal") != std::string::npos;
    EXPECT_EQ(says, out.ends_with("stl")) << done.output;
    EXPECT_GT(readText(out).size(), 20000u) << ending;
  }
  EXPECT_EQ(infoOf(dir_ / "a.obj")["triangles"], 1000);
}

TEST_F(MeshCli, ExportTakesAnErrorInPercentOrInUnits) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  const double diagonal = infoOf(dir_ / "a.mrm")["diagonal"];
  const auto exported = [&](const std::string& option, double value) {
    const std::string out = dir_ / "a.ply";
    EXPECT_EQ(run({kMerlin, "mesh", "export", dir_ / "a.mrm", option, fmt::format("{}", value),
                   "-o", out})
                  .status,
              0);
    return infoOf(out)["triangles"].get<int>();
  };
  const int half = exported("--error", 0.5);
  EXPECT_GT(half, 100);
  EXPECT_LT(half, 10000);
  EXPECT_EQ(exported("--error-units", diagonal * 0.005), half);
  EXPECT_EQ(run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--error", "1", "--percent", "5", "-o",
                 dir_ / "b.ply"})
                .status,
            2);
}

TEST_F(MeshCli, ExportRefusesAnUnknownEndingBeforeAnyWork) {
  const Outcome refused = run({kMerlin, "mesh", "export", dir_ / "none.mrm", "-o", dir_ / "a.off"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find(".ply, .obj, .glb, .gltf, .stl and .iv"), std::string::npos);
}

}  // namespace
}  // namespace merlin::test
