// OFF, OM and STL files, read by OpenMesh: what is accepted and what is refused.
#include <array>
#include <string>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

#ifdef MERLIN_ANY_SANITIZER  // each takes twenty times as long, and OpenMesh itself is not
                             // instrumented
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
  // The tetrahedron in another format, as OpenMesh writes it.
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

TEST_F(OpenMeshReader, TellsTheSizeBeforeItReads) {
  test::writeText(dir_ / "t.off", kTetrahedron);
  const auto off = mesh::meshFileSize(dir_ / "t.off");
  ASSERT_TRUE(off);
  EXPECT_EQ(off->mesh.vertices, 4u);
  EXPECT_EQ(off->mesh.triangles, 4u);
  test::writeText(dir_ / "b.stl", tetrahedronAs("stl", OpenMesh::IO::Options::Binary));
  EXPECT_EQ(mesh::meshFileSize(dir_ / "b.stl")->mesh.triangles, 4u);
  test::writeText(dir_ / "c.om", tetrahedronAs("om", OpenMesh::IO::Options::Binary));
  EXPECT_EQ(mesh::meshFileSize(dir_ / "c.om")->mesh.vertices, 4u);
  test::writeText(dir_ / "lie.off", "OFF\n4000000000 4000000000 0\n");
  EXPECT_FALSE(mesh::meshFileSize(dir_ / "lie.off"));
}

// Truncated or damaged files give a mesh or one error, and a mesh no larger than the file's bytes
// allow.
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
