// `merlin mesh import` on small synthetic files: what it makes, what it says, and what it refuses.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class MeshImport : public testing::Test {
 protected:
  MeshImport() {
    // 8 x 6 pixels, 16 bits, 2 m away; the last pixel has no return.
    std::string pixels;
    for (int i = 0; i < 48; ++i) appendBe16(pixels, static_cast<std::uint16_t>(i < 47 ? 2000 : 0));
    writeText(scan_, kHeader + "8 6\n65535\n" + pixels);
    writeText(dir_ / "colour.ppm", "P6\n8 6\n255\n" + std::string(3 * 48, '\xff'));
    std::string confidence;
    for (int i = 0; i < 48; ++i) confidence.push_back(static_cast<char>(i));
    writeText(dir_ / "confidence.pgm", "P5\n8 6\n255\n" + confidence);
  }

  Outcome import(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {kMerlin, "mesh", "import"});
    return run(std::move(arguments));
  }
  nlohmann::json report(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Outcome outcome = import(std::move(arguments));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const auto start = outcome.output.find("{\"input\"");
    return start == std::string::npos ? nlohmann::json()
                                      : nlohmann::json::parse(outcome.output.substr(start));
  }
  // The message of an import that is refused, and that leaves nothing behind.
  std::string refusal(std::vector<std::string> arguments) {
    const Outcome outcome = import(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path()))
      EXPECT_FALSE(entry.path().filename().string().starts_with("out")) << entry.path();
    return outcome.output;
  }
  void expectRefusal(std::vector<std::string> arguments, const std::string& with) {
    const std::string text = refusal(std::move(arguments));
    EXPECT_NE(text.find(with), std::string::npos) << text;
  }

  TempDir dir_;
  const std::string kHeader =
      "P5\n# synthetic\n# geometry: orthogonal\n# angles: 60 40\n# scale: 0.001\n";
  std::string scan_ = dir_ / "scan.pgm", ply_ = dir_ / "out.ply";
};

TEST_F(MeshImport, ARangeImageBecomesAMeshWithItsFeatures) {
  const auto json = report({scan_, "--feature", "colour=" + (dir_ / "colour.ppm"), "--feature",
                            "confidence=" + (dir_ / "confidence.pgm"), "--border", "-o", ply_});
  EXPECT_EQ(json["format"], "PGM");
  EXPECT_EQ(json["geometry"], "orthogonal");
  EXPECT_EQ(json["returns"], 47);
  EXPECT_EQ(json["triangles"], 69) << "two a cell, less one";
  EXPECT_EQ(json["vertices"], 47);
  EXPECT_EQ(json["border_vertices"], 23);
  EXPECT_EQ(json["features"][1]["name"], "confidence");
  EXPECT_EQ(json["features"][1]["range"][1], 46);
  EXPECT_NEAR(json["max_edge_percent"], 100 * 10 * 60 / 7.0 * 0.017453, 15);
  const Outcome info = run({kMerlin, "mesh", "info", ply_, "--json"});
  const auto mesh = nlohmann::json::parse(info.output);
  EXPECT_EQ(mesh["triangles"], 69);
  std::string names;
  for (const auto& f : mesh["features"]) names += f["name"].get<std::string>() + " ";
  EXPECT_EQ(names, "normal colour confidence border ");
  EXPECT_NEAR(mesh["box"]["low"][0], -0.99817, 1e-5) << "A.15 at 30 and 4 degrees, 2 m away";
}

TEST_F(MeshImport, AnMrmIsReducedAndKeepsTheFeaturesRanges) {
  const auto json = report(
      {scan_, "--feature", "confidence=" + (dir_ / "confidence.pgm"), "-o", dir_ / "out.mrm"});
  EXPECT_LT(json["triangles_coarsest"], 69);
  EXPECT_EQ(json["features"][1]["name"], "colour") << "red high, blue low";
  const auto info =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "out.mrm", "--json"}).output);
  EXPECT_EQ(info["triangles"], 69);
  EXPECT_GT(info["levels"], 1);
  EXPECT_NE(info["about"].get<std::string>().find("feature.confidence.range=0 46"),
            std::string::npos);
}

TEST_F(MeshImport, RawBytesBecomeAPgmThatIsTheSameMesh) {
  std::string bytes;
  for (int i = 0; i < 48; ++i) appendBe16(bytes, static_cast<std::uint16_t>(2000 + 10 * (i % 8)));
  writeText(dir_ / "coleman.bin", bytes + std::string(48, '\x40'));
  const std::vector<std::string> raw = {dir_ / "coleman.bin",
                                        "--raw",
                                        "8x6:range=u16be,confidence=u8",
                                        "--angles",
                                        "60",
                                        "40",
                                        "--scale",
                                        "0.001"};
  auto to_mesh = raw, to_image = raw;
  to_mesh.insert(to_mesh.end(), {"-o", ply_});
  to_image.insert(to_image.end(), {"-o", dir_ / "out.pgm"});
  const auto mesh = report(to_mesh);
  EXPECT_EQ(mesh["triangles"], 70);
  const auto image = report(to_image);
  EXPECT_EQ(image["left_out"], nlohmann::json::array({"confidence"}));
  EXPECT_EQ(report({dir_ / "out.pgm", "-o", dir_ / "out2.ply"})["triangles"], 70);
}

TEST_F(MeshImport, AnElevationMapIsColouredByHeight) {
  writeText(dir_ / "a.asc",
            "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -1\n1 2 3 4 5 6 "
            "7 8 -1\n");
  const auto json = report({dir_ / "a.asc", "--cell", "30", "--exaggerate", "10", "-o", ply_});
  EXPECT_EQ(json["triangles"], 7);
  EXPECT_EQ(json["features"][0]["name"], "colour");
  const auto info = nlohmann::json::parse(run({kMerlin, "mesh", "info", ply_, "--json"}).output);
  EXPECT_EQ(info["box"]["high"], nlohmann::json::array({60, 60, 80}));
}

TEST_F(MeshImport, ATableOfAnglesMayStandBeforeTheInput) {
  writeText(dir_ / "beams.txt",
            "# columns: 8 over 90 deg\n0 5 0\n1 4 0\n2 3 0\n3 2 0\n4 1 0\n5 0 0\n");
  const auto json =
      report({"--geometry", "spinning", "--angles", dir_ / "beams.txt", scan_, "-o", ply_});
  EXPECT_EQ(json["geometry"], "spinning");
  EXPECT_EQ(json["triangles"], 69);
}

TEST_F(MeshImport, MeshesGoTheSameWay) {
  ASSERT_EQ(import({scan_, "-o", dir_ / "a.ply"}).status, 0);
  const auto json = report({dir_ / "a.ply", "--scale", "10", "-o", dir_ / "out.obj"});
  EXPECT_EQ(json["format"], "mesh");
  EXPECT_EQ(json["triangles"], 69);
  const Outcome info = run({kMerlin, "mesh", "info", dir_ / "out.obj", "--json"});
  EXPECT_NEAR(nlohmann::json::parse(info.output)["box"]["low"][0], -9.9817, 1e-4);
}

TEST_F(MeshImport, AScanOfAModelComesBackWithItsFeaturesAndWithoutOptions) {
  ASSERT_EQ(import({scan_, "--feature", "colour=" + (dir_ / "colour.ppm"), "--feature",
                    "label=" + (dir_ / "confidence.pgm"), "-o", dir_ / "a.ply"})
                .status,
            0);
  const Outcome scanned =
      run({kMerlin, "mesh",       "scan",    dir_ / "a.ply", "--camera",     "0",     "0",
           "0",     "--geometry", "pinhole", "--angles",     "50",           "35",    "--width",
           "40",    "--height",   "30",      "-o",           dir_ / "b.pgm", "--json"});
  ASSERT_EQ(scanned.status, 0) << scanned.output;
  const auto scan = nlohmann::json::parse(scanned.output);
  EXPECT_EQ(scan["returns"], 1200) << "the model is wider than the view";
  EXPECT_EQ(scan["features"][0]["file"], "b.colour.png");
  const auto json = report({dir_ / "b.pgm", "-o", ply_});
  EXPECT_EQ(json["geometry"], "pinhole");
  EXPECT_EQ(json["triangles"], 2 * 39 * 29);
  std::string names;
  for (const auto& f : json["features"]) names += f["name"].get<std::string>() + " ";
  ASSERT_EQ(names, "colour label confidence ");
  EXPECT_EQ(json["features"][1]["range"][1], 46) << "whole numbers stay whole";
  std::filesystem::remove(dir_ / "b.label.pgm");
  const auto without = report({dir_ / "b.pgm", "-o", ply_});
  ASSERT_EQ(without["features"].size(), 2u);
  EXPECT_NE(without["notes"][0].get<std::string>().find("--feature label=FILE"), std::string::npos);
  const Outcome away = run({kMerlin, "mesh", "scan", dir_ / "a.ply", "--camera", "0", "0", "0", "0",
                            "0", "5", "-o", dir_ / "out.pgm"});
  EXPECT_EQ(away.status, 2);
  EXPECT_NE(away.output.find("none of the rays meets it"), std::string::npos) << away.output;
}

TEST_F(MeshImport, TheSameInputGivesTheSameBytesOnAnyNumberOfThreads) {
  ASSERT_EQ(import({scan_, "--median", "3", "--threads", "1", "-o", dir_ / "a.ply"}).status, 0);
  ASSERT_EQ(import({scan_, "--median", "3", "--threads", "4", "-o", dir_ / "b.ply"}).status, 0);
  EXPECT_TRUE(readText(dir_ / "a.ply") == readText(dir_ / "b.ply"));
}

TEST_F(MeshImport, TheUnitIsAMetreOnlyWhereSomethingSaysSo) {
  writeText(scan_, "P5\n# angles: 60 40\n4 4\n255\n" + std::string(16, '\x64'));
  const std::string model = dir_ / "out.mrm";
  const auto unit = [&] {
    const Outcome info = run({kMerlin, "mesh", "info", model, "--json"});
    return nlohmann::json::parse(info.output)["unit"].get<std::string>();
  };
  const auto counts = report({scan_, "-o", model});
  EXPECT_EQ(counts["notes"].dump(),
            "[\"nothing says in which unit its ranges are, and they are taken as they stand; "
            "--scale METRES_PER_UNIT makes metres of them\"]");
  EXPECT_EQ(unit(), "");
  EXPECT_EQ(report({scan_, "--scale", "0.01", "-o", model})["notes"].size(), 0U);
  EXPECT_EQ(unit(), "m");
}

TEST_F(MeshImport, AModelForTheWallIsSentToTheExport) {
  const std::string model = dir_ / "a.mrm";
  ASSERT_EQ(import({scan_, "-o", model}).status, 0);
  expectRefusal({model, "-o", ply_}, model +
                                         ": is a model for the wall already; merlin mesh export " +
                                         model + " -o OUT.ply makes a mesh of it");
}

TEST_F(MeshImport, RefusalsNameFilePlaceAndReason) {
  const std::string bad = dir_ / "bad.pgm";
  writeText(bad, "P5\n2 2\n255\nabcd");
  expectRefusal({bad, "-o", ply_}, bad + ": the angles of the image are not known");
  writeText(bad, kHeader + "9 9\n255\nabcd");
  expectRefusal({bad, "-o", ply_}, bad + ": has 4 bytes of pixels; 9 x 9 pixels take 81");
  writeText(bad, kHeader + "2 2\n255\n" + std::string(4, '\0'));
  expectRefusal({bad, "-o", ply_}, bad + ": none of its 2 x 2 pixels has a return");
  writeText(dir_ / "small.pgm", "P5\n3 3\n255\nabcdefghi");
  expectRefusal({scan_, "--feature", "heat=" + (dir_ / "small.pgm"), "-o", ply_},
                dir_ / "small.pgm" + ": has 3 x 3 pixels; the range image has 8 x 6");
  std::string numbers;
  for (int i = 0; i < 16; ++i) numbers += std::string("\x7f\xc0\0\0", 4);
  writeText(dir_ / "nan.bin", numbers);
  expectRefusal({dir_ / "nan.bin", "--raw", "4x4:range=f32be", "--angles", "9", "9", "-o", ply_},
                dir_ / "nan.bin" + ": none of its 4 x 4 pixels has a return");
}

TEST_F(MeshImport, OptionsThatDoNotFitAreRefused) {
  expectRefusal({scan_, "--max-edge", "0.0001", "-o", ply_},
                "make no triangle with edges of up to");
  expectRefusal({scan_, "--max-edge", "long", "-o", ply_}, "--max-edge long: is neither a length");
  expectRefusal({scan_, "--between", "5", "6", "-o", ply_}, "removed all of its 47 returns");
  expectRefusal({scan_, "--cell", "3", "-o", ply_}, "--cell is for elevation maps");
  expectRefusal({scan_, "--colour-by", "heat", "-o", ply_}, "there is no such feature");
  expectRefusal({scan_, "--median", "4", "-o", ply_}, "is none of 3, 5, 7");
  expectRefusal({scan_, "--raw-header", "4", "-o", ply_}, "need --raw");
  expectRefusal({scan_, scan_, "-o", ply_}, "one file is imported at a time");
  expectRefusal({scan_, "-o", dir_ / "out.xyz"}, "models as .mrm, range images as .pgm");
  expectRefusal({scan_, "-o", scan_}, "is an input");
  expectRefusal({dir_ / "absent.pgm", "-o", ply_}, "No such file or directory");
  writeText(dir_ / "a.dat", "nobody knows this");
  expectRefusal({dir_ / "a.dat", "-o", ply_}, "is of no format that MERLIN reads; read are PGM");
  ASSERT_EQ(import({scan_, "-o", dir_ / "a.ply"}).status, 0);
  expectRefusal({dir_ / "a.ply", "--median", "3", "-o", ply_}, "--median is for range images");
}

}  // namespace
}  // namespace merlin::test
