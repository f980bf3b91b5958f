#include "render/mesh/io/mesh_file.h"

#include <filesystem>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/ply_files.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using test::readText;
using test::TempDir;
using test::writeText;
using Floats = std::vector<float>;
using Limits = std::numeric_limits<float>;

// Returns a square with floats that only a binary format keeps exactly, and with every feature that
// a format stores in a special way. In the file, colours are bytes: 0, 1, 254 and 255 of 255.
mesh::Mesh richSquare() {
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.positions = {0.1F,  -0.0F, 1e-40F, 1e18F, Limits::min(), -1.0F / 3,
                    1e-7F, 2.0F,  3.0F,   4.0F,  5.0F,          6.0F};
  mesh.features = {{"normal", 3, Floats(12, 0.57735027F)},
                   {"colour", 3, {}},
                   {"texcoord", 2, {0, 1, 2, 3, 4, 5, 6, 7}},
                   {"heat", 1, {1e-30F, -2, 1e30F, 0.1F}}};
  for (const int byte : {0, 1, 254, 255, 0, 1, 254, 255, 0, 1, 254, 255}) {
    mesh.features[1].values.push_back(static_cast<float>(byte) * (1.0F / 255));
  }
  return mesh;
}

TEST(WriteMesh, IsReadBackBitByBit) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  ASSERT_TRUE(mesh::writeMesh(dir / "a.ply", mesh));
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.positions, mesh.positions);
  EXPECT_TRUE(std::signbit(loaded->mesh.positions[1]));
  EXPECT_EQ(loaded->mesh.triangles, mesh.triangles);
  ASSERT_EQ(loaded->mesh.features.size(), 4u);
  for (std::size_t f = 0; f < 4; ++f) {
    EXPECT_EQ(loaded->mesh.features[f].name, mesh.features[f].name);
    EXPECT_EQ(loaded->mesh.features[f].dimension, mesh.features[f].dimension);
    EXPECT_EQ(loaded->mesh.features[f].values, mesh.features[f].values) << f;
  }
  EXPECT_EQ(loaded->notes.size() + loaded->tidied.degenerate + loaded->tidied.unused, 0u);
}

TEST(WriteMesh, GivesTheSameBytesForWhatItRead) {
  const TempDir dir;
  ASSERT_TRUE(mesh::writeMesh(dir / "a.ply", richSquare()));
  ASSERT_TRUE(mesh::writeMesh(dir / "b.ply", mesh::readMesh(dir / "a.ply")->mesh));
  EXPECT_EQ(readText(dir / "a.ply"), readText(dir / "b.ply"));
}

TEST(WriteMesh, HoldsColoursWithinTheirRange) {
  const TempDir dir;
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.features = {{"colour", 3, {-1, 0.5F, 7, 0, 0.001F, 0.999F, 0, 0, 0, 1, 1, 1}}};
  ASSERT_TRUE(mesh::writeMesh(dir / "a.ply", mesh));
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const Floats& colour = loaded->mesh.find("colour")->values;
  const int bytes[] = {0, 128, 255, 0, 0, 255, 0, 0, 0, 255, 255, 255};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(colour[i], static_cast<float>(bytes[i]) * (1.0F / 255)) << i;
  }
}

TEST(WriteMesh, NumbersTheColumnsOfAWideFeature) {
  const TempDir dir;
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.features = {{"flow", 2, {0, 1, 10, 11, 20, 21, 30, 31}}, {"heat", 1, {1, 2, 3, 4}}};
  ASSERT_TRUE(mesh::writeMesh(dir / "a.ply", mesh));
  EXPECT_NE(readText(dir / "a.ply").find("property float flow_0\nproperty float flow_1\n"),
            std::string::npos);
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  ASSERT_EQ(loaded->mesh.features.size(), 2u);
  EXPECT_EQ(loaded->mesh.find("flow")->dimension, 2u);
  EXPECT_EQ(loaded->mesh.find("flow")->values, mesh.features[0].values);
  EXPECT_EQ(loaded->mesh.find("heat")->values, mesh.features[1].values);
}

TEST(ReadMesh, GroupsNumberedPropertiesThatFollowOneAnother) {
  const TempDir dir;
  const auto namesOf = [&](const std::vector<std::string>& properties) {
    std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\n";
    std::string rest;
    for (const std::string& p : properties) {
      header += "property float " + p + "\n";
      rest += " 5";
    }
    writeText(dir / "a.ply", header +
                                 "element face 1\nproperty list uchar int vertex_indices\n"
                                 "end_header\n0 0 0" +
                                 rest + "\n1 0 0" + rest + "\n0 1 0" + rest + "\n3 0 1 2\n");
    const auto loaded = mesh::readMesh(dir / "a.ply");
    std::string names;
    for (const mesh::Feature& f : loaded->mesh.features)
      names += (names.empty() ? "" : " ") + f.name + ":" + std::to_string(f.dimension);
    return names;
  };
  EXPECT_EQ(namesOf({"a_0", "a_1", "a_2", "b_0", "b_1"}), "a:3 b:2");
  EXPECT_EQ(namesOf({"a_0"}), "a_0:1");
  EXPECT_EQ(namesOf({"a_1", "a_2"}), "a_1:1 a_2:1");
  EXPECT_EQ(namesOf({"a_0", "a_2"}), "a_0:1 a_2:1");
  EXPECT_EQ(namesOf({"a_0", "a_01"}), "a_0:1 a_01:1");
  EXPECT_EQ(namesOf({"a_0", "a_1", "a"}), "a_0:1 a_1:1 a:1");
  EXPECT_EQ(namesOf({"colour_0", "colour_1"}), "colour_0:1 colour_1:1");
  EXPECT_EQ(namesOf({"tx", "ty", "diffuse_red", "diffuse_green", "diffuse_blue", "confidence",
                     "thermal", "radiation", "label"}),
            "texcoord:2 colour:3 confidence:1 thermal:1 radiation:1 label:1");
}

TEST(ReadMesh, ColoursOfFacesBecomeThoseOfTheirCorners) {
  const TempDir dir;
  const auto read = [&](const std::string& of_vertices, const std::string& vertex) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\n" +
        of_vertices +
        "element face 2\nproperty uchar red\nproperty uchar green\n"
        "property list uchar int vertex_indices\nproperty uchar blue\nend_header\n";
    for (const char* const p : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}) text += p + vertex + "\n";
    writeText(dir / "a.ply", text + "255 0 3 0 1 2 0\n0 255 3 0 2 3 255\n");
    return mesh::readMesh(dir / "a.ply");
  };
  const auto loaded = read("", "");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes.size(), 0u);
  EXPECT_EQ(loaded->mesh.vertexCount(), 6u);
  const mesh::Feature* const colour = loaded->mesh.find("colour");
  ASSERT_TRUE(colour);
  for (std::size_t i = 0; i < 6; ++i) {
    const float* const c = &colour->values[3 * std::size_t{loaded->mesh.triangles[i]}];
    EXPECT_EQ(std::vector(c, c + 3),
              i < 3 ? (std::vector<float>{1, 0, 0}) : (std::vector<float>{0, 1, 1}));
  }
  const auto vertices =
      read("property uchar red\nproperty uchar green\nproperty uchar blue\n", " 0 255 0");
  EXPECT_EQ(vertices->mesh.vertexCount(), 4u);
  EXPECT_EQ(vertices->notes,
            (std::vector<std::string>{"left out: colours (of the faces, since the vertices have "
                                      "colours)"}));
}

// The file need not name a texture, since the texture may be given on the command line (mesh import
// --texture).
TEST(ReadMesh, TextureCoordinatesOfFacesNeedNoPictureInTheFile) {
  const TempDir dir;
  writeText(dir / "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            "property list uchar float texcoord\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 0.5 0 0 0.25\n");
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes.size(), 0u);
  const mesh::Feature* const texcoord = loaded->mesh.find("texcoord");
  ASSERT_TRUE(texcoord);
  EXPECT_EQ(texcoord->values, (std::vector<float>{0, 0, 0.5F, 0, 0, 0.25F}));
}

TEST(WriteMesh, IsDoneWholeOrNotAtAll) {
  const TempDir dir;
  const auto refused = mesh::writeMesh(dir / "none/a.ply", test::cube());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find(dir / "none/a.ply"), std::string::npos);
  const auto other = mesh::writeMesh(dir / "a.off", test::cube());
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::kUnsupported);
  EXPECT_EQ(other.error().what,
            dir / "a.off" + ": meshes are written as .ply, .obj, .glb, .gltf, .stl and .iv");
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

TEST(ReadMesh, GoesByTheEndingInSmallOrLargeLetters) {
  const TempDir dir;
  writeText(dir / "a.PLY", test::squareFile(test::Form::kBig));
  ASSERT_TRUE(mesh::readMesh(dir / "a.PLY"));
  writeText(dir / "a.Obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_TRUE(mesh::readMesh(dir / "a.Obj"));
  for (const char* name : {"a.glb", "ply", "a.ply.gz", "x.ply/a"}) {
    const auto refused = mesh::readMesh(dir / name);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Errc::kUnsupported) << name;
    EXPECT_EQ(
        refused.error().what,
        dir / name +
            ": is not a mesh file that can be read here; supported are .ply, .obj, .off, .om and "
            ".stl. merlin mesh import reads other formats and writes a model");
  }
}

// Some editors on Windows write a byte order mark, EF BB BF, before the text.
TEST(ReadMesh, BehindAByteOrderMarkIsTheSameMesh) {
  const TempDir dir;
  const std::pair<const char*, std::string> files[] = {
      {"a.ply", test::squareFile(test::Form::kAscii)},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 2 4 3\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n"}};
  for (const auto& [name, text] : files) {
    writeText(dir / name, text);
    const auto plain = mesh::readMesh(dir / name);
    ASSERT_TRUE(plain) << name << plain.error().what;
    writeText(dir / name, "\xEF\xBB\xBF" + text);
    EXPECT_TRUE(mesh::isMeshFile(dir / name)) << name;
    const auto marked = mesh::readMeshByContent(dir / name);
    ASSERT_TRUE(marked) << name << marked.error().what;
    EXPECT_EQ(marked->mesh.positions, plain->mesh.positions) << name;
    EXPECT_EQ(marked->mesh.triangles, plain->mesh.triangles) << name;
  }
}

TEST(ReadMesh, TidiesWhatItRead) {
  const TempDir dir;
  const std::string file = test::squareFile(test::Form::kAscii);
  writeText(dir / "a.ply", test::replaced(file, "4 0 1 3 2", "3 1 1 0"));
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(loaded->mesh.vertexCount(), 3u);
  EXPECT_EQ(loaded->tidied.degenerate, 1u);
  EXPECT_EQ(loaded->tidied.unused, 1u);
}

TEST(ReadMesh, TwoCornersOfATriangleAtOnePlaceBecomeOne) {
  const TempDir dir;
  writeText(dir / "a.obj",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\nf 5 3 4\nf 1 3 5\n");
  const auto loaded = mesh::readMesh(dir / "a.obj");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(loaded->tidied.degenerate, 1u);
  EXPECT_EQ(loaded->tidied.unused, 1u);
}

// A float keeps seven digits, but the northing of a map has nine.
TEST(ReadMesh, CoordinatesOfAMapKeepTheirDigitsByAnOrigin) {
  const TempDir dir;
  const auto ply = [&](const std::string& type) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty " + type + " x\nproperty " + type +
           " y\nproperty " + type +
           " z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "450000.125 5400000.0625 12\n450000.25 5400000.125 12\n450001 5400001.5 13\n3 0 1 2\n";
  };
  writeText(dir / "a.ply", ply("double"));
  writeText(dir / "a.obj",
            "v 450000.125 5400000.0625 12\nv 450000.25 5400000.125 12\nv 450001 5400001.5 13\n"
            "f 1 2 3\n");
  writeText(dir / "a.off",
            "OFF\n3 1 0\n450000.125 5400000.0625 12\n450000.25 5400000.125 12\n"
            "450001 5400001.5 13\n3 0 1 2\n");
  for (const char* name : {"a.ply", "a.obj", "a.off"}) {
    const auto loaded = mesh::readMesh(dir / name);
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->origin, (mesh::Origin{450'000, 5'400'000, 0})) << name;
    EXPECT_EQ(loaded->mesh.positions, (Floats{0.125F, 0.0625F, 12, 0.25F, 0.125F, 12, 1, 1.5F, 13}))
        << name;
    ASSERT_EQ(loaded->notes.size(), 1U);
    EXPECT_NE(loaded->notes[0].find("relative to 450000, 5400000, 0"), std::string::npos)
        << loaded->notes[0];
  }
  writeText(dir / "b.ply", ply("float"));
  const auto floats = mesh::readMesh(dir / "b.ply");
  EXPECT_EQ(floats->origin, mesh::Origin{}) << "the file has no more digits";
  EXPECT_EQ(floats->mesh.positions[0], 450000.125F);
  ASSERT_EQ(floats->notes.size(), 1U);
  EXPECT_NE(floats->notes[0].find("are rounded to steps of up to 0.5"), std::string::npos)
      << floats->notes[0];
}

TEST(ReadMesh, AFeatureThatIsNoNumberBecomesZeroWithANote) {
  const TempDir dir;
  writeText(
      dir / "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float quality\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
      "0 0 0 nan\n1 0 0 2\n0 1 0 inf\n3 0 1 2 6 0 0 1 0 0 1\n");
  const auto loaded = mesh::readMesh(dir / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.find("quality")->values, (Floats{0, 2, 0}));
  ASSERT_EQ(loaded->notes.size(), 1U);
  EXPECT_EQ(loaded->notes[0], "2 values of features were not numbers; 0 stands there");
}

// The note is for meshes that are visibly coarse because of the floats, not for large coordinates
// in general.
TEST(ReadMesh, FloatsAreSaidToBeCoarseWhereTheMeshIsSmallForItsDistance) {
  const TempDir dir;
  const auto notes = [&](double at, double size) {
    mesh::Mesh mesh = test::grid(1, 1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      mesh.positions[i] = static_cast<float>(mesh.positions[i] * size + (i % 3 == 0 ? at : 0));
    EXPECT_TRUE(mesh::writeMesh(dir / "a.stl", mesh));
    const auto loaded = mesh::readMesh(dir / "a.stl");
    return loaded ? loaded->notes.size() : 99;
  };
  EXPECT_EQ(notes(0, 1), 0U);
  EXPECT_EQ(notes(5'000'000, 100), 1U) << "200 steps of 0.5";
  EXPECT_EQ(notes(5'000'000, 20'000), 0U) << "40,000 steps";
  EXPECT_EQ(notes(0, 5'000'000), 0U);
}

TEST(MeshFileSize, CountsPolygonsAsTheTrianglesThatTheyBecome) {
  const TempDir dir;
  const auto sizeOf = [&](const std::string& name, const std::string& text) {
    writeText(dir / name, text);
    const auto size = mesh::meshFileSize(dir / name);
    EXPECT_TRUE(size) << name;
    return size ? size->mesh : mesh::MeshSize{};
  };
  const auto ascii = sizeOf("a.ply", test::squareFile(test::Form::kAscii));
  EXPECT_EQ(ascii.vertices, 4U);
  EXPECT_GE(ascii.triangles, 2U) << "a square is one face, and two triangles";
  const auto obj =
      sizeOf("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n# f 1 2 3\nf 1 2 3 4\nf 1 2 3\n");
  EXPECT_EQ(obj.vertices, 4U);
  EXPECT_EQ(obj.triangles, 3U);
  std::string fan =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar uchar vertex_indices\nend_header\n" +
      std::string(36, '\0') + "\xC8" + std::string(200, '\1');
  EXPECT_EQ(sizeOf("b.ply", fan).triangles, 198U);
  std::string coloured =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 20\n"
      "property list uchar uchar vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n" +
      std::string(36, '\0');
  for (int face = 0; face < 20; ++face) coloured += "\xC8" + std::string(203, '\1');
  EXPECT_EQ(sizeOf("c.ply", coloured).vertices, 3U * 20 * 198)
      << "one for each corner, which are more than the file has bytes";
  for (const char* colour : {"red", "green", "blue"})
    coloured = test::replaced(coloured, colour, std::string("diffuse_") + colour);
  EXPECT_EQ(sizeOf("d.ply", coloured).vertices, 3U * 20 * 198) << "the other names of colours";
}

TEST(ReadMesh, SaysWhichFileIsBrokenAndHow) {
  const TempDir dir;
  const std::string file = test::squareFile(test::Form::kAscii);
  const auto fault = [&](const std::string& name, const std::string& text) {
    writeText(dir / name, text);
    const auto loaded = mesh::readMesh(dir / name);
    EXPECT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, Errc::kMalformed);
    return loaded.error().what.substr(dir.path().size() + 1);
  };
  EXPECT_EQ(fault("empty.ply", ""), "empty.ply: line 1: a PLY file starts with \"ply\"");
  EXPECT_EQ(fault("a.ply", test::replaced(file, "face 2", "face 9")),
            "a.ply: cut short in face 2 of 9, property vertex_indices");
  EXPECT_EQ(fault("b.ply", test::replaced(file, "3 0 1 3", "3 0 1 9")),
            "b.ply: triangle 2: there is no vertex 9, the mesh has 4 (0 to 3)");
  EXPECT_EQ(fault("c.ply", test::replaced(file, "vertex_indices", "corners")),
            "c.ply: has no triangles");
  EXPECT_EQ(fault("empty.obj", ""), "empty.obj: has no triangles");
}

TEST(ReadMesh, OfNoFileIsAnError) {
  const TempDir dir;
  EXPECT_EQ(mesh::readMesh(dir / "none.ply").error().code, Errc::kNotFound);
  EXPECT_EQ(mesh::readMesh(dir / "none.obj").error().code, Errc::kNotFound);
  std::filesystem::create_directory(dir / "folder.ply");
  EXPECT_EQ(mesh::readMesh(dir / "folder.ply").error().code, Errc::kMalformed);
}

}  // namespace
}  // namespace merlin::render
