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

TEST_F(MeshCli, ExportOfAllResolutionsIsForOpenInventorAlone) {
  const auto exported = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments = {kMerlin, "mesh", "export", scan_, "-o", dir_ / out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(std::move(arguments));
  };
  const Outcome refused = exported("a.ply", {"--multiresolution"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("a.ply: --multiresolution is written as .iv"), std::string::npos)
      << refused.output;
  EXPECT_EQ(exported("a.iv", {"--multiresolution", "--percent", "5"}).status, 2);
  const Outcome done = exported("a.iv", {"--multiresolution"});
  EXPECT_EQ(done.status, 0);
  EXPECT_NE(done.output.find("69636 to 69636 triangles, 1 levels"), std::string::npos)
      << done.output;
}

TEST_F(MeshCli, ReduceKeepsToAStatedMemoryOrRefusesBeforeAnyWork) {
  const auto reduced = [&](const std::string& memory) {
    return run(
        {kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--memory", memory, "--json"});
  };
  const auto reportOf = [](const Outcome& done) {
    EXPECT_EQ(done.status, 0) << done.output;
    return nlohmann::json::parse(done.output.substr(done.output.find("{\"output\"")));
  };
  const nlohmann::json plenty = reportOf(reduced("16G"));
  EXPECT_EQ(plenty["memory_limit_mb"], 16384);
  EXPECT_EQ(plenty["blocks"], 1);
  const nlohmann::json tight = reportOf(reduced("40M"));
  EXPECT_EQ(tight["memory_limit_mb"], 40);
  EXPECT_GT(tight["blocks"], 1);
  ASSERT_EQ(std::remove((dir_ / "a.mrm").c_str()), 0);
  const Outcome refused = reduced("33M");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("34820 vertices and 69636 triangles take 3"), std::string::npos)
      << refused.output;
  EXPECT_NE(refused.output.find("the limit (--memory, else what is free) is 33 MiB"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(readText(dir_ / "a.mrm"), "");
  EXPECT_EQ(reduced("much").status, 2);
}

// A sheet of two triangles at an edge, a fin that stands on it, and of everything that is mended
// one.
constexpr const char* kFin =
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0.5 1 0\n0.5 -1 0\n0.5 0 1\n9 9 9\n"
    "3 0 1 2\n3 1 0 3\n3 0 1 4\n3 1 2 0\n3 2 1 0\n3 1 1 0\n";

TEST_F(MeshCli, InfoAndReduceCountAndNameWhatTheyMended) {
  writeText(dir_ / "fin.ply", kFin);
  const Outcome reduced =
      run({kMerlin, "mesh", "reduce", dir_ / "fin.ply", "-o", dir_ / "a.mrm", "--json"});
  ASSERT_EQ(reduced.status, 0) << reduced.output;
  for (const auto& json :
       {infoOf(dir_ / "fin.ply"),
        nlohmann::json::parse(reduced.output.substr(reduced.output.find("{\"output\"")))}) {
    EXPECT_EQ(json["triangles"], 3);
    EXPECT_EQ(json["degenerate_dropped"], 1);
    EXPECT_EQ(json["duplicates_dropped"], 1);
    EXPECT_EQ(json["opposites_dropped"], 1);
    EXPECT_EQ(json["unused_dropped"], 1);
    EXPECT_EQ(json["non_manifold_edges"], 1);
    EXPECT_EQ(json["non_manifold_vertices"], 2);
    EXPECT_EQ(json["vertices_added"], 2);
  }
  for (const Outcome& text :
       {run({kMerlin, "mesh", "info", dir_ / "fin.ply"}),
        run({kMerlin, "mesh", "reduce", dir_ / "fin.ply", "-o", dir_ / "b.mrm"})}) {
    EXPECT_NE(text.output.find("mended: 1 triangles with a vertex twice dropped, 1 triangles that "
                               "were there twice dropped, 1 triangles on the back of another "
                               "dropped, 1 vertices of no triangle dropped, 1 non-manifold edges "
                               "split, 2 non-manifold vertices split, 2 vertices added by that"),
              std::string::npos)
        << text.output;
  }
  EXPECT_EQ(run({kMerlin, "mesh", "info", scan_}).output.find("mended"), std::string::npos);
}

TEST_F(MeshCli, SaysWhichPictureIsMissing) {
  writeText(dir_ / "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
  const Outcome info = run({kMerlin, "mesh", "info", dir_ / "a.obj"});
  EXPECT_EQ(info.status, 0);
  EXPECT_NE(info.output.find("note: " + (dir_ / "a.mtl") + ": No such file"), std::string::npos)
      << info.output;
}

TEST_F(MeshCli, SegmentsAndDrawsThem) {
  const Outcome done = run({kMerlin, "mesh", "segment", scan_, "-o", dir_ / "a.ply", "--segments",
                            "5", "--weight", "colour=1", "--picture", dir_ / "a.png", "--json"});
  ASSERT_EQ(done.status, 0) << done.output;
  const auto json = nlohmann::json::parse(done.output.substr(done.output.find("{\"output\"")));
  EXPECT_EQ(json["segments"], 5);
  EXPECT_EQ(json["sizes"].size(), 5u);
  EXPECT_EQ(json["vertices"], 34820);
  EXPECT_EQ(readText(dir_ / "a.png").substr(1, 3), "PNG");
  EXPECT_NE(readText(dir_ / "a.ply").find("property int label\n"), std::string::npos);
  ASSERT_EQ(run({kMerlin, "mesh", "segment", scan_, "-o", dir_ / "b.ply", "--segments", "5",
                 "--weight", "colour=1"})
                .status,
            0);
  EXPECT_TRUE(readText(dir_ / "a.ply") == readText(dir_ / "b.ply")) << "the same every time";
  EXPECT_EQ(
      run({kMerlin, "mesh", "segment", scan_, "-o", dir_ / "c.stl", "--segments", "5"}).status, 2);
  EXPECT_EQ(
      run({kMerlin, "mesh", "segment", scan_, "-o", dir_ / "c.ply", "--segments", "0"}).status, 2);
}

}  // namespace
}  // namespace merlin::test
