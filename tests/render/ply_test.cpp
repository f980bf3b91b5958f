#include "render/mesh/io/ply/ply.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/render/ply_files.h"

namespace merlin::render {
namespace {

using namespace std::string_literals;
using namespace test;  // ply_files.h
using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;
using Notes = std::vector<std::string>;

void expectSquare(const mesh::Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0.5F, 1, 0, 0.5F, 0, 1, 0.5F, 1, 1, 0.5F}));
  EXPECT_EQ(mesh.triangles, (Indices{0, 1, 3, 0, 3, 2, 0, 1, 3}));
  ASSERT_EQ(mesh.features.size(), 2u);
  EXPECT_EQ(mesh.features[0].name, "colour");
  EXPECT_EQ(mesh.features[0].dimension, 3u);
  ASSERT_EQ(mesh.features[0].values.size(), 12u);
  const Floats expected{0, 1, 0, 0.2F, 1, 0, 0.4F, 1, 0, 0.6F, 1, 0};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_FLOAT_EQ(mesh.features[0].values[i], expected[i]) << i;
  }
  EXPECT_EQ(mesh.features[1].name, "heat");
  EXPECT_EQ(mesh.features[1].dimension, 1u);
  EXPECT_EQ(mesh.features[1].values, (Floats{0, -0.25F, -0.5F, -0.75F}));
}

class PlyForms : public testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Each, PlyForms, testing::ValuesIn(kForms),
                         [](const auto& form) { return nameOf(form.param); });

TEST_P(PlyForms, AreReadAlike) {
  const auto loaded = read(squareFile(GetParam()));
  ASSERT_TRUE(loaded) << loaded.error().what;
  expectSquare(loaded->mesh);
  EXPECT_EQ(loaded->notes, Notes{});
}

TEST_P(PlyForms, MayHaveCarriageReturnsInTheirHeader) {
  const std::string file = squareFile(GetParam());
  const std::size_t end = file.find("end_header\n") + 11;
  const auto loaded = read(replaced(file.substr(0, end), "\n", "\r\n") + file.substr(end));
  ASSERT_TRUE(loaded) << loaded.error().what;
  expectSquare(loaded->mesh);
}

// A property of each type, with both of the type's names, and with the largest value of the type.
TEST_P(PlyForms, HaveEightTypesOfTwoNames) {
  const auto last = [&](const std::string& type, auto value) {
    Body body(GetParam());
    body.put(0.0F).put(0.0F).put(0.0F).put(value).line();
    const auto loaded = read(header(GetParam(),
                                    "element vertex 1\nproperty float x\nproperty float y\n"
                                    "property float z\nproperty " +
                                        type + " data\n") +
                             body.text());
    return loaded ? loaded->mesh.features.at(0).values.at(0) : NAN;
  };
  for (const char* type : {"char", "int8"}) EXPECT_EQ(last(type, std::int8_t{-128}), -128.0F);
  for (const char* type : {"uchar", "uint8"}) EXPECT_EQ(last(type, std::uint8_t{255}), 255.0F);
  for (const char* type : {"short", "int16"})
    EXPECT_EQ(last(type, std::int16_t{-32768}), -32768.0F);
  for (const char* type : {"ushort", "uint16"})
    EXPECT_EQ(last(type, std::uint16_t{65535}), 65535.0F);
  for (const char* type : {"int", "int32"}) EXPECT_EQ(last(type, -2147483647 - 1), -2147483648.0F);
  for (const char* type : {"uint", "uint32"}) EXPECT_EQ(last(type, 4294967040U), 4294967040.0F);
  for (const char* type : {"float", "float32"}) EXPECT_EQ(last(type, -0.15625F), -0.15625F);
  for (const char* type : {"double", "float64"}) EXPECT_EQ(last(type, 0.078125), 0.078125F);
}

TEST_P(PlyForms, MayCarryWhatNobodyKnows) {
  Body body(GetParam());
  // An element "camera", which the reader skips.
  body.put(std::uint8_t{2}).put(7.0).put(8.0).put(std::int16_t{-1}).line();
  for (int v = 0; v < 3; ++v) {
    body.put(std::uint8_t{1}).put(v).put(v == 1 ? 1.0F : 0.0F).put(v == 2 ? 1.0F : 0.0F).put(0.0F);
    body.line();
  }
  body.put(std::uint8_t{9}).put(std::int8_t{3}).put(std::uint16_t{0}).put(std::uint16_t{1});
  body.put(std::uint16_t{2}).line();
  const auto loaded =
      read(header(GetParam(),
                  "obj_info an unknown element, an empty one, a list in a vertex, a face's flags\n"
                  "element camera 1\nproperty list uchar double lens\nproperty short shutter\n"
                  "element nothing 1000000\n"
                  "element vertex 3\nproperty list uchar int bones\nproperty float x\n"
                  "property float y\nproperty float z\n"
                  "element face 1\nproperty uchar flags\n"
                  "property list char ushort vertex_index\n") +
           body.text());
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 2}));
  EXPECT_TRUE(loaded->mesh.features.empty());
  EXPECT_EQ(loaded->notes,
            Notes{"left out: camera, nothing, bones (a list), flags (a face property)"});
}

const std::string kAscii = squareFile(Form::kAscii);

TEST(PlyAscii, MayHaveCarriageReturnsBlanksAndSigns) {
  auto loaded = read(replaced(kAscii, "\n", "\r\n"));
  ASSERT_TRUE(loaded) << loaded.error().what;
  expectSquare(loaded->mesh);
  loaded = read(replaced(replaced(kAscii, " 0.500000 ", "\t +5e-1  "), "property float",
                         " property\tfloat "));
  ASSERT_TRUE(loaded) << loaded.error().what;
  expectSquare(loaded->mesh);
}

TEST(PlyRead, TakesFacesBeforeTheirVertices) {
  const auto loaded = read(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\nproperty float z\nproperty float y\nproperty float x\nend_header\n"
      "3 0 1 2\n1 2 3\n4 5 6\n7 8 9\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.positions, (Floats{3, 2, 1, 6, 5, 4, 9, 8, 7}));
}

TEST(PlyRead, FansPolygonsAndCountsThoseWithoutArea) {
  const auto loaded =
      read(replaced(replaced(kAscii, "4 0 1 3 2", "5 0 1 3 2 1"), "3 0 1 3", "2 0 1"));
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 3, 0, 3, 2, 0, 2, 1}));
  EXPECT_EQ(loaded->tidied.degenerate, 1u);
}

std::string arrowFile(const std::string& face) {
  return "ply\nformat ascii 1.0\ncomment TextureFile a.png\n"
         "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\n"
         "property list uchar float texcoord\nend_header\n"
         "0 0 0\n2 2 0\n0 1 0\n-2 2 0\n" +
         face + "\n";
}

TEST(PlyRead, CutsAFaceThatIsNotConvexWithinItself) {
  mesh::ply::FaceTextures faces;
  const auto loaded = mesh::ply::parse(arrowFile("4 1 2 3 0  8 1 0 2 0 3 0 4 0"), &faces);
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.triangles, (Indices{0, 1, 2, 2, 3, 0}));
  std::string at_corners;
  for (const auto& uv : faces.corners) at_corners += fmt::format("{} ", uv[0]);
  EXPECT_EQ(at_corners, "4 1 2 2 3 4 ") << "coordinates stay at their corners";
  const auto nowhere = mesh::ply::parse(arrowFile("4 1 2 9 0  0"), &faces);
  ASSERT_TRUE(nowhere) << "validate() refuses it";
  EXPECT_EQ(nowhere->mesh.triangles, (Indices{1, 2, 9, 1, 9, 0}));
}

// Each number belongs to the next property, wherever the lines end.
TEST(PlyAscii, NamesTheRowThatHasMoreNumbersThanTheHeaderPromises) {
  const auto fault = [](const std::string& text) {
    const auto loaded = read(text);
    return loaded ? "" : loaded.error().what;
  };
  EXPECT_EQ(fault(replaced(kAscii, "3 0 1 3\n", "3 0 1 3 7\n")),
            "face 1 has 5 numbers in its line, but 4 by the header");
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(fault(header + "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"),
            "vertex 0 has 4 numbers in its line, but 3 by the header");
  EXPECT_EQ(fault(header + "0 0 0\n1 0 0\n0 1 0 1\n3 0 1 2\n"),
            "vertex 2 has 4 numbers in its line, but 3 by the header");
  EXPECT_EQ(fault(header + "0 0 0 1 0 0\n0 1 0\n3 0 1 2\n"), "") << "lines do not matter";
  EXPECT_EQ(fault(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\nmore\n"), "");
}

// Strips of the square 0 1 3 2 and of one more corner: all triangles must face the same way as the
// first one.
TEST(PlyRead, StripsBecomeTrianglesThatFaceOneWay) {
  const auto strips = [](const std::string& rows, const std::string& list) {
    return read(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips " +
        rows + "\nproperty list int int vertex_indices\nend_header\n" +
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n" + list);
  };
  const auto triangles = [&](const std::string& rows, const std::string& list) {
    const auto loaded = strips(rows, list);
    EXPECT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded ? loaded->notes.size() : 0, 0u);
    return loaded ? loaded->mesh.triangles : std::vector<std::uint32_t>();
  };
  using Triangles = std::vector<std::uint32_t>;
  EXPECT_EQ(triangles("1", "5 0 1 2 3 4\n"), (Triangles{0, 1, 2, 2, 1, 3, 2, 3, 4}));
  EXPECT_EQ(triangles("1", "8 0 1 2 -1 2 1 3 -1\n"), (Triangles{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(triangles("2", "3 0 1 2\n3 2 1 3\n"), (Triangles{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(triangles("1", "6 0 1 2 3 2 4\n"), (Triangles{0, 1, 2, 2, 1, 3, 2, 3, 4}))
      << "a repeated index turns the strip";
  EXPECT_EQ(strips("1", "3 0 1 -2\n").error().what,
            "tristrips 0: corner 2 is -2, not a vertex index");
  EXPECT_EQ(strips("1", "3 0 1\n").error().what,
            "cut short in tristrips 0 of 1, property vertex_indices");
}

TEST(PlyRead, PutsKnownPropertiesUnderOneName) {
  const auto loaded = read(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float ny\nproperty float nz\nproperty float nx\n"
      "property float u\nproperty float v\nproperty ushort b\nproperty ushort g\n"
      "property ushort r\nproperty uchar alpha\nend_header\n"
      "0 0 0 2 3 1 0.25 0.75 65535 13107 0 128\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  const mesh::Mesh& mesh = loaded->mesh;
  ASSERT_EQ(mesh.features.size(), 4u);
  EXPECT_EQ(mesh.find("normal")->values, (Floats{1, 2, 3}));
  EXPECT_EQ(mesh.find("texcoord")->values, (Floats{0.25F, 0.75F}));
  EXPECT_EQ(mesh.find("alpha")->values, (Floats{128}));  // an unknown name: kept as a feature
  ASSERT_EQ(mesh.find("colour")->values.size(), 3u);
  EXPECT_EQ(mesh.find("colour")->values[0], 0.0F);
  EXPECT_FLOAT_EQ(mesh.find("colour")->values[1], 0.2F);
  EXPECT_FLOAT_EQ(mesh.find("colour")->values[2], 1);
}

// Some programs write the bytes as floats, or as integers of four bytes.
TEST(PlyRead, ColoursInOtherTypesAreBytesIfTheyReachMoreThanFractionsDo) {
  const auto second = [](const std::string& type, const std::string& red_green_blue) {
    const auto loaded = read(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nproperty " +
        type + " red\nproperty " + type + " green\nproperty " + type +
        " blue\nend_header\n0 0 0 0 0 1\n0 0 0 " + red_green_blue + "\n");
    EXPECT_TRUE(loaded) << loaded.error().what;
    const Floats& colour = loaded->mesh.find("colour")->values;
    return Floats{colour.begin() + 3, colour.end()};
  };
  EXPECT_EQ(second("float", "0.25 0.5 1.5"), (Floats{0.25F, 0.5F, 1.5F})) << "brighter than white";
  EXPECT_EQ(second("float", "51 255 0"), (Floats{0.2F, 1, 0}));
  EXPECT_EQ(second("int", "51 255 0"), (Floats{0.2F, 1, 0}));
}

TEST(PlyRead, TakesTheFirstOfTwoThatAreOne) {
  const auto loaded = read(replaced(kAscii, "property double heat", "property float red"));
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes, Notes{"left out: red (a second property for the same value)"});
  EXPECT_EQ(loaded->mesh.find("colour")->values, read(kAscii)->mesh.find("colour")->values);
}

TEST(PlyRead, NamesAFewOfManyThatAreLeftOut) {
  std::string lists;
  for (int i = 0; i < 12; ++i) lists += fmt::format("property list uchar int l{}\n", i);
  const auto loaded = read(
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
      "property float y\nproperty float z\n" +
      lists + "end_header\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes,
            Notes{"left out: l0 (a list), l1 (a list), l2 (a list), l3 (a list), l4 (a list), "
                  "l5 (a list), l6 (a list), l7 (a list) and 4 more"});
}

TEST(PlyRead, CountsWholeNumbersThatAFloatHasNot) {
  const auto loaded = read(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty int label\nend_header\n0 0 0 16777216\n0 0 0 16777217\n"
      "0 0 0 -33554433\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->notes, Notes{"2 integers beyond 2^24 were rounded to floats"});
}

// These names have bytes that would control a terminal or that JSON cannot hold.
TEST(PlyRead, RefusesNamesThatAreNoText) {
  for (const char* name : {"he\x1b[31mat", "he\xff", "he\x7f", "\xc2\x9bheat", "\xc3"}) {
    const auto refused = read(replaced(kAscii, "property double heat", "property double "s + name));
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().what.ends_with(": the property's name is not valid UTF-8"));
  }
  EXPECT_TRUE(read(replaced(kAscii, "double heat", "double \xce\xb8-\xe2\x84\x83")));
}

// A scalar property called "colour" must not be taken for a colour's red, nor be written as one.
TEST(PlyRead, LeavesOutAScalarThatBearsTheNameOfAKnownFeature) {
  for (const char* name : {"colour", "normal", "texcoord"}) {
    const auto loaded =
        read(replaced(replaced(kAscii, "property double heat", "property uchar blue"),
                      "property uchar red", "property uchar "s + name));
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(
        loaded->notes,
        Notes{"left out: "s + name +
              " (is expected as several properties), blue (a second property for the same value)"});
    ASSERT_EQ(loaded->mesh.features.size(), 1u);
    EXPECT_EQ(loaded->mesh.features[0].name, "colour");
    EXPECT_EQ(loaded->mesh.features[0].dimension, 3u);
    EXPECT_EQ(loaded->mesh.features[0].values.size(), 12u);
  }
}

}  // namespace
}  // namespace merlin::render
