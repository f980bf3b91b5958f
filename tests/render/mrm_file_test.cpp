// .mrm files, also old ones, can be read back by MERLIN and by a program in another language.
#include "render/lod/io/mrm_file.h"

#include <filesystem>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "render/reduce/reduce.h"
#include "tests/render/mrm_files.h"
#include "tests/support/process.h"

namespace merlin::render {
namespace {

using test::MrmBytes;
using test::readText;

// Writes the model, reads it, and writes it again; expects that both files are equal. Returns their
// bytes.
std::string expectRoundTrip(const lod::Dendrogram& d) {
  const test::TempDir dir;
  EXPECT_TRUE(lod::writeMrm(dir / "first.mrm", d));
  const auto read = lod::readMrm(dir / "first.mrm");
  EXPECT_TRUE(read) << read.error().what;
  if (!read) return "";
  test::expectSame(*read, d);
  EXPECT_TRUE(lod::writeMrm(dir / "second.mrm", *read));
  EXPECT_EQ(readText(dir / "first.mrm"), readText(dir / "second.mrm"));
  return readText(dir / "first.mrm");
}

mesh::Mesh sphere() {
  mesh::Mesh mesh = test::sphere(3);
  mesh.features.push_back({"heat", 1, std::vector<float>(mesh.vertexCount(), 0.25F)});
  mesh.features.push_back({"colour", 3, std::vector<float>(mesh.positions.size(), 0.5F)});
  mesh.texture = {0x89, 'P', 'N', 'G', 7};  // the texture is not decoded here
  mesh::ensureNormals(mesh);
  return mesh;
}

lod::Dendrogram reducedSphere() {
  const mesh::Mesh mesh = sphere();
  return lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
}

TEST(MrmFile, IsTheSameWrittenInPiecesStraightFromTheReduction) {
  const test::TempDir dir;
  const mesh::Mesh mesh = sphere();
  for (const std::size_t stop : {std::size_t{0}, std::size_t{300}}) {  // one root, and many roots
    const reduce::Reduction r = *reduce::reduce(mesh, {.min_triangles = stop});
    ASSERT_TRUE(lod::writeMrm(dir / "whole.mrm", lod::buildDendrogram(mesh, r.log)));
    ASSERT_TRUE(lod::readMrm(dir / "whole.mrm"));
    for (const unsigned threads : {1U, 3U}) {
      ASSERT_TRUE(lod::writeMrm(dir / "pieces.mrm", mesh, r.log, threads));
      EXPECT_EQ(readText(dir / "pieces.mrm"), readText(dir / "whole.mrm"));
    }
  }
}

TEST(MrmFile, ARoundTripGivesTheSameBytes) {
  expectRoundTrip(reducedSphere());
  expectRoundTrip(test::goldenCube());
}

TEST(MrmFile, KeepsATextureAsItIsAndGivesItToWhatIsExtracted) {
  const test::TempDir dir;
  ASSERT_TRUE(lod::writeMrm(dir / "a.mrm", reducedSphere()));
  const auto read = lod::readMrm(dir / "a.mrm");
  ASSERT_TRUE(read);
  EXPECT_EQ(lod::extract(*read, 100).texture, sphere().texture);
}

TEST(MrmFile, HoldsAMeshThatWasNotReducedAndHasNoFeatures) {
  const std::string bytes = expectRoundTrip(lod::buildDendrogram(test::cube(), {}));
  EXPECT_EQ(MrmBytes(bytes).header().sections, 6u);
  EXPECT_EQ(MrmBytes(bytes).header().collapses, 0u);
}

TEST(MrmFile, KeepsWhatHasRoomOfAFeaturesName) {
  const std::string x30(30, 'x'), micro = "\xc2\xb5";
  mesh::Mesh mesh = test::cube();
  for (const std::string& name : {x30 + "yz", x30 + micro})
    mesh.features.push_back({name, 1, std::vector<float>(8)});
  EXPECT_TRUE(lod::checkNames(mesh));
  const test::TempDir dir;
  ASSERT_TRUE(lod::writeMrm(dir / "x.mrm", lod::buildDendrogram(mesh, {{}, {}, {{}, {}}, {}, ""})));
  const auto read = lod::readMrm(dir / "x.mrm");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->arrays().features[0].name, x30 + "y");
  EXPECT_EQ(read->arrays().features[1].name, x30) << "whole characters";
  EXPECT_EQ(readText(dir / "x.mrm").find(x30 + '\xc2'), std::string::npos) << "for any reader";
  mesh.features.push_back({x30 + "ya", 1, std::vector<float>(8)});
  EXPECT_EQ(lod::checkNames(mesh).error().what,
            "two features would both be called \"" + x30 +
                "y\" in an .mrm file, which has 31 bytes for a name; rename \"" + x30 + "ya\"");
}

TEST(MrmFile, SaysInItsHeaderWhatIsInIt) {
  const MrmBytes file(readText(test::kGoldenCube));
  const lod::mrm::FileHeader h = file.header();
  EXPECT_EQ(h.version, 1u);
  EXPECT_EQ(h.sections, 7u);
  EXPECT_EQ(h.file_size, 1384u);
  EXPECT_EQ(h.nodes, 14u);
  EXPECT_EQ(h.collapses, 6u);
  EXPECT_EQ(h.triangles, 12u);
  for (const float low : h.box_low) EXPECT_EQ(low, -1);
  for (const float high : h.box_high) EXPECT_EQ(high, 1);
  std::set<std::uint64_t> offsets;
  for (std::size_t i = 0; i < h.sections; ++i) {
    EXPECT_EQ(file.entry(i).offset % 64, 0u);
    offsets.insert(file.entry(i).offset);
  }
  EXPECT_EQ(offsets.size(), 7u);
}

// writeMrm() of version 1 wrote tests/data/golden/cube.mrm from goldenCube(), whose numbers are all
// in mrm_files.h, in November 2026. Files like it are in use and must stay readable for ever. If
// this test fails, repair the reader; never rewrite the file.
TEST(GoldenMrm, IsReadAsItWasWritten) {
  const auto golden = lod::readMrm(test::kGoldenCube);
  ASSERT_TRUE(golden) << golden.error().what;
  test::expectSame(*golden, test::goldenCube());
  const std::vector<std::uint32_t> alive = {12, 10, 8, 6, 4, 2, 0};
  EXPECT_EQ(test::copyOf(golden->arrays().alive), alive);
  const std::vector<float> error = {0, 0.25F, 0.25F, 0.5F, 0.5F, 1, 1};
  EXPECT_EQ(test::copyOf(golden->arrays().error), error);
  EXPECT_EQ(golden->arrays().about, "cost=by hand\nmade=for the tests\n");
}

TEST(GoldenMrm, IsWhatIsWrittenToday) {
  EXPECT_EQ(expectRoundTrip(test::goldenCube()), readText(test::kGoldenCube));
}

// One level as mrm_reader.py prints it: positions and corners as flat lists.
struct Obj {
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;
};

Obj parse(const std::string& text) {
  Obj obj;
  std::istringstream lines(text);
  std::string kind;
  while (lines >> kind) {
    for (int k = 0; k < 3; ++k) {
      if (kind == "v") lines >> obj.positions.emplace_back();
      if (kind == "f") lines >> obj.corners.emplace_back();
    }
  }
  for (std::uint32_t& corner : obj.corners) --corner;  // OBJ indices begin with 1
  return obj;
}

test::Outcome python(const std::string& file, const std::string& level) {
  const std::string script = std::string(MERLIN_SOURCE_DIR) + "/tests/render/mrm_reader.py";
  return test::run({"python3", script, file, level});
}

void expectPythonCutsAsWeDo(const std::string& path, std::size_t step) {
  const auto d = lod::readMrm(path);
  ASSERT_TRUE(d);
  for (std::size_t level = 0; level < d->levels(); level += step) {
    const test::Outcome printed = python(path, std::to_string(level));
    ASSERT_EQ(printed.status, 0) << printed.output;
    const Obj obj = parse(printed.output);
    std::vector<std::uint32_t> corners(3 * d->trianglesAt(level));
    d->cut(level, corners);
    EXPECT_EQ(obj.corners, corners) << level;
    const auto alive = d->arrays().positions.first(3 * (d->nodeCount() - 2 * level));
    EXPECT_EQ(obj.positions, test::copyOf(alive)) << level;
  }
}

TEST(MrmReaderPy, CutsEveryLevelOfTheGoldenFileAsWeDo) {
  expectPythonCutsAsWeDo(test::kGoldenCube, 1);
}

TEST(MrmReaderPy, CutsALargerFileAsWeDo) {
  const test::TempDir dir;
  ASSERT_TRUE(lod::writeMrm(dir / "sphere.mrm", reducedSphere()));
  expectPythonCutsAsWeDo(dir / "sphere.mrm", 50);
}

TEST(MrmReaderPy, FitsAPageAndRefusesWhatItCannotRead) {
  const std::string script =
      readText(std::string(MERLIN_SOURCE_DIR) + "/tests/render/mrm_reader.py");
  EXPECT_LE(std::count(script.begin(), script.end(), '\n'), 60);
  const test::TempDir dir;
  const auto says = [&](const std::string& bytes, const std::string& level) {
    test::writeText(dir / "x.mrm", bytes);
    const test::Outcome printed = python(dir / "x.mrm", level);
    EXPECT_EQ(printed.status, 1);
    return printed.output;
  };
  const std::string golden = readText(test::kGoldenCube), name = dir / "x.mrm: ";
  EXPECT_EQ(says("", "0"), name + "is no .mrm file\n");
  EXPECT_EQ(says("ply\n" + golden, "0"), name + "is no .mrm file\n");
  EXPECT_EQ(says(golden + "x", "0"), name + "has 1385 bytes, its header says 1384\n");
  EXPECT_EQ(says(golden, "7"), name + "has levels 0 to 6\n");
  EXPECT_EQ(says(golden, "-1"), name + "has levels 0 to 6\n");
  std::string later = golden;
  later[8] = 2;
  EXPECT_EQ(says(later, "0"), name + "is version 2, this script reads 1\n");
}

TEST(MrmFile, IsNotFoundWhereThereIsNone) {
  const test::TempDir dir;
  const auto read = lod::readMrm(dir / "none.mrm");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::kNotFound);
  EXPECT_NE(read.error().what.find(dir / "none.mrm"), std::string::npos);
  EXPECT_FALSE(lod::readMrm(dir.path()));  // a folder
}

// A model that is shown for months must not change, nor crash the program, if its file changes.
TEST(MrmFile, ACopyStaysAsItIsWhateverBecomesOfTheFile) {
  const test::TempDir dir;
  const lod::Dendrogram model = reducedSphere();
  ASSERT_TRUE(lod::writeMrm(dir / "x.mrm", model));
  const auto copy = lod::readMrmCopy(dir / "x.mrm");
  ASSERT_TRUE(copy) << copy.error().what;
  const std::string before = test::readText(dir / "x.mrm");
  test::writeText(dir / "x.mrm", std::string(before.size(), '\xff'));
  ASSERT_EQ(::truncate((dir / "x.mrm").c_str(), 0), 0);
  ASSERT_TRUE(lod::writeMrm(dir / "again.mrm", *copy));
  EXPECT_EQ(test::readText(dir / "again.mrm"), before);
}

TEST(MrmFile, IsWrittenWholeOrNotAtAll) {
  const test::TempDir dir;
  const auto written = lod::writeMrm(dir / "no/such/folder.mrm", test::goldenCube());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kNotFound);
  ASSERT_TRUE(lod::writeMrm(dir / "cube.mrm", test::goldenCube()));
  const auto before = lod::readMrm(dir / "cube.mrm");
  ASSERT_TRUE(before);
  ASSERT_TRUE(
      lod::writeMrm(dir / "cube.mrm", reducedSphere()));  // replaces the file while it is mapped
  test::expectSame(*before, test::goldenCube());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1) << "no litter";
}

}  // namespace
}  // namespace merlin::render
