// OFF, OM and STL files, read by OpenMesh: what is accepted and what is refused.
#include <array>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

// With a sanitizer each case takes twenty times as long, while OpenMesh itself is not instrumented,
// so only every third case is run.
#ifdef MERLIN_ANY_SANITIZER
constexpr std::size_t kDamagedEvery = 3;
#else
constexpr std::size_t kDamagedEvery = 1;
#endif

using test::TempDir;

constexpr const char* kTetrahedron =
    "OFF\n# a comment\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2";

class OpenMeshReader : public testing::Test {
 protected:
  Result<mesh::LoadedMesh> read(const std::string& name, const std::string& content) {
    test::writeText(dir_ / name, content);
    return mesh::readMesh(dir_ / name);
  }
  std::string error(const std::string& name, const std::string& content) {
    const auto read_mesh = read(name, content);
    return read_mesh ? "" : read_mesh.error().what.substr((dir_ / name).size());
  }
  // Returns the tetrahedron in another format, as OpenMesh writes it.
  std::string tetrahedronAs(const std::string& ending, OpenMesh::IO::Options options = {}) {
    std::string plain = kTetrahedron;
    plain.erase(4, 12);  // removes the comment, which OpenMesh itself does not read
    test::writeText(dir_ / "t.off", plain);
    OpenMesh::PolyMesh_ArrayKernelT<> mesh;
    EXPECT_TRUE(OpenMesh::IO::read_mesh(mesh, dir_ / "t.off"));
    EXPECT_TRUE(OpenMesh::IO::write_mesh(mesh, dir_ / "t2." + ending, options));
    return test::readText(dir_ / "t2." + ending);
  }
  static void expectTetrahedron(const Result<mesh::LoadedMesh>& loaded, const std::string& what) {
    ASSERT_TRUE(loaded) << what << ": " << loaded.error().what;
    EXPECT_EQ(loaded->mesh.vertexCount(), 4u) << what;
    EXPECT_EQ(loaded->mesh.triangleCount(), 4u) << what;
    EXPECT_EQ(loaded->split.edges + loaded->split.vertices, 0u) << what << ": closed";
    EXPECT_EQ(mesh::boundingBox(loaded->mesh.positions).high, (std::array<float, 3>{1, 1, 1}))
        << what;
  }

  TempDir dir_;
};

TEST_F(OpenMeshReader, ReadsEachFormatInEachForm) {
  using OpenMesh::IO::Options;
  expectTetrahedron(read("a.off", kTetrahedron), "off, the last line without an end");
  expectTetrahedron(read("b.OFF", tetrahedronAs("off")), "off, written by OpenMesh");
  expectTetrahedron(read("c.stl", tetrahedronAs("stl")), "stl");
  expectTetrahedron(read("d.stl", tetrahedronAs("stl", Options::Binary)), "stl, binary");
  expectTetrahedron(read("e.om", tetrahedronAs("om", Options::Binary)), "om");
}

TEST_F(OpenMeshReader, KeepsWhatHalfEdgesCannotHold) {
  const std::string book =
      "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n"
      "3 0 1 2\n3 1 0 3\n3 0 1 4\n";  // three triangles at one edge
  const auto loaded = read("book.off", book);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangleCount(), 3u);
  EXPECT_EQ(loaded->split.edges, 1u);
  OpenMesh::PolyMesh_ArrayKernelT<> theirs;
  OpenMesh::IO::read_mesh(theirs, dir_ / "book.off");
  EXPECT_GT(theirs.n_vertices(), 5u) << "it tears them off: why there is a reader of our own";
}

TEST_F(OpenMeshReader, PolygonsBecomeFansAndColoursFeatures) {
  const auto square = read("square.off",
                           "COFF\n4 1 4\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n"
                           "1 1 0 0 0 255 255\n0 1 0 51 51 51 255\n4 0 1 2 3\n");
  ASSERT_TRUE(square) << square.error().what;
  EXPECT_EQ(square->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  const mesh::Feature* const colour = square->mesh.find("colour");
  ASSERT_TRUE(colour);
  EXPECT_EQ(colour->values[0], 1);
  EXPECT_NEAR(colour->values[9], 0.2, 1e-6);
}

TEST_F(OpenMeshReader, ColoursBehindTheVerticesOfAnOffFileAreTakenAlsoWithoutTheC) {
  const auto coloured = read("a.off",
                             "# of another program\nOFF\n3 1 0\n0 0 0 255 0 0 255\n"
                             "1 0 0 0 255 0 255\n0 1 0 0 0 51 255\n3 0 1 2\n");
  ASSERT_TRUE(coloured) << coloured.error().what;
  ASSERT_TRUE(coloured->mesh.find("colour"));
  EXPECT_EQ(coloured->mesh.find("colour")->values,
            (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 51.0F / 255}));
  EXPECT_TRUE(coloured->notes.empty());
  for (const char* last : {"0 1 0 0 0 -1", "0 1 0", "0 1 0 0 0"}) {
    const auto others = read("a.off", std::string("OFF\n3 1 0\n0 0 0 1 0 0\n1 0 0 0 1 0\n") + last +
                                          "\n3 0 1 2 0 0 255\n");
    ASSERT_TRUE(others) << others.error().what;
    EXPECT_EQ(others->mesh.find("colour")->values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}))
        << "the face's";
    EXPECT_EQ(others->notes,
              std::vector<std::string>{"left out: what follows the coordinates of the vertices"});
  }
}

TEST_F(OpenMeshReader, AFileIsKnownBehindCommentsAndWithContinuedLines) {
  test::writeText(dir_ / "a.ply",
                  "# of another program\n\nOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(mesh::isMeshFile(dir_ / "a.ply"));
  test::writeText(dir_ / "b.ply", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\r\n3\n");
  EXPECT_TRUE(mesh::isMeshFile(dir_ / "b.ply")) << "an OBJ file with a line in two parts";
}

TEST_F(OpenMeshReader, AFaceThatIsNotConvexIsCutWithinItself) {
  const auto arrow = read("arrow.off", "OFF\n4 1 4\n0 0 0\n2 2 0\n0 1 0\n-2 2 0\n4 1 2 3 0\n");
  ASSERT_TRUE(arrow) << arrow.error().what;
  EXPECT_EQ(arrow->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 0}));
}

TEST_F(OpenMeshReader, TheBrightestColourOfAnOffFileTellsWhetherAllAreFractions) {
  const auto colours = [&](const std::string& first, const std::string& second) {
    const auto loaded = read("a.off", "COFF\n3 1 0\n0 0 0 " + first + " 1\n1 0 0 " + second +
                                          " 1\n0 1 0 0 0 0 1\n3 0 1 2\n");
    EXPECT_TRUE(loaded) << loaded.error().what;
    std::vector<float> all = loaded->mesh.find("colour")->values;
    all.resize(6);
    return all;
  };
  using Floats = std::vector<float>;
  EXPECT_EQ(colours("1 0 0", "0.5 0.5 0"), (Floats{1, 0, 0, 0.5F, 0.5F, 0}));
  EXPECT_EQ(colours("1 0 0", "0 1 0"), (Floats{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(colours("0 0 0", "51 255 0"), (Floats{0, 0, 0, 0.2F, 1, 0}));
  EXPECT_EQ(colours("0.0 0 0", "51 255 0"), (Floats{0, 0, 0, 0.2F, 1, 0}));
}

// Returns the colours of the triangles' corners, one list for each triangle.
std::vector<std::vector<float>> coloursAtCorners(const mesh::Mesh& mesh) {
  std::vector<std::vector<float>> all(mesh.triangleCount());
  const mesh::Feature* const colour = mesh.find("colour");
  for (std::size_t i = 0; colour && i < mesh.triangles.size(); ++i) {
    const float* const c = &colour->values[3 * std::size_t{mesh.triangles[i]}];
    all[i / 3].insert(all[i / 3].end(), c, c + 3);
  }
  return all;
}
std::vector<float> threeTimes(const std::vector<float>& colour) {
  std::vector<float> all;
  for (int k = 0; k < 3; ++k) all.insert(all.end(), colour.begin(), colour.end());
  return all;
}

TEST_F(OpenMeshReader, ColoursOfAnOffFilesFacesBecomeThoseOfTheirCorners) {
  const std::string vertices = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const auto one = read("a.off", vertices + "3 0 1 2\n3 0 2 3 255 0 51 255\n");
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_EQ(one->notes.size(), 0u);
  EXPECT_EQ(one->mesh.vertexCount(), 6u) << "two for each end of the edge between the colours";
  const auto colours = coloursAtCorners(one->mesh);
  EXPECT_EQ(colours[0], threeTimes({1, 1, 1}));
  EXPECT_EQ(colours[1], threeTimes({1, 0, 0.2F}));
  const auto both = read("a.off", vertices + "3 0 1 2 0.5 0 1\n3 0 2 3 0.5 0 1\n");
  EXPECT_EQ(both->mesh.vertexCount(), 4u) << "the same colour";
  const auto polygon = read("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0 1 0\n");
  EXPECT_EQ(coloursAtCorners(polygon->mesh)[1], threeTimes({0, 1, 0}));
  EXPECT_EQ(read("a.off", vertices + "3 0 1 2\n3 0 2 3  # none\n")->mesh.find("colour"), nullptr);
  EXPECT_EQ(read("a.off", vertices + "3 0 1 2 7\n3 0 2 3\n")->notes,
            (std::vector<std::string>{"left out: the colours of 1 faces"}));
  EXPECT_FALSE(read("a.off", vertices + "3 0 1 2 inf 0 0\n3 0 2 3\n"));
}

TEST_F(OpenMeshReader, SaysWhatIsWrong) {
  EXPECT_EQ(error("a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n"),
            ": line 7: the file ends after 1 of 4 faces");
  EXPECT_EQ(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            ": line 6: face 0 refers to vertex 3, but there are 3");
  EXPECT_EQ(error("a.off", "OFF\n4000000000 4000000000 0\n"),
            ": line 2: declares 4000000000 vertices and 4000000000 faces in a file of 28 bytes");
  EXPECT_EQ(error("a.off", "OFF BINARY\n"), ": is a binary OFF file; only ASCII is supported");
  EXPECT_EQ(error("a.off", "OFF 3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
            ": line 3: vertex 1: a number is missing or malformed");
  EXPECT_NE(error("a.off", "ply\n").find("does not begin with OFF"), std::string::npos);
  EXPECT_NE(error("a.stl", "hello").find("is neither an ASCII STL"), std::string::npos);
  EXPECT_NE(error("a.om", "OM").find("does not begin with the header"), std::string::npos);
}

std::string facet(const std::string& vertices) {
  return " facet normal 0 0 1\n  outer loop\n" + vertices + "  endloop\n endfacet\n";
}
const std::string kCorners = "   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n";

TEST_F(OpenMeshReader, AnAsciiStlIsReadWholeOrRefused) {
  const auto fault = [&](const std::string& facets, const std::string& end = "endsolid a\n") {
    return error("a.stl", "solid a\n" + facet(kCorners) + facets + end);
  };
  EXPECT_EQ(fault(""), "");
  EXPECT_EQ(fault(facet("   vertex 2 0 0\n   vertex 3 nan 0\n   vertex 2 1 0\n")),
            ": line 12: \"nan\" is not a coordinate");
  EXPECT_EQ(fault(facet("   vertex 2 0 0\n   vertex 3 abc 0\n   vertex 2 1 0\n")),
            ": line 12: \"abc\" is not a coordinate");
  EXPECT_EQ(fault(facet("   vertex 2 0 0\n   vertex 3 1e39 0\n   vertex 2 1 0\n")),
            ": line 12: \"1e39\" is not a coordinate");
  EXPECT_EQ(fault(facet("   vertex 2 0 0\n   vertex 3 0\n   vertex 2 1 0\n")),
            ": line 12: a vertex needs 3 coordinates, this one has 2");
  EXPECT_EQ(fault(facet("   vertex 2 0 0 1\n   vertex 3 0 0\n   vertex 2 1 0\n")),
            ": line 11: \"1\" follows the coordinates of a vertex");
  EXPECT_EQ(fault(facet(kCorners + "   vertex 9 9 9\n")),
            ": line 15: a loop needs 3 vertices, this one has 4");
  EXPECT_EQ(fault(facet("   vertex 2 0 0\n   vertex 3 0 0\n")),
            ": line 13: a loop needs 3 vertices, this one has 2");
  EXPECT_EQ(fault("  outer loop\n"), ": line 9: a facet needs one loop");
  EXPECT_EQ(fault("   vertex 2 0 0\n"), ": line 9: a vertex is outside of a loop");
  EXPECT_EQ(fault("endloop\n"), ": line 9: a loop ends that has not begun");
  EXPECT_EQ(fault(" facet normal 0 0 1\n endfacet\n"),
            ": line 10: a facet ends without a whole loop");
  EXPECT_EQ(fault(" facet normal 0 0 1\n"), ": line 10: the solid ends within a facet");
  EXPECT_EQ(fault(" facet normal 0 0 1\n" + facet(kCorners)),
            ": line 10: a facet begins within another one");
  EXPECT_EQ(fault(facet(kCorners), ""),
            ": cut short: the file ends without endsolid, after 2 facets");
}

TEST_F(OpenMeshReader, AnAsciiStlMayBeInCapitals) {
  const std::string text = "SOLID A\n" + facet("VERTEX 0 0 0\nVERTEX 1E0 0 0\nVertex 0 1 0\n") +
                           "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 1 0\nVERTEX 1 0 0\n"
                           "VERTEX 1 1 0\nENDLOOP\nENDFACET\nENDSOLID A\n\n";
  const auto loaded = read("a.stl", text);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangleCount(), 2u);
  EXPECT_EQ(loaded->mesh.vertexCount(), 4u);
  EXPECT_TRUE(mesh::isMeshFile(dir_ / "a.stl"));
}

TEST_F(OpenMeshReader, ColoursOfABinaryStlAreThoseOfVisCamOrOfMagics) {
  std::string bytes = tetrahedronAs("stl", OpenMesh::IO::Options::Binary);
  const auto set = [&](std::size_t triangle, unsigned attribute) {
    bytes[84 + 50 * triangle + 48] = static_cast<char>(attribute & 0xFF);
    bytes[84 + 50 * triangle + 49] = static_cast<char>(attribute >> 8);
  };
  EXPECT_EQ(read("a.stl", bytes)->mesh.find("colour"), nullptr);
  set(0, 0x1F);
  const auto none = read("a.stl", bytes);
  EXPECT_EQ(none->mesh.find("colour"), nullptr);
  EXPECT_EQ(
      none->notes,
      (std::vector<std::string>{"left out: the attributes of 1 triangles, which are not colours"}));

  set(0, 0x8000 | 31U << 10);
  set(3, 0x8000 | 31U);
  const auto viscam = read("a.stl", bytes);
  EXPECT_EQ(viscam->notes.size(), 0u);
  EXPECT_EQ(coloursAtCorners(viscam->mesh),
            (std::vector<std::vector<float>>{threeTimes({1, 0, 0}), threeTimes({1, 1, 1}),
                                             threeTimes({1, 1, 1}), threeTimes({0, 0, 1})}));

  bytes.replace(10, 10, "COLOR=\x33\xFF\x01\xFF");
  bytes[17 + 1] = '\0';
  set(0, 31U);
  set(1, 0x8000);
  set(2, 31U << 10);
  const auto magics = read("a.stl", bytes);
  EXPECT_EQ(coloursAtCorners(magics->mesh),
            (std::vector<std::vector<float>>{threeTimes({1, 0, 0}), threeTimes({0.2F, 1, 0}),
                                             threeTimes({0, 0, 1}), threeTimes({0.2F, 1, 0})}));
  for (std::size_t t = 0; t < 4; ++t) set(t, 0);
  EXPECT_EQ(coloursAtCorners(read("a.stl", bytes)->mesh)[2], threeTimes({0.2F, 1, 0}))
      << "the header alone";
}

TEST_F(OpenMeshReader, TellsTheSizeBeforeItReads) {
  test::writeText(dir_ / "t.off", kTetrahedron);
  const auto off = mesh::meshFileSize(dir_ / "t.off");
  ASSERT_TRUE(off);
  EXPECT_EQ(off->mesh.vertices, 4u);
  EXPECT_EQ(off->mesh.triangles, 4u);
  test::writeText(dir_ / "b.stl", tetrahedronAs("stl", OpenMesh::IO::Options::Binary));
  EXPECT_EQ(mesh::meshFileSize(dir_ / "b.stl")->mesh.triangles, 4u);
  test::writeText(dir_ / "a.stl", tetrahedronAs("stl"));
  EXPECT_EQ(mesh::meshFileSize(dir_ / "a.stl")->mesh.triangles, 4u) << "as its facets are counted";
  test::writeText(dir_ / "c.om", tetrahedronAs("om", OpenMesh::IO::Options::Binary));
  EXPECT_EQ(mesh::meshFileSize(dir_ / "c.om")->mesh.vertices, 4u);
  test::writeText(dir_ / "lie.off", "OFF\n4000000000 4000000000 0\n");
  EXPECT_FALSE(mesh::meshFileSize(dir_ / "lie.off"));
}

// Truncated or damaged files give either one error, or a mesh that is no larger than the file's
// bytes allow.
TEST_F(OpenMeshReader, EveryPrefixAndEveryDamagedByteEndsWell) {
  using OpenMesh::IO::Options;
  const std::pair<std::string, std::string> files[] = {
      {"a.off", kTetrahedron},
      {"c.stl", tetrahedronAs("stl")},
      {"d.stl", tetrahedronAs("stl", Options::Binary)},
      {"e.om", tetrahedronAs("om", Options::Binary)}};
  for (const auto& [name, whole] : files) {
    for (std::size_t n = 0; n < whole.size(); ++n) (void)read(name, whole.substr(0, n));
    for (std::size_t n = 0; n < whole.size(); n += kDamagedEvery) {
      for (const int by : {1, 0x80, 0xFF}) {
        std::string damaged = whole;
        damaged[n] = static_cast<char>(damaged[n] ^ by);
        const auto loaded = read(name, damaged);
        EXPECT_TRUE(!loaded || loaded->mesh.vertexCount() <= whole.size()) << name << ' ' << n;
      }
    }
  }
}

}  // namespace
}  // namespace merlin::render
