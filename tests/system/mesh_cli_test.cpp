// `merlin mesh` commands that succeed, with formats, repairs and labels: their output and files.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/picture_files.h"
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

TEST_F(MeshCli, ReduceInfoExportAgree) {
  const Outcome reduced = run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--json"});
  ASSERT_EQ(reduced.status, 0) << reduced.output;
  const auto report =
      nlohmann::json::parse(reduced.output.substr(reduced.output.find("{\"output\"")));
  EXPECT_EQ(report["triangles"], 69612) << "and 24 with two corners at one place";
  EXPECT_GT(report["collapses_per_second"], 0);
  const auto box = infoOf(dir_ / "a.mrm")["box"];
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k)
    squares += std::pow(box["high"][k].get<double>() - box["low"][k].get<double>(), 2);
  const double estimate = report["error_estimate"];
  EXPECT_GT(estimate, 0);
  EXPECT_NEAR(report["error_estimate_percent"].get<double>(), 100 * estimate / std::sqrt(squares),
              1e-4)
      << "of the diagonal of the original's box";
  EXPECT_NE(reduced.output.find("collapses/s"), std::string::npos)
      << "progress, also without a terminal";

  const auto info =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a.mrm", "--json"}).output);
  EXPECT_EQ(info["triangles"], 69612);
  EXPECT_EQ(info["vertices"], 34808);
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

TEST_F(MeshCli, TheSameInputGivesTheSameBytes) {
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm"}).status, 0);
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "b.mrm"}).status, 0);
  EXPECT_TRUE(readText(dir_ / "a.mrm") == readText(dir_ / "b.mrm"));
}

TEST_F(MeshCli, ReduceStopsWhereItIsTold) {
  const Outcome reduced =
      run({kMerlin, "mesh", "reduce", scan_, "-o", dir_ / "a.mrm", "--percent", "50", "--cost",
           "pattern", "--preset", "typical1998", "--preserve-topology"});
  EXPECT_NE(reduced.output.find("(percent)"), std::string::npos) << reduced.output;
}

TEST_F(MeshCli, PicturesModelsSideBySide) {
  ASSERT_EQ(run({kMerlin, "mesh", "export", scan_, "-o", dir_ / "a.ply"}).status, 0);
  const Outcome picture = run({kMerlin, "mesh", "picture", dir_ / "a.ply", dir_ / "a.ply", "-o",
                               dir_ / "p.png", "--width", "64", "--height", "48"});
  EXPECT_NE(picture.output.find("p.png: 128 x 48"), std::string::npos) << picture.output;
}

// The drawn edge lengths are those that the reduction uses, so other weights give another picture.
TEST_F(MeshCli, PicturesEdgesByTheirWeights) {
  const auto drawn = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {kMerlin, "mesh", "picture", scan_, "--edges", "-o", dir_ / name,
                               "--width", "160", "--height", "120"});
    const Outcome done = run(std::move(more));
    EXPECT_EQ(done.status, 0) << done.output;
    expectPicture(dir_ / name, 50);
    return readText(dir_ / name);
  };
  const std::string typical = drawn("a.png", {"--preset", "typical1998"});
  EXPECT_TRUE(drawn("b.png", {"--preset", "typical1998"}) == typical);
  EXPECT_FALSE(drawn("c.png", {"--preset", "typical1998", "--weight", "curvature=0"}) == typical);
  EXPECT_FALSE(drawn("d.png", {}) == typical) << "default weights";
  const auto refusal = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {kMerlin, "mesh", "picture", scan_, "-o", dir_ / "e.png"});
    const Outcome done = run(std::move(more));
    EXPECT_EQ(done.status, 2) << done.output;
    return done.output;
  };
  EXPECT_NE(refusal({"--weight", "colour=1"}).find("--preset and --weight: need --edges"),
            std::string::npos);
  EXPECT_NE(refusal({"--edges", "--wireframe"}).find("cannot be combined with --wireframe"),
            std::string::npos);
  EXPECT_NE(refusal({"--edges", "--weight", "heat=1"}).find("weight heat: the mesh has no such"),
            std::string::npos);
  EXPECT_NE(refusal({"--edges", "--memory", "40M"}).find("a lower resolution with --percent"),
            std::string::npos);
  EXPECT_NE(refusal({"--memory", "1M"}).find("reading its "), std::string::npos);
}

// Returns a square of two triangles in the plane z = `height`, as ASCII PLY.
std::string squarePly(double height) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 {0}\n3 0 {0}\n3 "
      "4 "
      "{0}\n0 4 {0}\n3 0 1 2\n3 0 2 3\n",
      height);
}

// Returns the JSON at the end of a command's output, after its progress messages.
nlohmann::json jsonOf(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  return nlohmann::json::parse(outcome.output.substr(outcome.output.find("{\"")));
}

TEST_F(MeshCli, CompareMeasuresBothWays) {
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

TEST_F(MeshCli, CompareTakesAResolutionOfAModel) {
  std::filesystem::rename(makeFullModel(dir_), dir_ / "a.mrm");
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

TEST_F(MeshCli, ExportKeepsWithinADistanceForCertain) {
  std::filesystem::rename(makeFullModel(dir_), dir_ / "a.mrm");
  std::size_t before = 0;
  for (const char* percent : {"2", "0.5"}) {
    const Outcome done =
        run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--within", percent, "-o", dir_ / "a.ply"});
    EXPECT_NE(done.output.find("at most"), std::string::npos) << done.output;
    const auto c = jsonOf(run({kMerlin, "mesh", "compare", scan_, dir_ / "a.ply", "--samples", "10",
                               "--width", "0.01", "--json"}));
    EXPECT_LE(c["max_low_percent"], std::stod(percent));
    EXPECT_GT(c["max_high_percent"], 0.5 * std::stod(percent)) << "no finer than it has to be";
    const std::size_t triangles =
        jsonOf(run({kMerlin, "mesh", "info", dir_ / "a.ply", "--json"}))["triangles"];
    EXPECT_GT(triangles, before);
    before = triangles;
  }
}

// A row of the curve equals what `compare` prints for that resolution.
TEST_F(MeshCli, CurveSaysWhatCompareSays) {
  const std::string model = dir_ / "a.mrm", csv = dir_ / "a.csv", svg = dir_ / "a<b.svg";
  std::filesystem::rename(makeFullModel(dir_), model);
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

TEST_F(MeshCli, CompareDrawsPictures) {
  const auto changed = [&](const std::string& percent) {
    return jsonOf(run({kMerlin, "mesh", "compare", scan_, dir_ / "a.mrm", "--percent", percent,
                       "--samples", "1000", "--width", "5", "--pictures", dir_ / "new/pictures",
                       "--json"}))["changed_pixels_percent"]
        .get<double>();
  };
  std::filesystem::rename(makeFullModel(dir_), dir_ / "a.mrm");
  EXPECT_EQ(changed("100"), 0);
  EXPECT_TRUE(readText(dir_ / "new/pictures/a.png") == readText(dir_ / "new/pictures/b.png"))
      << "from one eye, at one scale";
  const double fifth = changed("20"), hundredth = changed("1");
  EXPECT_GT(fifth, 0);
  EXPECT_GT(hundredth, 2 * fifth);
  EXPECT_LT(hundredth, 100);
  for (const char* name : {"a", "b", "beside", "edges"})
    expectPicture(dir_ / fmt::format("new/pictures/{}.png", name), 50);
  for (const char* name : {"a_wire", "b_wire", "difference"})  // images of only two colours
    expectPicture(dir_ / fmt::format("new/pictures/{}.png", name), 2);
}

TEST_F(MeshCli, ExportsToEveryFormatAndSaysWhatIsLeftOut) {
  std::filesystem::rename(makeFullModel(dir_), dir_ / "a.mrm");
  for (const char* ending : {"ply", "obj", "glb", "gltf", "stl", "iv"}) {
    const std::string out = dir_ / "a." + ending;
    const Outcome done =
        run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--triangles", "1000", "-o", out});
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_NE(done.output.find("1000 triangles"), std::string::npos) << done.output;
    const bool says = done.output.find("cannot store them: colour, normal") != std::string::npos;
    EXPECT_EQ(says, out.ends_with("stl")) << done.output;
    EXPECT_GT(readText(out).size(), 20000u) << ending;
  }
  EXPECT_EQ(infoOf(dir_ / "a.obj")["triangles"], 1000);
}

// Each of these arguments would lose data, or cannot be what a user intended.
TEST_F(MeshCli, RefusesWhatWouldNotDoWhatItSays) {
  const std::string copy = dir_ / "scan.ply", model = dir_ / "a.mrm";
  std::filesystem::copy_file(scan_, copy);
  std::filesystem::create_symlink(copy, dir_ / "link.mrm");
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    words.insert(words.begin(), {kMerlin, "mesh"});
    const Outcome done = run(words);
    EXPECT_NE(done.status, 0) << done.output;
    EXPECT_NE(done.output.find(why), std::string::npos) << done.output;
  };
  refused({"reduce", copy, "-o", copy}, "the name of a model must end in .mrm");
  refused({"reduce", copy, "-o", dir_ / "link.mrm"}, "link.mrm: is an input");
  refused({"export", copy, "-o", copy}, "is an input");
  refused({"segment", copy, "-o", copy, "--segments", "2"}, "is an input");
  refused({"segment", copy, "-o", dir_ / "b.ply", "--picture", copy, "--segments", "2"},
          "is an input");
  refused({"picture", copy, "-o", copy}, "is an input");
  refused({"picture", scan_, copy, "-o", copy}, "is an input");
  refused({"curve", copy, "--csv", copy}, "is an input");
  refused({"curve", copy, "--svg", copy}, "is an input");
  EXPECT_TRUE(readText(copy) == readText(scan_));
  refused({"export", copy, "--percent", "5", "-o", dir_ / "b.ply"}, "has one resolution");
  refused({"compare", copy, copy, "--error", "1"}, "has one resolution");
  refused({"reduce", copy, "-o", model, "--triangles", "-5"}, "-5 is less than 0");
  refused({"export", copy, "-o", dir_ / "b.ply", "--error", "nan"}, "nan is not a finite number");
  refused({"reduce", copy, "-o", model, "--weight", "colour=1e18"}, "is not from 0 to 1000000");
  refused({"reduce", copy, "-o", model, "--preset", "mug1998"}, "needs --cost pattern");
  refused({"reduce", copy, "-o", model, "--cost", "pattern", "--lock-borders"}, "--lock-borders");
  EXPECT_FALSE(std::filesystem::exists(model));
}

// Returns a curved sheet of 20 x 20 vertices whose left half has label 1.
std::string labelledSheet() {
  std::string vertices, faces;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      vertices += fmt::format("{} {} {} {}\n", x, y, 0.01 * x * x + 0.02 * y * y, x < 10 ? 1 : 0);
      const int v = 20 * y + x;
      if (x < 19 && y < 19)
        faces += fmt::format("3 {} {} {}\n3 {} {} {}\n", v, v + 1, v + 20, v + 1, v + 21, v + 20);
    }
  }
  return "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\n"
         "property float z\nproperty float label\nelement face 722\n"
         "property list uchar int vertex_indices\nend_header\n" +
         vertices + faces;
}

TEST_F(MeshCli, LocksBordersAndLeavesLabelsToWhomWeighsThem) {
  writeText(dir_ / "sheet.ply", labelledSheet());
  const auto cornersAt = [&](const std::vector<std::string>& also, const char* triangles) {
    std::vector<std::string> words = {kMerlin, "mesh",        "reduce", dir_ / "sheet.ply",
                                      "-o",    dir_ / "a.mrm"};
    words.insert(words.end(), also.begin(), also.end());
    EXPECT_EQ(run(words).status, 0);
    const Outcome out = run({kMerlin, "mesh", "export", dir_ / "a.mrm", "--triangles", triangles,
                             "-o", dir_ / "a.ply"});
    EXPECT_EQ(out.status, 0) << out.output;
    return readText(dir_ / "a.ply");
  };
  const auto vertices = [&] { return infoOf(dir_ / "a.ply")["vertices"].get<int>(); };
  cornersAt({"--lock-borders"}, "90");
  EXPECT_GE(vertices(), 76) << "as many as the border has";
  cornersAt({}, "90");
  EXPECT_LT(vertices(), 70);
  EXPECT_TRUE(cornersAt({"--weight", "label=0"}, "60") != cornersAt({}, "60"));
}

TEST_F(MeshCli, ExportTakesAnErrorInPercentOrInUnits) {
  std::filesystem::rename(makeFullModel(dir_), dir_ / "a.mrm");
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
  EXPECT_NE(refused.output.find("a.ply: --multiresolution can only be written as .iv"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(exported("a.iv", {"--multiresolution", "--percent", "5"}).status, 2);
  const Outcome done = exported("a.iv", {"--multiresolution"});
  EXPECT_EQ(done.status, 0);
  EXPECT_NE(done.output.find("69612 to 69612 triangles, 1 levels"), std::string::npos)
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
  EXPECT_NE(refused.output.find("34820 vertices and 69636 triangles takes 3"), std::string::npos)
      << refused.output;
  EXPECT_NE(refused.output.find("the limit (--memory, by default the free memory) is 33 MiB"),
            std::string::npos)
      << refused.output;
  EXPECT_EQ(readText(dir_ / "a.mrm"), "");
  EXPECT_EQ(reduced("much").status, 2);
}

// Two triangles that share an edge, a third one (a fin) at the same edge, and one case of each kind
// of defect that is repaired.
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
    EXPECT_NE(
        text.output.find("repaired: 1 degenerate triangles (same vertex twice) dropped, 1 "
                         "duplicate triangles dropped, 1 triangles with the same vertices as "
                         "another in reverse order dropped, 1 unused vertices dropped, 1 "
                         "non-manifold edges split, 2 non-manifold vertices split, 2 vertices "
                         "added by splitting"),
        std::string::npos)
        << text.output;
  }
  EXPECT_NE(run({kMerlin, "mesh", "info", scan_})
                .output.find("repaired: 24 degenerate triangles (same vertex twice) dropped, 12 "
                             "unused vertices dropped\n"),
            std::string::npos);
  writeText(dir_ / "good.ply", squarePly(0));
  EXPECT_EQ(run({kMerlin, "mesh", "info", dir_ / "good.ply"}).output.find("repaired"),
            std::string::npos);
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
  EXPECT_EQ(json["vertices"], 34808);
  expectPicture(dir_ / "a.png", 50);
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
