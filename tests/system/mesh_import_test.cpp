// `merlin mesh import` of small synthetic files: the meshes, the messages and the refusals.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class MeshImport : public testing::Test {
 protected:
  MeshImport() {
    // Range image of 8 x 6 pixels of 16 bits, 2 m away; the last pixel has no return.
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
  // Returns the message of a refused import. Expects that no file is left behind.
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
  EXPECT_NE(without["notes"].dump().find("--feature label=FILE"), std::string::npos);
  const Outcome away = run({kMerlin, "mesh", "scan", dir_ / "a.ply", "--camera", "0", "0", "0", "0",
                            "0", "5", "-o", dir_ / "out.pgm"});
  EXPECT_EQ(away.status, 2);
  EXPECT_NE(away.output.find("none of the rays meets the mesh"), std::string::npos) << away.output;
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
            "[\"the file does not say in which unit its ranges are, so they are used unchanged; "
            "--scale METRES_PER_UNIT converts them to metres\"]");
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

// If a map's coordinates are stored relative to an origin, all reports must agree about the origin.
TEST_F(MeshImport, AMeshWithCoordinatesOfAMapKeepsItsOriginInReportModelAndScan) {
  const std::string far = dir_ / "far.obj", model = dir_ / "a.mrm";
  writeText(far,
            "v 450000.125 5400000.25 10\nv 450002.125 5400000.25 10\nv 450002.125 5400002.25 10\n"
            "v 450000.125 5400002.25 10.5\nf 1 2 3\nf 1 3 4\n");
  const nlohmann::json origin = {450000.0, 5400000.0, 0.0};
  const auto json = report({far, "-o", model});
  EXPECT_EQ(json["origin"], origin);
  EXPECT_NE(json["notes"].dump().find("relative to 450000, 5400000, 0"), std::string::npos);
  for (const std::string& file : {far, model}) {
    const Outcome said = run({kMerlin, "mesh", "info", file, "--json"});
    const auto info = nlohmann::json::parse(said.output.substr(said.output.find('{')));
    EXPECT_EQ(info["origin"], origin) << file;
    EXPECT_EQ(info["box"]["low"], nlohmann::json({0.125, 0.25, 10.0})) << file;
    EXPECT_EQ(info["box"]["high"], nlohmann::json({2.125, 2.25, 10.5})) << file;
  }
  EXPECT_EQ(report({far, "--scale", "0.5", "-o", ply_})["origin"],
            nlohmann::json({225000.0, 2700000.0, 0.0}))
      << "in the mesh's unit";
  const Outcome scan =
      run({kMerlin, "mesh", "scan", far, "--camera", "450001.125", "5400001.25", "15", "--width",
           "20", "--height", "20", "-o", dir_ / "b.pgm", "--json"});
  ASSERT_EQ(scan.status, 0) << scan.output;
  const auto scanned = nlohmann::json::parse(scan.output.substr(scan.output.find('{')));
  EXPECT_EQ(scanned["camera"][3], 450001.125) << "in the coordinates of the file";
  const auto back = report({dir_ / "b.pgm", "-o", dir_ / "c.ply", "--local"});
  EXPECT_EQ(back["origin"], (nlohmann::json{450001.0, 5400001.0, 0.0}));
  EXPECT_EQ(back["origin_added"], false);
  const Outcome box = run({kMerlin, "mesh", "info", dir_ / "c.ply", "--json"});
  EXPECT_NEAR(nlohmann::json::parse(box.output)["box"]["high"][0], 1.125, 0.3);
}

TEST_F(MeshImport, AnExportPutsTheOriginBackUnlessItIsToBeLocal) {
  const std::string model = dir_ / "a.mrm";
  writeText(dir_ / "far.obj",
            "v 450000.125 5400000.25 10\nv 450002.125 5400000.25 10\nv 450002.125 5400002.25 10\n"
            "v 450000.125 5400002.25 10.5\nf 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(import({dir_ / "far.obj", "-o", model}).status, 0);
  const auto exported = [&](const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {kMerlin, "mesh", "export", model, "-o", dir_ / name});
    const Outcome done = run(std::move(more));
    EXPECT_EQ(done.status, 0) << done.output;
    const auto from = done.output.find("origin");
    return from == std::string::npos
               ? std::string()
               : done.output.substr(from, done.output.find('\n', from) - from);
  };
  const std::string at = "origin    450000, 5400000, 0 is ";
  EXPECT_EQ(exported("b.obj"), at + "added to the coordinates; --local leaves it out");
  EXPECT_NE(readText(dir_ / "b.obj").find("\nv 450002.125 5400002.25 10"), std::string::npos);
  EXPECT_EQ(exported("c.obj", {"--local"}),
            at + "left out (--local); the mesh's (0, 0, 0) lies there");
  EXPECT_NE(readText(dir_ / "c.obj").find("\nv 2.125 2.25 10"), std::string::npos);
  for (const auto& [name, more] : {std::pair("b.stl", std::vector<std::string>{}),
                                   {"b.iv", {}},
                                   {"d.iv", {"--multiresolution"}}})
    EXPECT_EQ(exported(name, more),
              at + fmt::format("left out, because the numbers of {} are floats, which keep seven "
                               "digits; the mesh's (0, 0, 0) lies there",
                               std::string_view(name).substr(1)));
  ASSERT_EQ(import({scan_, "-o", model}).status, 0);
  EXPECT_EQ(exported("e.ply"), "") << "nothing is said of a model without an origin";
}

// The OBJ file has the coordinates of a map; the mesh keeps them in each format to which it is
// converted.
TEST_F(MeshImport, AMeshLiesWhereItsFileDoesUnlessItIsToBeLocal) {
  const std::string far = dir_ / "far.obj", out = dir_ / "b.obj";
  writeText(far,
            "v 450000.125 5400000.25 10\nv 450002.125 5400000.25 10\nv 450002.125 5400002.25 10\n"
            "v 450000.125 5400002.25 10.5\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(report({far, "-o", out})["origin_added"], true);
  EXPECT_NE(readText(out).find("\nv 450002.125 5400002.25 10"), std::string::npos);
  const Outcome said = import({far, "-o", out});
  EXPECT_NE(said.output.find("origin    450000, 5400000, 0 is added to the coordinates; --local"),
            std::string::npos)
      << said.output;
  EXPECT_EQ(report({far, "-o", out, "--local"})["origin_added"], false);
  EXPECT_NE(readText(out).find("\nv 2.125 2.25 10"), std::string::npos);
  EXPECT_EQ(report({far, "-o", dir_ / "b.stl"})["origin_added"], false) << "floats";
  expectRefusal({far, "-o", dir_ / "b.mrm", "--local"}, ": --local is for meshes; a model (.mrm)");
}

TEST_F(MeshImport, SegmentsLieWhereTheMeshDoes) {
  writeText(dir_ / "far.obj",
            "v 450000.5 20000 0\nv 450002.5 20000 0\nv 450000.5 20002 0\nf 1 2 3\n");
  ASSERT_EQ(
      run({kMerlin, "mesh", "segment", dir_ / "far.obj", "--segments", "1", "-o", ply_}).status, 0);
  const Outcome said = run({kMerlin, "mesh", "info", ply_, "--json"});
  const auto info = nlohmann::json::parse(said.output.substr(said.output.find('{')));
  EXPECT_EQ(info["origin"], nlohmann::json({450000.0, 20000.0, 0.0}));
  EXPECT_EQ(info["box"]["high"], nlohmann::json({2.5, 2.0, 0.0}));
}

TEST_F(MeshImport, ComparisonsBringTwoOriginsTogether) {
  writeText(dir_ / "a.obj",
            "v 450000.5 20000 0\nv 450002.5 20000 0\nv 450000.5 20002 0\nf 1 2 3\n");
  writeText(dir_ / "b.obj",
            "v 450002.5 20000 0\nv 450000.5 20002 0\nv 450000.5 20000 0\nf 1 2 3\n");
  const Outcome same = run(
      {kMerlin, "mesh", "compare", dir_ / "a.obj", dir_ / "b.obj", "--samples", "100", "--json"});
  ASSERT_EQ(same.status, 0) << same.output;
  const auto json = nlohmann::json::parse(same.output.substr(same.output.find("{\"")));
  EXPECT_LT(json["rms"], 1e-3);
}

TEST_F(MeshImport, ACameraWithCoordinatesOfAMapKeepsItsDigitsByAnOrigin) {
  const std::string pixels = readText(scan_).substr(kHeader.size());
  writeText(scan_, kHeader + "# camera: 1 0 0 450000.25 0 1 0 5400000.5 0 0 1 0\n" + pixels);
  const auto json = report({scan_, "-o", ply_, "--local"});
  EXPECT_EQ(json["origin"], nlohmann::json({450000.0, 5400000.0, 0.0}));
  const auto info = nlohmann::json::parse(run({kMerlin, "mesh", "info", ply_, "--json"}).output);
  EXPECT_NEAR(info["box"]["low"][0], 0.25 - 0.99817, 1e-5);
  ASSERT_EQ(import({scan_, "-o", dir_ / "placed.obj"}).status, 0);
  EXPECT_NE(readText(dir_ / "placed.obj").find(" 5400000."), std::string::npos);
  ASSERT_EQ(import({scan_, "-o", dir_ / "out.mrm"}).status, 0);
  const Outcome said = run({kMerlin, "mesh", "info", dir_ / "out.mrm"});
  EXPECT_NE(said.output.find("mesh.origin=450000 5400000 0"), std::string::npos) << said.output;
  const Outcome image = import({scan_, "-o", dir_ / "again.pgm"});
  ASSERT_EQ(image.status, 0);
  EXPECT_NE(image.output.find(dir_ / "again.pgm: 8 x 6 pixels, 47 with a return\n"),
            std::string::npos)
      << image.output;
  EXPECT_NE(readText(dir_ / "again.pgm").find("# camera: 1 0 0 450000.25"), std::string::npos)
      << "a range image keeps its camera as it is";
}

TEST_F(MeshImport, AScanOfAModelKeepsUnitAndRangeOfItsFeatures) {
  writeText(dir_ / "heat.pgm",
            "P5\n# unit: degC\n# minimum: 10\n# maximum: 61\n8 6\n255\n" + std::string(48, '\x64'));
  ASSERT_EQ(
      import({scan_, "--feature", "heat=" + (dir_ / "heat.pgm"), "-o", dir_ / "a.mrm"}).status, 0);
  const Outcome scan =
      run({kMerlin, "mesh", "scan", dir_ / "a.mrm", "--camera", "0", "0", "0", "--angles", "30",
           "20", "--width", "20", "--height", "20", "-o", dir_ / "b.pgm"});
  ASSERT_EQ(scan.status, 0) << scan.output;
  const auto json = report({dir_ / "b.pgm", "-o", ply_});
  for (const auto& f : json["features"]) {
    if (f["name"] != "heat") continue;
    EXPECT_EQ(f["unit"], "degC");
    EXPECT_EQ(f["range"], nlohmann::json({10.0, 61.0}));
    return;
  }
  ADD_FAILURE() << json["features"];
}

TEST_F(MeshImport, AMeshThatNeedsMoreMemoryThanAllowedIsRefusedBeforeItIsRead) {
  std::string obj, faces, body;
  for (int i = 0; i < 100'000; ++i) {
    obj += "v 0 0 0\n";
    faces += "3 0 1 2\n";
    body += "f 1 2 3\n";
  }
  writeText(dir_ / "a.obj", obj + body);
  std::string vertices;
  for (int i = 0; i < 100'000; ++i) vertices += "0 0 0\n";
  writeText(dir_ / "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 100000\nproperty float x\nproperty float y\n"
            "property float z\nelement face 100000\nproperty list uchar int vertex_indices\n"
            "end_header\n" +
                vertices + faces);
  for (const char* name : {"a.obj", "a.ply"}) {
    const std::string file = dir_ / name;
    expectRefusal({file, "--memory", "34M", "-o", ply_},
                  file + ": reading its 100000 vertices, 100000 triangles takes");
    expectRefusal({file, "--memory", "34M", "-o", ply_}, "the limit (--memory");
    const Outcome info = run({kMerlin, "mesh", "info", file, "--memory", "34M"});
    EXPECT_EQ(info.status, 2) << info.output;
    EXPECT_EQ(import({file, "--memory", "100M", "-o", dir_ / "b.ply"}).output.find("--memory"),
              std::string::npos);
  }
}

TEST_F(MeshImport, OptionsThatWouldDoNothingToARangeImageAreRefused) {
  const std::string out = dir_ / "out.pgm";
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{
           {"--border"},
           {"--max-edge", "5%"},
           {"--colour-by", "none"},
           {"--exaggerate", "3"},
           {"--outwards"},
           {"--feature", "confidence=" + (dir_ / "confidence.pgm")},
           {"--texture", dir_ / "colour.ppm"}}) {
    std::vector<std::string> arguments = {scan_, "-o", out};
    arguments.insert(arguments.end(), option.begin(), option.end());
    expectRefusal(arguments, out + ": " + option[0] + " is for a mesh or a model; a range image");
  }
}

// A reader of the mesh's PLY file would take features with such names for something else, or ignore
// them.
TEST_F(MeshImport, NamesOfFeaturesThatAPlyFileCannotHoldAreRefused) {
  const auto refused = [&](const std::string& name, const std::string& why) {
    const std::string feature = name + "=" + (dir_ / "confidence.pgm");
    expectRefusal({scan_, "--feature", feature, "-o", ply_}, "--feature " + feature + ": " + why);
  };
  refused("two words", "the name of a feature is one word");
  refused("x", "the name x is a coordinate's");
  refused("nx", "the name nx means a part of the normal in PLY files");
  refused("red", "the name red means a part of the colour in PLY files");
  refused("s", "the name s means a part of the texcoord in PLY files");
  expectRefusal({scan_, "--raw", "2x2:range=u8,g=u8", "-o", ply_},
                "--raw 2x2:range=u8,g=u8: the name g means a part of the colour in PLY files");
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
  expectRefusal({dir_ / "a.dat", "-o", ply_},
                "has a format that MERLIN does not read; supported formats are PGM");
  ASSERT_EQ(import({scan_, "-o", dir_ / "a.ply"}).status, 0);
  expectRefusal({dir_ / "a.ply", "--median", "3", "-o", ply_}, "--median is for range images");
}

}  // namespace
}  // namespace merlin::test
