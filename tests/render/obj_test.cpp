#include <algorithm>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

#include "render/mesh/io/mesh_file.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

class ObjFile : public testing::Test {
 protected:
  Result<mesh::LoadedMesh> read(const std::string& text) {
    test::writeText(path_, text);
    return mesh::readMesh(path_);
  }
  // Reads a file that has the four corners of a square, followed by `faces`.
  Result<mesh::LoadedMesh> readFaces(const std::string& faces) {
    return read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + faces);
  }
  Indices trianglesOf(const std::string& faces) {
    const auto loaded = readFaces(faces);
    return loaded ? loaded->mesh.triangles : Indices{};
  }
  // Returns the error message for `text`, without the file's name.
  std::string faultOf(const std::string& text) {
    const auto loaded = read(text);
    return loaded ? "none" : loaded.error().what.substr(path_.size() + 2);
  }
  std::string faultOfFaces(const std::string& faces) {
    const auto loaded = readFaces(faces);
    return loaded ? "none" : loaded.error().what.substr(path_.size() + 2);
  }

  const test::TempDir dir_;
  const std::string path_ = dir_ / "a.obj";
};

TEST_F(ObjFile, HasTrianglesAndFansOfLargerFaces) {
  const Indices square{0, 1, 3, 0, 3, 2};
  EXPECT_EQ(trianglesOf("f 1 2 4\nf 1 4 3\n"), square);
  EXPECT_EQ(trianglesOf("f 1 2 4 3\n"), square);
}

// The face is an arrow's head: the fan around its first corner would lie partly outside of it.
TEST_F(ObjFile, AFaceThatIsNotConvexIsCutWithinItself) {
  const std::string arrow = "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\n";
  const auto at = read(arrow + "f 2 3 4 1\n");
  ASSERT_TRUE(at) << at.error().what;
  EXPECT_EQ(at->mesh.triangles, (Indices{0, 1, 2, 2, 3, 0}));
  const auto later = read("f 2 3 4 1\n" + arrow);
  ASSERT_TRUE(later) << later.error().what;
  EXPECT_EQ(later->mesh.triangles, at->mesh.triangles) << "vertices may follow their faces";
}

TEST_F(ObjFile, CornersKeepTheirTextureWhereAFaceIsCutWithinItself) {
  const auto loaded = read(
      "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\nvt 0.1 0\nvt 0.2 0\nvt 0.3 0\nvt 0.4 0\n"
      "f 2/2 3/3 4/4 1/1\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 2, 2, 3, 0}));
  EXPECT_EQ(loaded->mesh.find("texcoord")->values, (Floats{0.1F, 0, 0.2F, 0, 0.3F, 0, 0.4F, 0}));
}

TEST_F(ObjFile, MayNameNormalsAndTextureAtEachCorner) {
  const std::string extra = "vt 0 0\nvt 1 0\nvn 0 0 1\n";
  const Indices square{0, 1, 3, 0, 3, 2};
  EXPECT_EQ(trianglesOf(extra + "f 1//1 2//1 4//1 3//1\n"), square);
  EXPECT_EQ(trianglesOf(extra + "f 1/1 2/2 4/1 3/2\n"), square);
  EXPECT_EQ(trianglesOf(extra + "f 1/1/1 2/2/1 4/1/1 3/2/1\n"), square);
}

TEST_F(ObjFile, CountsNegativeIndicesFromTheVerticesSoFar) {
  EXPECT_EQ(trianglesOf("f -4 -3 -1\nv 5 5 5\nf -4 -5 -1\n"), (Indices{0, 1, 2, 1, 0, 3}));
}

// Two squares side by side share an edge; a triangle behind them touches neither.
TEST_F(ObjFile, ObjectsAndGroupsBecomeLabels) {
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 0 0 9\nv 1 0 9\nv 0 1 9\n";
  const auto loaded =
      read(vertices + "o unused\no a\nf 1 2 3\nf 1 3 4\no b\nf 2 5 6\nf 2 6 3\ng c\nf 7 8 9\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const mesh::Mesh& mesh = loaded->mesh;
  EXPECT_EQ(mesh.vertexCount(), 9U) << "the two squares stay connected";
  ASSERT_NE(mesh.find("label"), nullptr);
  EXPECT_EQ(mesh.find("label")->values, (Floats{0, 0, 0, 0, 1, 1, 2, 2, 2}));
  ASSERT_EQ(loaded->notes.size(), 1U);
  EXPECT_NE(loaded->notes[0].find("its 3 objects and groups"), std::string::npos);
  const auto one = read(vertices + "o a\ng x\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(one->mesh.find("label"), nullptr) << "one needs no number";
}

// No corner belongs to the middle triangle alone: each corner is shared with a neighbour whose
// label is lower.
TEST_F(ObjFile, ATriangleOfEachPartKeepsACornerWithItsLabel) {
  const auto loaded = read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 -1 0\nv 1 1 0\nv -1 0 0\n"
      "g a\nf 2 1 4\nf 3 2 5\nf 1 3 6\ng b\nf 1 2 3\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const mesh::Mesh& mesh = loaded->mesh;
  const Floats& label = mesh.find("label")->values;
  ASSERT_EQ(mesh.triangleCount(), 4U);
  Floats parts;
  for (std::size_t t = 0; t < 4; ++t) {
    const std::uint32_t* c = &mesh.triangles[3 * t];
    parts.push_back(std::max({label[c[0]], label[c[1]], label[c[2]]}));
  }
  EXPECT_EQ(parts, (Floats{0, 0, 0, 1}));
  const std::uint32_t own = mesh.triangles[9];
  EXPECT_EQ(label[own], 1);
  EXPECT_EQ((Floats{&mesh.positions[3 * own], &mesh.positions[3 * own] + 3}), (Floats{0, 0, 0}));
}

TEST_F(ObjFile, MayHoldWhatMerlinHasNoUseFor) {
  const auto loaded = read(
      "# made by hand\r\nmtllib none.mtl\r\no square\r\ng all\r\nusemtl red\r\ns off\r\n"
      "v 0 0 0 # corner\r\nv 1 0 0\r\n\r\n  v\t0  1 0\r\nl 1 2\r\np 1\r\nvp 0.5\r\nf 1 2 3 # face");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 2}));
}

TEST_F(ObjFile, SaysWhichGeometryIsLeftOut) {
  const auto loaded = readFaces("f 1 2 3\nl 1 2\nl 2 3\np 1\nvp 0.5\ncurv 0 1 1 2\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes,
            (std::vector<std::string>{"left out: 2 lines (l), 1 points (p), 1 curves (curv)"}));
  EXPECT_EQ(readFaces("f 1 2 3\n")->notes.size(), 0u);
}

TEST_F(ObjFile, GoesOnInTheNextLineBehindABackslash) {
  EXPECT_EQ(trianglesOf("f 1 \\\n2 \\ \r\n  4\nf 1 4 3"), (Indices{0, 1, 3, 0, 3, 2}));
  EXPECT_EQ(faultOfFaces("f 1 2\\\n x\n"), "line 6: \"x\" is not a corner of a face");
  EXPECT_EQ(trianglesOf("f 1 2 3 \\"), (Indices{0, 1, 2}));
  EXPECT_EQ(trianglesOf("g C:\\parts\\\nf 1 2 3\n"), (Indices{0, 1, 2})) << "a name";
  EXPECT_EQ(trianglesOf("g a \\\nf b\nf\\\n1 2 3\n"), (Indices{0, 1, 2})) << "a name that goes on";
}

TEST_F(ObjFile, HasColoursWhereEveryVertexHasOne) {
  const auto loaded = read("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 0.25\nf 1 2 3\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  ASSERT_NE(loaded->mesh.find("colour"), nullptr);
  EXPECT_EQ(loaded->mesh.find("colour")->values, (Floats{1, 0, 0, 0, 0.5F, 0, 0, 0, 0.25F}));
  const auto bytes = read("v 0 0 0 1 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 255\nf 1 2 3\n");
  EXPECT_EQ(bytes->mesh.find("colour")->values, (Floats{1 / 255.0F, 0, 0, 0, 0.2F, 0, 0, 0, 1}));
  const auto without = read("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_TRUE(without) << without.error().what;
  EXPECT_TRUE(without->mesh.features.empty());
}

TEST_F(ObjFile, IsRefusedWhereALineIsNotWhole) {
  for (const auto& [vertex, fault] : {std::pair{"v 1 0", "needs 3 coordinates, this one has 2"},
                                      std::pair{"v", "needs 3 coordinates, this one has 0"},
                                      std::pair{"v\r", "needs 3 coordinates, this one has 0"}}) {
    EXPECT_EQ(faultOf(std::string("v 0 0 0\n") + vertex + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              std::string("line 2: a vertex ") + fault);
  }
  EXPECT_EQ(faultOf("v 0 0 nan\n"), "vertex 0: coordinate z is nan; the limit is +-1e+18");
  EXPECT_EQ(faultOf("v 0 0 1e99\n"), "vertex 0: coordinate z is inf; the limit is +-1e+18");
  EXPECT_EQ(faultOfFaces("f 1 2 4\nf 1 2\n"),
            "line 6: a face needs 3 corners or more, this one has 2");
  EXPECT_EQ(faultOfFaces("f\n"), "line 5: a face needs 3 corners or more, this one has 0");
  EXPECT_EQ(faultOf("vt\n"), "line 1: a texture coordinate has no numbers");
}

TEST_F(ObjFile, CountsATriangleWithAVertexTwice) {
  const auto loaded = readFaces("f 1 2 4\nf 1 1 3\nf 1 4 3\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 3, 0, 3, 2}));
  EXPECT_EQ(loaded->tidied.degenerate, 1u);
}

TEST_F(ObjFile, NamesTheLineOfAWordThatIsNoNumber) {
  EXPECT_EQ(faultOf("\n# x\nv 0 one 0\n"), "line 3: \"one\" is not a number");
  EXPECT_EQ(faultOf("v 1.0.0 0 0\n"), "line 1: \"1.0.0\" is not a number");
  for (const char* corner :
       {"x", "1.5", "//1", "/1", "/", "x/1", "99999999999", "1e2", "\xFF", "1/x", "1/1.5"}) {
    EXPECT_EQ(faultOfFaces("f 1 2 3\nf 1 2 " + std::string(corner) + "\n"),
              "line 6: \"" + std::string(corner) + "\" is not a corner of a face");
  }
}

// A line may be as long as the file, so messages quote only its beginning.
TEST_F(ObjFile, IsQuotedInShort) {
  const std::string word(1 << 20, 'x'), quoted(64, 'x');
  EXPECT_EQ(faultOf("v 1 2 " + word), "line 1: \"" + quoted + "...\" is not a number");
  EXPECT_EQ(faultOfFaces("f 1 2 " + word),
            "line 5: \"" + quoted + "...\" is not a corner of a face");
}

TEST_F(ObjFile, IsRefusedAtOnceWhereItIsNoText) {
  EXPECT_EQ(faultOf(std::string(1 << 20, '\0')), "byte 0 is 0: an OBJ file is text");
  EXPECT_EQ(faultOf("v 0 0 0\n" + std::string(1, '\0')), "byte 8 is 0: an OBJ file is text");
}

TEST_F(ObjFile, IsRefusedWhereAFacePointsNowhere) {
  EXPECT_EQ(faultOfFaces("f 1 2 4\nf 1 2 5\n"),
            "line 6: a corner refers to vertex 5, but there are 4");
  EXPECT_EQ(faultOfFaces("f 0 2 3\n"), "line 5: a corner refers to vertex 0, but there are 4");
  EXPECT_EQ(faultOfFaces("f 1 2 -5\n"), "line 5: a corner refers to vertex -5, but there are 4");
}

TEST_F(ObjFile, WithoutFacesOrOfSomethingElseIsNoMesh) {
  EXPECT_EQ(faultOfFaces(""), "has no triangles");
  EXPECT_EQ(faultOf("banana\n"), "has no triangles");
  EXPECT_EQ(faultOf(std::string(1000, '\0')), "byte 0 is 0: an OBJ file is text");
}

// A file with one wrong byte, or one that ends early, gives a valid mesh or an error.
TEST_F(ObjFile, SurvivesDamage) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 -1\nf 1 2 3\n";
  std::size_t refused = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    refused += !read(text.substr(0, at));
    for (const char c : {'\0', ' ', '\n', '-', '9', '/', 'v', 'f', 'x', '\xFF'}) {
      std::string damaged = text;
      damaged[at] = c;
      const auto loaded = read(damaged);
      refused += !loaded;
      EXPECT_TRUE(!loaded || validate(loaded->mesh));
    }
  }
  EXPECT_GT(refused, 2 * text.size());
}

std::string objOf(const mesh::Mesh& mesh) {
  std::string text;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    text +=
        (i % 3 == 0 ? "v " : " ") + std::to_string(mesh.positions[i]) + (i % 3 == 2 ? "\n" : "");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    text += (i % 3 == 0 ? "f " : " ") + std::to_string(mesh.triangles[i] + 1) +
            (i % 3 == 2 ? "\n" : "");
  }
  return text;
}

// OpenMesh's half-edge mesh is the oracle; on a manifold mesh it loses nothing.
TEST_F(ObjFile, AgreesWithAHalfEdgeMesh) {
  const auto loaded = read(objOf(test::sphere(2)));
  ASSERT_TRUE(loaded) << loaded.error().what;
  OpenMesh::TriMesh_ArrayKernelT<> oracle;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(oracle, path_));
  ASSERT_EQ(loaded->mesh.vertexCount(), oracle.n_vertices());
  ASSERT_EQ(loaded->mesh.triangleCount(), 128u);
  ASSERT_EQ(oracle.n_faces(), 128u);
  std::size_t corner = 0;
  for (const auto& face : oracle.faces()) {
    for (const auto& vertex : face.vertices()) {
      const std::uint32_t v = loaded->mesh.triangles[corner++];
      ASSERT_EQ(static_cast<int>(v), vertex.idx());
      const auto& p = oracle.point(vertex);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(loaded->mesh.positions[3 * v + k], p[k]);
      }
    }
  }
}

}  // namespace
}  // namespace merlin::render
