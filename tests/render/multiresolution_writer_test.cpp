// What the Open Inventor file of all resolutions contains, tested without Coin.
#include "render/inventor/multiresolution_writer.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/lod/finest_level.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using test::readText;
using test::TempDir;
using Names = std::vector<std::string>;

// Returns a square with values for all fields of the node, and with a feature for which the node
// has no field.
mesh::Mesh richSquare() {
  mesh::Mesh mesh = test::grid(1, 1);
  mesh::ensureNormals(mesh);
  mesh.features.push_back({"colour", 3, std::vector<float>(12, 0.5F)});
  mesh.features.push_back({"texcoord", 2, {0, 0, 1, 0, 0, 1, 1, 1}});
  mesh.features.push_back({"heat", 1, {1, 2, 3, 4}});
  return mesh;
}

const std::vector<std::uint8_t> kJpeg = {0xff, 0xd8, 1, 2, 3};

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(MultiresolutionWriter, WritesTheTextureBesideTheFile) {
  const TempDir dir;
  mesh::Mesh mesh = richSquare();
  mesh.texture = kJpeg;
  const auto written = inventor::writeMultiresolution(dir / "my scan.iv", lod::oneLevel(mesh));
  ASSERT_TRUE(written) << written.error().what;
  const std::string picture = dir / "my=20scan.iv.jpg";
  EXPECT_EQ(written->companions, Names{picture});
  EXPECT_EQ(written->left_out, (Names{"colour", "heat"})) << "a texture is not tinted";
  EXPECT_EQ(readText(picture), std::string(kJpeg.begin(), kJpeg.end()));
  const std::string text = readText(dir / "my scan.iv");
  EXPECT_TRUE(holds(text,
                    "  DEF MERLIN_TEXTURE Texture2 { filename \"my=20scan.iv.jpg\" }\n"
                    "  SoMRFaceSet {\n"))
      << text;
  EXPECT_TRUE(holds(text, "  USE MERLIN_TEXTURE\n")) << text;
  EXPECT_TRUE(holds(text, "MFVec2f texCoord")) << text;
  EXPECT_FALSE(holds(text, "diffuseColor")) << text;
}

TEST(MultiresolutionWriter, SaysWhichTextureItLeavesOut) {
  const TempDir dir;
  mesh::Mesh mesh = richSquare();
  std::erase_if(mesh.features, [](const mesh::Feature& f) { return f.name == "texcoord"; });
  mesh.texture = kJpeg;
  const auto written = inventor::writeMultiresolution(dir / "a.iv", lod::oneLevel(mesh));
  ASSERT_TRUE(written) << written.error().what;
  EXPECT_EQ(written->left_out, (Names{"heat", "the texture image"}));
  EXPECT_EQ(written->companions, Names{});
  EXPECT_TRUE(holds(readText(dir / "a.iv"), "MFColor diffuseColor"));
}

TEST(MultiresolutionWriter, WithoutATextureIsOneFile) {
  const TempDir dir;
  const auto written = inventor::writeMultiresolution(dir / "a.iv", lod::oneLevel(richSquare()));
  ASSERT_TRUE(written) << written.error().what;
  EXPECT_EQ(written->left_out, Names{"heat"});
  EXPECT_EQ(written->companions, Names{});
  const std::string text = readText(dir / "a.iv");
  EXPECT_FALSE(holds(text, "Texture2 {")) << text;
  EXPECT_TRUE(holds(text, "MFVec3f normal, MFColor diffuseColor, MFVec2f texCoord,")) << text;
}

TEST(MultiresolutionWriter, OverwritesNoOtherPictureAndLeavesNothingBehind) {
  const TempDir dir;
  mesh::Mesh mesh = richSquare();
  mesh.texture = kJpeg;
  test::writeText(dir / "a.iv.jpg", "another picture");
  const auto refused = inventor::writeMultiresolution(dir / "a.iv", lod::oneLevel(mesh));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            dir / "a.iv.jpg" + std::string(": exists with different content; "
                                           "remove it or name another output"));
  EXPECT_FALSE(std::filesystem::exists(dir / "a.iv"));
  EXPECT_EQ(readText(dir / "a.iv.jpg"), "another picture");
  std::filesystem::create_directory(dir / "b.iv");
  EXPECT_FALSE(inventor::writeMultiresolution(dir / "b.iv", lod::oneLevel(mesh)));
  EXPECT_FALSE(std::filesystem::exists(dir / "b.iv.jpg")) << "its model could not be written";
}

}  // namespace
}  // namespace merlin::render
