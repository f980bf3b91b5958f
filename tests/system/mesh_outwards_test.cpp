// The note on closed parts that face inwards, and the option --outwards, in the commands that make
// meshes and models.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "tests/support/meshes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class MeshOutwards : public testing::Test {
 protected:
  MeshOutwards() {
    Mesh mesh = cube();
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
      std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
    writeMeshText(inwards_, mesh);
    writeMeshText(open_, grid(3, 3));
  }

  static void writeMeshText(const std::string& path, const Mesh& mesh) {
    std::string text;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3)
      text += fmt::format("v {} {} {}\n", mesh.positions[i], mesh.positions[i + 1],
                          mesh.positions[i + 2]);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
      text += fmt::format("f {} {} {}\n", mesh.triangles[i] + 1, mesh.triangles[i + 1] + 1,
                          mesh.triangles[i + 2] + 1);
    writeText(path, text);
  }

  static Outcome make(const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {kMerlin, "mesh"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return outcome;
  }
  static nlohmann::json jsonOf(const Outcome& outcome) {
    return nlohmann::json::parse(outcome.output.substr(outcome.output.find("{\"")));
  }
  static nlohmann::json infoOf(const std::string& path) {
    return jsonOf(make({"info", path, "--json"}));
  }

  TempDir dir_;
  std::string inwards_ = dir_ / "in.obj", open_ = dir_ / "open.obj";
  std::string model_ = dir_ / "out.mrm", ply_ = dir_ / "out.ply";
};

TEST_F(MeshOutwards, ReduceAndImportNoteAPartThatFacesInwards) {
  for (const char* const command : {"reduce", "import"}) {
    const Outcome made = make({command, inwards_, "-o", model_, "--json"});
    EXPECT_NE(made.output.find("merlin: note: " + inwards_ +
                               ": 1 of 1 closed parts faces inwards, so that its inside would be "
                               "seen; --outwards turns it\n"),
              std::string::npos)
        << made.output;
    EXPECT_EQ(jsonOf(made)["parts_inwards"], 1);
    EXPECT_EQ(jsonOf(made)["triangles_turned"], 0);
    const auto info = infoOf(model_);
    EXPECT_EQ(info["odd"]["inside_out"], 1);
    EXPECT_EQ(info["volume"], -8.0);
  }
}

TEST_F(MeshOutwards, TheOptionTurnsIt) {
  for (const char* const command : {"reduce", "import"}) {
    const Outcome made = make({command, inwards_, "-o", model_, "--outwards", "--json"});
    EXPECT_NE(made.output.find(
                  "in.obj: 1 of 1 closed parts faced inwards and was turned: 12 triangles\n"),
              std::string::npos)
        << made.output;
    EXPECT_EQ(jsonOf(made)["triangles_turned"], 12);
    const auto info = infoOf(model_);
    EXPECT_EQ(info["odd"]["inside_out"], 0);
    EXPECT_EQ(info["volume"], 8.0);
  }
}

// The first normal is that of the vertex at (-1, -1, -1).
TEST_F(MeshOutwards, NormalsThatWereMadeOfTheTrianglesAreTurnedWithThem) {
  const auto normalsOf = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"import", inwards_, "-o", dir_ / "out.obj"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    make(arguments);
    const std::string text = readText(dir_ / "out.obj");
    return text.substr(text.find("vn "), 8);
  };
  EXPECT_EQ(normalsOf({}), "vn 0.577");
  EXPECT_EQ(normalsOf({"--outwards"}), "vn -0.57");
}

TEST_F(MeshOutwards, NothingIsSaidOfAnOpenSurfaceUnlessItIsToBeTurned) {
  EXPECT_EQ(make({"import", open_, "-o", ply_}).output.find("inwards"), std::string::npos);
  EXPECT_EQ(make({"reduce", open_, "-o", model_}).output.find("inwards"), std::string::npos);
  const Outcome asked = make({"import", open_, "-o", ply_, "--outwards"});
  EXPECT_NE(asked.output.find("open.obj: no part is closed; --outwards turned nothing\n"),
            std::string::npos)
      << asked.output;
}

// Reading the file is counted with 99 bytes per triangle, which leaves 12 bytes per triangle for
// the search.
TEST_F(MeshOutwards, TrianglesThatShareNoVerticesAreNotExaminedWithTooLittleMemory) {
  constexpr std::uint32_t kTriangles = 100'000;
  std::string soup = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      3 * kTriangles, kTriangles);
  for (std::uint32_t v = 0; v < 3 * kTriangles; ++v) {
    for (const std::uint32_t x : {v / 3, v % 3 == 1 ? 1U : 0U, v % 3 == 2 ? 1U : 0U})
      appendLeFloat(soup, static_cast<float>(x));
  }
  for (std::uint32_t t = 0; t < kTriangles; ++t) {
    soup += '\3';
    for (std::uint32_t v = 3 * t; v < 3 * t + 3; ++v) appendLe32(soup, v);
  }
  const std::string file = dir_ / "soup.ply";
  writeText(file, soup);
  const Outcome made = make({"import", file, "-o", ply_, "--memory", "44M", "--json"});
  EXPECT_NE(made.output.find("soup.ply: whether closed parts face inwards was not examined, since "
                             "that takes more than the 4 MiB that the limit (--memory, by default "
                             "the free memory) leaves\n"),
            std::string::npos)
      << made.output;
  EXPECT_TRUE(jsonOf(made)["parts_inwards"].is_null());
  EXPECT_EQ(make({"import", file, "-o", ply_, "--memory", "80M"}).output.find("examined"),
            std::string::npos);
  const Outcome refused = run(
      {kMerlin, "mesh", "import", file, "-o", dir_ / "none.ply", "--outwards", "--memory", "44M"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.output.find("soup.ply: finding the parts that --outwards turns takes more than "
                                "the 4 MiB that the limit"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(readText(dir_ / "none.ply"), "");
}

TEST_F(MeshOutwards, FuseTakesTheOptionAndShowRefusesItForANameOfAContent) {
  std::string pgm = "P5\n# geometry: orthogonal\n# angles: 60 40\n# scale: 0.001\n8 6\n255\n";
  pgm.append(48, '\x64');
  writeText(dir_ / "scan.pgm", pgm);
  const auto fused = jsonOf(make({"fuse", dir_ / "scan.pgm", "-o", ply_, "--outwards", "--json"}));
  EXPECT_EQ(fused["parts_inwards"], 0);
  EXPECT_EQ(fused["triangles_turned"], 0);
  const Outcome shown = run({kMerlin, "show", "desk", "--outwards"});
  EXPECT_EQ(shown.status, 2);
  EXPECT_NE(shown.output.find("desk: --outwards is for files"), std::string::npos) << shown.output;
}

}  // namespace
}  // namespace merlin::test
