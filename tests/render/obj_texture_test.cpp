// OBJ files with texture coordinates, materials and images. The tests write the images with libpng
// and TurboJPEG.
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>
#include <turbojpeg.h>
#include <unistd.h>

#include "render/image/image_file.h"
#include "render/mesh/coincident.h"
#include "render/mesh/io/mesh_file.h"
#include "render/mesh/io/texture_pictures.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using namespace std::string_literals;
using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;
using Names = std::vector<std::string>;
using Colour = std::array<float, 3>;

// An image of 2 x 2 pixels: red and green above blue and white.
const std::vector<std::uint8_t> kFour = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

void writePngFile(const std::string& path, int width, int height,
                  const std::vector<std::uint8_t>& rgb) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), 0, nullptr), 0);
}

std::string jpegOf(int width, int height, const std::vector<std::uint8_t>& rgb) {
  const tjhandle jpeg = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(jpeg, rgb.data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_444,
                        100, TJFLAG_ACCURATEDCT),
            0);
  const std::string file(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(jpeg);
  return file;
}

// A square of two triangles: 0 1 3 and 0 3 2.
constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
// Texture coordinates of the centres of the four pixels, from the lower left.
constexpr const char* kMiddles = "vt 0.25 0.25\nvt 0.75 0.25\nvt 0.25 0.75\nvt 0.75 0.75\n";

class TexturedObj : public testing::Test {
 protected:
  mesh::LoadedMesh read(const std::string& text) {
    test::writeText(dir_ / "a.obj", text);
    auto loaded = mesh::readMesh(dir_ / "a.obj");
    EXPECT_TRUE(loaded) << loaded.error().what;
    return loaded ? *std::move(loaded) : mesh::LoadedMesh{};
  }
  // Returns the reader's notes, without the folder's path.
  Names notesOf(const mesh::LoadedMesh& loaded) const {
    Names notes;
    for (const std::string& note : loaded.notes) {
      EXPECT_TRUE(note.starts_with(dir_.path() + "/")) << note;
      notes.push_back(note.substr(dir_.path().size() + 1));
    }
    return notes;
  }

  const test::TempDir dir_;
};

TEST_F(TexturedObj, TakesColoursFromThePicture) {
  writePngFile(dir_ / "four pixels.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl skin\nKd 0.5 0.5 0.5\nmap_Kd four pixels.png\n");
  const auto loaded =
      read(std::string("mtllib a.mtl\n") + kSquare + kMiddles + "usemtl skin\nf 1/1 2/2 4/4 3/3\n");
  EXPECT_EQ(loaded.notes, Names{});
  ASSERT_EQ(loaded.mesh.vertexCount(), 4u);
  EXPECT_EQ(loaded.mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
  EXPECT_EQ(loaded.mesh.triangles, (Indices{0, 1, 3, 0, 3, 2}));
  EXPECT_EQ(loaded.mesh.find("texcoord")->values,
            (Floats{0.25F, 0.25F, 0.75F, 0.25F, 0.25F, 0.75F, 0.75F, 0.75F}));
  EXPECT_EQ(loaded.mesh.find("colour")->values, (Floats{0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0}))
      << "blue below on the left, white, red, green";
}

TEST_F(TexturedObj, KeepsItsOwnColoursBesideThePicture) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl skin\nmap_Kd four.png\n");
  const auto loaded = read(
      "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n"
      "vt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nusemtl skin\nf 1/1 2/2 3/3\n");
  EXPECT_EQ(loaded.mesh.find("colour")->values, (Floats{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_FALSE(loaded.mesh.texture.empty());
}

// Two columns of squares; the seam leads from the middle of the lower border to the centre vertex,
// where it ends.
TEST_F(TexturedObj, CutsVerticesAtASeamAndNowhereElse) {
  const auto loaded = read("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 1 2 0\n" +
                           std::string(kMiddles) +
                           "f 1/1 2/1 5/1\nf 1/1 5/1 4/1\nf 4/1 5/1 7/1\nf 2/2 3/1 6/1\n"
                           "f 2/2 6/1 5/1\nf 5/1 6/1 7/1\n");
  EXPECT_EQ(loaded.mesh.triangles, (Indices{0, 1, 4, 0, 4, 3, 3, 4, 6, 7, 2, 5, 7, 5, 4, 4, 5, 6}))
      << "vertex 1 alone is cut";
  ASSERT_EQ(loaded.mesh.vertexCount(), 8u);
  EXPECT_EQ(mesh::coincidentVertices(loaded.mesh.positions), (Indices{0, 7, 2, 3, 4, 5, 6, 1}));
  EXPECT_EQ(loaded.mesh.find("colour"), nullptr);
  EXPECT_EQ(loaded.tidied.unused + loaded.split.added, 0u);
}

// The seam leads from border to border: at its ends, triangles that share only a corner are
// separated.
TEST_F(TexturedObj, CutsTheEndsOfASeamThatLeaveOneFanNoMore) {
  const auto loaded = read(std::string(kSquare) + kMiddles + "f 1/1 2/2 4/4\nf 1/1 4/3 3/3\n");
  EXPECT_EQ(loaded.mesh.triangles, (Indices{0, 1, 3, 5, 4, 2}));
  EXPECT_EQ(mesh::coincidentVertices(loaded.mesh.positions), (Indices{5, 1, 2, 4, 3, 0}));
  EXPECT_EQ(loaded.split.vertices, 1u);
}

TEST_F(TexturedObj, GivesEachMaterialItsOwn) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl",
                  "newmtl unused\nKd 9 9 9\nnewmtl plain\nKd 0.5 0.25 0\n"
                  "newmtl picture\nmap_Kd -clamp on -blendu off -o 0 0 .\\four.png\n"
                  "newmtl twin\nmap_Kd -clamp on four.png\n");
  const auto loaded = read(std::string("mtllib a.mtl\n") + kSquare + kMiddles +
                           "usemtl plain\nf 1/1 2/2 4/4\nusemtl picture\nf 1/1 4/4 3/3\n"
                           "usemtl twin\nv 0 2 0\nf 3/3 4/4 5/4\n");
  EXPECT_EQ(loaded.mesh.triangles, (Indices{0, 1, 3, 5, 6, 2, 2, 6, 4}))
      << "picture and twin look the same, so no seam is between them";
  const Floats colour = loaded.mesh.find("colour")->values;
  EXPECT_EQ((Floats{colour.begin(), colour.begin() + 3}), (Floats{0.5F, 0.25F, 0}));
  EXPECT_EQ((Floats{colour.end() - 3, colour.end()}), (Floats{0, 1, 0}));
  ASSERT_EQ(loaded.notes.size(), 2u);
  EXPECT_NE(loaded.notes[0].find("the option -o is ignored"), std::string::npos);
  EXPECT_EQ(loaded.notes[1], "1 texture and 1 plain colour became one of 32 x 24 pixels");
  EXPECT_FALSE(loaded.mesh.texture.empty());
}

// The image file is kept byte for byte, so nothing is lost.
TEST_F(TexturedObj, HasThePictureThatIsEverywhereForATexture) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  const std::string file = test::readText(dir_ / "four.png");
  const std::string begin = std::string("mtllib a.mtl\n") + kSquare + kMiddles;
  const auto textureOf = [&](const std::string& materials, const std::string& faces) {
    test::writeText(dir_ / "a.mtl", materials);
    const auto texture = read(begin + faces).mesh.texture;
    return std::string(texture.begin(), texture.end());
  };
  const std::string two = "newmtl a\nmap_Kd four.png\nnewmtl b\nmap_Kd four.png\nKd 1 0 0\n";
  EXPECT_EQ(textureOf(two, "usemtl a\nf 1/1 2/2 4/4\nusemtl b\nf 1/1 4/4 3/3\n"), file);
  const auto expectAtlas = [&](const std::string& materials, const std::string& faces) {
    const std::string texture = textureOf(materials, faces);
    EXPECT_TRUE(texture.starts_with("\x89PNG")) << faces;
    EXPECT_NE(texture, file) << faces;
  };
  expectAtlas(two, "usemtl a\nf 1/1 2/2 4/4\nf 1/1 4 3/3\n");    // a corner without "vt"
  expectAtlas(two, "f 1/1 2/2 4/4\nusemtl b\nf 1/1 4/4 3/3\n");  // a face without "usemtl"
  expectAtlas("newmtl a\nmap_Kd -clamp on four.png\n", "usemtl a\nf 1/1 2/2 4/4\n");
}

// Each output file is in a folder of its own, so that no reader finds another file's image.
TEST_F(TexturedObj, GoesWithItsPictureIntoOtherFiles) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl a\nmap_Kd four.png\n");
  const mesh::LoadedMesh loaded = read(std::string("mtllib a.mtl\nusemtl a\n") + kSquare +
                                       kMiddles + "f 1/1 2/2 4/4\nf 1/1 4/4 3/3\n");
  const std::string picture = test::readText(dir_ / "four.png");
  const std::pair<const char*, Names> files[] = {
      {"it's b=_1.obj", {"it=27s=20b=3D_1.obj.png", "it=27s=20b=3D_1.obj.mtl"}},
      {"\n\xc3\xa9.ply", {"=0A=C3=A9.ply.png"}},
      {"\xe6\xa8\xa1.obj", {"\xe6\xa8\xa1.obj.png", "\xe6\xa8\xa1.obj.mtl"}},
      {"b\".iv", {"b=22.iv.png"}}};
  for (const auto& [name, beside] : files) {
    const test::TempDir other;
    const auto written = mesh::writeMesh(other / name, loaded.mesh);
    ASSERT_TRUE(written) << written.error().what;
    Names expected;
    for (const std::string& file : beside) expected.push_back(other / file);
    EXPECT_EQ(written->companions, expected);
    EXPECT_EQ(test::readText(expected[0]), picture);
    if (written->format == "iv") {
      EXPECT_EQ(written->left_out, Names{"colour"}) << "which the picture is multiplied with";
      EXPECT_NE(test::readText(other / name).find("Texture2 { filename \"b=22.iv.png\" }"),
                std::string::npos);
      continue;
    }
    EXPECT_EQ(written->left_out, Names{});
    const auto again = mesh::readMesh(other / name);
    ASSERT_TRUE(again) << again.error().what;
    EXPECT_EQ(again->notes, Names{});
    EXPECT_EQ(again->mesh.texture, loaded.mesh.texture);
    EXPECT_EQ(again->mesh.find("texcoord")->values, loaded.mesh.find("texcoord")->values);
  }
}

// Returns a PLY triangle with texture coordinates, and `comments` in its header.
std::string texturedPly(const std::string& comments) {
  return "ply\nformat ascii 1.0\n" + comments +
         "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
         "s\n"
         "property float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
}

TEST_F(TexturedObj, MayBeAPlyThatNamesItsPicture) {
  writePngFile(dir_ / "four pixels.png", 2, 2, kFour);
  writePngFile(dir_ / "other.png", 2, 2, kFour);
  test::writeText(dir_ / "broken.png", "no picture");
  const auto readPly = [&](const std::string& comments, const std::string& text = "") {
    test::writeText(dir_ / "a.ply", text.empty() ? texturedPly(comments) : text);
    auto loaded = mesh::readMesh(dir_ / "a.ply");
    EXPECT_TRUE(loaded) << loaded.error().what;
    return *std::move(loaded);
  };
  const std::string four = "comment TextureFile four pixels.png\n";
  for (const std::string& comments :
       {four, "comment  TextureFile\tfour pixels.png  \r\n"s, four + four,
        "comment TextureFile\n" + four, "comment TextureFile ../x/four pixels.png\n"s}) {
    const mesh::LoadedMesh loaded = readPly(comments);
    EXPECT_EQ(loaded.notes, Names{}) << comments;
    EXPECT_EQ(std::string(loaded.mesh.texture.begin(), loaded.mesh.texture.end()),
              test::readText(dir_ / "four pixels.png"))
        << comments;
  }
  const std::pair<std::string, std::string> faults[] = {
      {four + "comment TextureFile other.png\n",
       "left out: 2 texture images, since the faces have no property texnumber that says which of "
       "them each one has"},
      {"comment TextureFile none.png\n",
       dir_ / "none.png: No such file or directory; the texture image is left out"},
      {"comment TextureFile broken.png\n",
       dir_ / "broken.png: is neither PNG nor JPEG; the texture image is left out"},
      {"comment TextureFile a\0.png\n"s,
       "a\0.png: is not a valid file name; the texture image is left out"s}};
  for (const auto& [comments, note] : faults) {
    const mesh::LoadedMesh loaded = readPly(comments);
    EXPECT_EQ(loaded.notes, Names{note});
    EXPECT_TRUE(loaded.mesh.texture.empty());
  }
  EXPECT_TRUE(readPly("comment texture four pixels.png\n").mesh.texture.empty());
}

// Two squares of two faces each, as MeshLab writes them: each corner of a face has its own texture
// coordinates.
TEST_F(TexturedObj, MayBeAPlyWhoseFacesHaveSeveralPictures) {
  writePngFile(dir_ / "a.png", 1, 1, {255, 0, 0});
  writePngFile(dir_ / "b.png", 1, 1, {0, 0, 255});
  const auto readPly = [&](const std::string& faces, const std::string& comments) {
    test::writeText(dir_ / "a.ply",
                    "ply\nformat ascii 1.0\n" + comments +
                        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 3\nproperty list uchar int vertex_indices\nproperty list "
                        "uchar float texcoord\nproperty int texnumber\nend_header\n"
                        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" +
                        faces);
    auto loaded = mesh::readMesh(dir_ / "a.ply");
    EXPECT_TRUE(loaded) << loaded.error().what;
    return loaded ? *std::move(loaded) : mesh::LoadedMesh{};
  };
  const std::string both = "comment TextureFile a.png\ncomment TextureFile b.png\n";
  const auto loaded =
      readPly("3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n3 0 3 1 2 0 0 -1\n", both);
  ASSERT_EQ(loaded.mesh.triangleCount(), 3u);
  EXPECT_EQ(loaded.notes, Names{"2 textures and 1 plain colour became one of 32 x 48 pixels"});
  const auto atlas = image::decodeImage(loaded.mesh.texture);
  ASSERT_TRUE(atlas);
  const Colour expected[] = {{1, 0, 0}, {0, 0, 1}, {1, 1, 1}};
  for (std::size_t i = 0; i < 9; ++i) {
    const float* const uv =
        &loaded.mesh.find("texcoord")->values[2 * std::size_t{loaded.mesh.triangles[i]}];
    EXPECT_EQ(atlas->at(uv[0], uv[1], image::Wrap::kRepeat, image::Wrap::kRepeat), expected[i / 3])
        << i;
  }
  const auto one =
      readPly("4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 2 3 6 0 0 0.5 1 0 1 0\n3 0 3 1 6 0 0 0 1 1 0 0\n",
              "comment TextureFile a.png\n");
  EXPECT_EQ(one.notes, Names{});
  EXPECT_EQ(std::string(one.mesh.texture.begin(), one.mesh.texture.end()),
            test::readText(dir_ / "a.png"));
  EXPECT_EQ(one.mesh.triangleCount(), 4u) << "a square, and two triangles";
  const auto none = readPly("3 0 1 2 0 0\n3 0 2 3 0 1\n3 0 3 1 0 7\n", both);
  EXPECT_TRUE(none.mesh.texture.empty()) << "no corner has coordinates";
}

// Users do not name the image and material files that are written, so these must not replace other
// files.
TEST_F(TexturedObj, WritesOverNothingBesideItsFile) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl a\nmap_Kd four.png\n");
  mesh::LoadedMesh loaded = read(std::string("mtllib a.mtl\nusemtl a\n") + kSquare + kMiddles +
                                 "f 1/1 2/2 4/4\nf 1/1 4/4 3/3\n");
  ASSERT_TRUE(mesh::writeMesh(dir_ / "b.obj", loaded.mesh));
  ASSERT_TRUE(mesh::writeMesh(dir_ / "b.obj", loaded.mesh)) << "the same again";
  test::writeText(dir_ / "c.obj.mtl", "mine");
  const auto refused = mesh::writeMesh(dir_ / "c.obj", loaded.mesh);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            dir_ / "c.obj.mtl: exists with different content; remove it or name another output");
  EXPECT_EQ(test::readText(dir_ / "c.obj.mtl"), "mine");
  for (const char* name : {"c.obj", "c.obj.png"})
    EXPECT_FALSE(std::filesystem::exists(dir_ / name)) << name;
  ::mkdir((dir_ / "d.obj").c_str(), 0700);
  EXPECT_FALSE(mesh::writeMesh(dir_ / "d.obj", loaded.mesh));
  EXPECT_FALSE(std::filesystem::exists(dir_ / "d.obj.png")) << "goes when the mesh cannot be";
}

// The faces at one vertex use 100 different texture coordinates.
TEST_F(TexturedObj, HasAnyNumberOfCoordinatesAtOneVertex) {
  std::string text = kSquare, faces;
  for (int i = 1; i <= 100; ++i) {
    text += fmt::format("vt {} 0\n", 0.01 * i);
    faces += fmt::format("f 1/{0} 2/1 3/1\nf 1/{0} 3/1 4/1\n", i);
  }
  const mesh::LoadedMesh loaded = read(text + faces);
  EXPECT_EQ(loaded.mesh.triangleCount(), 200u);
  EXPECT_EQ(loaded.mesh.vertexCount(), 100u + 3u + loaded.split.added);
}

TEST_F(TexturedObj, IsReadWithoutThePicturesThatAreNotThere) {
  test::writeText(dir_ / "a.mtl", "newmtl a\nmap_Kd none.png\nnewmtl b\nmap_Kd text.png\n");
  test::writeText(dir_ / "text.png", "no picture");
  const auto loaded = read(std::string("mtllib a.mtl\nmtllib b.mtl\n") + kSquare + kMiddles +
                           "usemtl a\nf 1/1 2/2 4/4\nusemtl b\nf 1/1 4/4 3/3\n");
  EXPECT_EQ(notesOf(loaded),
            (Names{"none.png: No such file or directory; its colours are left out",
                   "text.png: is neither PNG nor JPEG; its colours are left out",
                   "b.mtl: No such file or directory; its materials are left out"}));
  EXPECT_EQ(loaded.mesh.vertexCount(), 4u) << "materials that look the same make no seam";
  EXPECT_EQ(loaded.mesh.find("colour"), nullptr);
  EXPECT_NE(loaded.mesh.find("texcoord"), nullptr);
}

TEST_F(TexturedObj, OpensNothingOutsideItsFolder) {
  ::mkdir((dir_ / "model").c_str(), 0700);
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl a\nKd 1 0 0\n");
  test::writeText(dir_ / "model/b.mtl", "newmtl b\nmap_Kd ../four.png\n");
  test::writeText(dir_ / "model/a.obj", "mtllib ../a.mtl\nmtllib C:\\theirs\\b.mtl\n" +
                                            std::string(kSquare) + kMiddles +
                                            "usemtl a\nf 1/1 2/2 4/4\nusemtl b\nf 1/1 4/4 3/3\n");
  const auto loaded = mesh::readMesh(dir_ / "model/a.obj");
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->notes.size(), 2u);
  EXPECT_TRUE(loaded->notes[0].starts_with(dir_ / "model/a.mtl:")) << loaded->notes[0];
  EXPECT_TRUE(loaded->notes[1].starts_with(dir_ / "model/four.png:")) << loaded->notes[1];
}

TEST_F(TexturedObj, FindsFilesWhoseNamesDifferInCapitals) {
  ::mkdir((dir_ / "Skins").c_str(), 0700);
  writePngFile(dir_ / "Skins/Four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.mtl", "newmtl skin\nmap_Kd SKINS\\FOUR.PNG\n");
  const std::string text =
      std::string("mtllib A.MTL\n") + kSquare + kMiddles + "usemtl skin\nf 1/1 2/2 4/4 3/3\n";
  const auto loaded = read(text);
  EXPECT_EQ(std::string(loaded.mesh.texture.begin(), loaded.mesh.texture.end()),
            test::readText(dir_ / "Skins/Four.png"));
  EXPECT_EQ(notesOf(loaded),
            Names{"a.mtl: is taken for A.MTL, which is not there; the names differ only in "
                  "capitals; the same holds for 1 more"});
  const auto size = mesh::meshFileSize(dir_ / "a.obj");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->pictures, Names{dir_ / "Skins/Four.png"});
}

TEST_F(TexturedObj, PrefersTheNameAsItIsWrittenAndThenTheFirst) {
  test::writeText(dir_ / "b.mtl", "newmtl m\nKd 0 0 1\n");
  test::writeText(dir_ / "A.mtl", "newmtl m\nKd 0 1 0\n");
  const auto diffuseOf = [&] {
    const auto loaded = read(std::string("mtllib a.mtl\nmtllib B.mtl\n") + kSquare + kMiddles +
                             "usemtl m\nf 1/1 2/2 4/4 3/3\n");
    const mesh::Feature* const colour = loaded.mesh.find("colour");
    return colour ? Floats(colour->values.begin(), colour->values.begin() + 3) : Floats();
  };
  EXPECT_EQ(diffuseOf(), (Floats{0, 0, 1})) << "of b.mtl, which is read last";
  test::writeText(dir_ / "B.MTL", "newmtl m\nKd 1 1 1\n");
  EXPECT_EQ(diffuseOf(), (Floats{1, 1, 1})) << "B.MTL is before b.mtl";
  test::writeText(dir_ / "B.mtl", "newmtl m\nKd 1 0 0\n");
  EXPECT_EQ(diffuseOf(), (Floats{1, 0, 0}));
}

TEST_F(TexturedObj, MayBeAPlyWhosePictureDiffersInCapitals) {
  writePngFile(dir_ / "four.png", 2, 2, kFour);
  test::writeText(dir_ / "a.ply",
                  "ply\nformat ascii 1.0\ncomment TextureFile FOUR.PNG\nelement vertex 3\nproperty "
                  "float x\nproperty float y\nproperty float z\nproperty float s\nproperty float "
                  "t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n3 0 1 2\n");
  const auto loaded = mesh::readMesh(dir_ / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_FALSE(loaded->mesh.texture.empty());
  EXPECT_EQ(notesOf(*loaded),
            Names{"four.png: is taken for FOUR.PNG, which is not there; the names "
                  "differ only in capitals"});
  EXPECT_EQ(mesh::meshFileSize(dir_ / "a.ply")->pictures, Names{dir_ / "four.png"});
}

TEST_F(TexturedObj, NotesAreFewWhateverItsMaterialsLack) {
  std::string materials, text = std::string("mtllib a.mtl\n") + kSquare + kMiddles;
  for (int m = 0; m < 100; ++m) {
    materials += fmt::format("newmtl m{0}\nmap_Kd none{0}.png\n", m);
    text += fmt::format("usemtl m{}\nf 1/1 2/2 4/4\n", m);
  }
  test::writeText(dir_ / "a.mtl", materials);
  const auto loaded = read(text);
  ASSERT_EQ(loaded.notes.size(), 17u);
  EXPECT_EQ(loaded.notes.back(), "84 more notes about its materials are left out");
}

// A pipe without a writer: the reader must not block on it.
TEST_F(TexturedObj, WaitsForNoPipe) {
  ASSERT_EQ(::mkfifo((dir_ / "x.mtl").c_str(), 0600), 0);
  const auto loaded = read(std::string("mtllib x.mtl\nusemtl red\n") + kSquare + "f 1 2 3\n");
  EXPECT_EQ(loaded.mesh.triangles, (Indices{0, 1, 2}));
  EXPECT_EQ(notesOf(loaded), Names{"x.mtl: is not a regular file; its materials are left out"});
}

TEST_F(TexturedObj, KeepsItsOwnColoursWhereNoPictureIs) {
  const auto loaded = read(
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 9 9 9 0 0 0\n"
      "vt 0 0\nf 1/1 2 3\n");
  EXPECT_EQ(loaded.mesh.find("colour")->values, (Floats{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(loaded.mesh.find("texcoord")->values, Floats(6, 0));
  EXPECT_EQ(loaded.tidied.unused, 1u);
}

TEST_F(TexturedObj, NamesTheLineOfACornerWithoutItsCoordinate) {
  test::writeText(dir_ / "a.obj", std::string(kSquare) + "vt 0 0\nf 1/1 2/1 3/1\nf 1/2 2/1 3/1\n");
  EXPECT_EQ(mesh::readMesh(dir_ / "a.obj").error().what,
            dir_ / "a.obj: line 7: a corner refers to texture coordinate 2, but there are 1");
  read(std::string(kSquare) + "f 1/1 2/1 3/1\nvt 0 0\n");  // "vt" comes after its use
  read(std::string(kSquare) + "vt 0 0\nvt 1 1\nf 1/-1 2/-2 3/-1\n");
}

TEST(TexturePictures, AreReadUpToALimitOfAllTogether) {
  const test::TempDir dir;
  writePngFile(dir / "four.png", 2, 2, kFour);
  mesh::TexturePictures pictures(30);
  EXPECT_TRUE(pictures.read(dir / "four.png"));
  EXPECT_FALSE(pictures.read(dir / "none.png"));
  EXPECT_TRUE(pictures.read(dir / "four.png")) << "24 of 30 bytes";
  const auto more = pictures.read(dir / "four.png");
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().what,
            dir / "four.png: the model's texture images have more than 2^28 pixels together");
}

TEST(ImageFile, IsMixedOfTheNearestPixels) {
  const image::ImageFile four{2, 2, kFour};
  constexpr auto kR = image::Wrap::kRepeat, kC = image::Wrap::kClamp, kM = image::Wrap::kMirror;
  EXPECT_EQ(four.at(0.25F, 0.75F, kR, kR), (Colour{1, 0, 0}));
  EXPECT_EQ(four.at(0.5F, 0.75F, kR, kR), (Colour{0.5F, 0.5F, 0}));
  EXPECT_EQ(four.at(0.5F, 0.5F, kR, kR), (Colour{0.5F, 0.5F, 0.5F}));
  EXPECT_EQ(four.at(0, 0.75F, kR, kR), (Colour{0.5F, 0.5F, 0})) << "repeats";
  EXPECT_EQ(four.at(0, 0.75F, kC, kC), (Colour{1, 0, 0})) << "does not";
  EXPECT_EQ(four.at(-0.75F, 1.75F, kR, kR), (Colour{1, 0, 0}));
  EXPECT_EQ(four.at(-7, 9, kC, kC), (Colour{1, 0, 0}));
  EXPECT_EQ(four.at(1.25F, 0.75F, kM, kR), (Colour{0, 1, 0})) << "is mirrored";
  EXPECT_EQ(four.at(0, 0.75F, kC, kR), (Colour{1, 0, 0})) << "each axis in its way";
  EXPECT_EQ(four.at(1e30F, -1e30F, kR, kR), four.at(0, 0, kR, kR));
}

TEST(ImageFile, MayBeAJpegOfAnyName) {
  const test::TempDir dir;
  test::writeText(dir / "a.png", jpegOf(2, 1, {250, 10, 10, 250, 10, 10}));
  const auto picture = image::readImage(dir / "a.png");
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->width, 2);
  EXPECT_EQ(picture->height, 1);
  ASSERT_EQ(picture->pixels.size(), 6u);
  EXPECT_NEAR(picture->pixels[3], 250, 3);
  EXPECT_NEAR(picture->pixels[4], 10, 3);
}

TEST(ImageFile, SaysWhatIsBroken) {
  const test::TempDir dir;
  writePngFile(dir / "a.png", 2, 2, kFour);
  const std::string png = test::readText(dir / "a.png");
  const std::string jpeg = jpegOf(2, 2, kFour);
  for (const std::string& file : {png, jpeg}) {
    std::size_t refused = 0;
    for (std::size_t n = 0; n < file.size(); ++n) {
      test::writeText(dir / "b", file.substr(0, n));
      const auto picture = image::readImage(dir / "b");
      refused += !picture;
      EXPECT_TRUE(picture || picture.error().what.starts_with(dir / "b: ")) << n;
    }
    EXPECT_GE(refused, file.size() / 2);
  }
  std::string huge = png;
  huge.replace(16, 8, std::string("\x7F\xFF\xFF\xFF\x7F\xFF\xFF\xFF", 8));
  test::writeText(dir / "b", huge);
  EXPECT_FALSE(image::readImage(dir / "b"));
}

}  // namespace
}  // namespace merlin::render
