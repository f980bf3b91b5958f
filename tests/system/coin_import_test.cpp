// `merlin mesh import` of Inventor and VRML files whose indices are out of range, whose faces are
// clockwise, or whose grids are coloured. The test makes all files.
#include <bit>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;
using Colour = std::array<int, 3>;

std::string inventor(const std::string& nodes) {
  return "#Inventor V2.1 ascii\nSeparator { Coordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] "
         "}\n" +
         nodes + " }\n";
}

std::string vrml97(const std::string& geometry) {
  return "#VRML V2.0 utf8\nShape { geometry " + geometry + " }\n";
}

// Returns a square in VRML 97; `fields` are added to its IndexedFaceSet.
std::string faceSet(const std::string& fields) {
  return vrml97("IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] } " +
                fields + " }");
}

struct Vertex {
  std::array<float, 3> at{}, normal{};
  Colour colour{-1, -1, -1};  // -1: the file has no colours
};

// Returns the vertices of a binary PLY file as merlin writes it: float x y z, uchar red green blue
// if it has colours, float nx ny nz.
std::vector<Vertex> verticesOf(const std::string& ply) {
  const std::string kEnd = "end_header\n", kCount = "element vertex ";
  const bool coloured = ply.find("property uchar red") != std::string::npos;
  const auto number =
      static_cast<std::size_t>(std::stoi(ply.substr(ply.find(kCount) + kCount.size())));
  std::vector<Vertex> all(number);
  const auto* p = reinterpret_cast<const std::uint8_t*>(ply.data()) + ply.find(kEnd) + kEnd.size();
  const auto floats = [&p](std::array<float, 3>& to) {
    for (float& x : to) {
      x = std::bit_cast<float>(loadLe32(p));
      p += 4;
    }
  };
  for (Vertex& v : all) {
    floats(v.at);
    if (coloured) {
      for (int& c : v.colour) c = *p++;
    }
    floats(v.normal);
  }
  return all;
}

class CoinImport : public testing::Test {
 protected:
  Outcome import(const std::string& content) {
    writeText(dir_ / "a.wrl", content);
    return run({kMerlin, "mesh", "import", dir_ / "a.wrl", "-o", out_, "--json"});
  }
  std::vector<Vertex> vertices(const std::string& content) {
    const Outcome done = import(content);
    EXPECT_EQ(done.status, 0) << done.output << content;
    return done.status == 0 ? verticesOf(readText(out_)) : std::vector<Vertex>();
  }
  // Returns the colour of the vertex at this place; {-2, ...} if there is no vertex, or if several
  // vertices of different colours are there.
  static Colour colourAt(const std::vector<Vertex>& all, const std::array<float, 3>& at) {
    Colour colour{-2, -2, -2};
    for (const Vertex& v : all) {
      if (v.at == at)
        colour = colour[0] == -2 || colour == v.colour ? v.colour : Colour{-3, -3, -3};
    }
    return colour;
  }
  void expectRefused(const std::string& content, const std::string& why) {
    const Outcome done = import(content);
    EXPECT_EQ(done.status, 2) << done.output << content;
    EXPECT_NE(done.output.find("a.wrl: shape 1, " + why + "\n"), std::string::npos)
        << done.output << content;
    EXPECT_FALSE(fs::exists(out_));
    fs::remove(out_);
  }

  TempDir dir_;
  std::string out_ = dir_ / "out.ply";
};

TEST_F(CoinImport, ACoordinateThatIsNotThereIsRefused) {
  const std::string four = ", and there are 4 coordinates";
  for (const int index : {4, 7, 20, 1000, 100'000'000}) {
    const std::string why = fmt::format("IndexedFaceSet: its coordIndex has {}", index) + four;
    expectRefused(inventor(fmt::format(
                      "IndexedFaceSet {{ coordIndex [ 0, 1, 2, -1, 0, 1, {}, -1 ] }}", index)),
                  why);
    expectRefused(faceSet(fmt::format("coordIndex [ 0 1 2 -1 0 1 {} -1 ]", index)), why);
  }
  expectRefused(inventor("DEF ROOF IndexedTriangleStripSet { coordIndex [ 0, 1, 4 ] }"),
                "IndexedTriangleStripSet 'ROOF': its coordIndex has 4" + four);
  expectRefused(inventor("IndexedFaceSet { vertexProperty VertexProperty { vertex [ 0 0 0, 1 0 0, "
                         "0 1 0 ] } coordIndex [ 0, 1, 3, -1 ] }"),
                "IndexedFaceSet: its coordIndex has 3, and there are 3 coordinates");
  expectRefused(vrml97("IndexedFaceSet { coordIndex [ 0 1 2 -1 ] }"),
                "IndexedFaceSet: its coordIndex has 0, and there are 0 coordinates");
  EXPECT_EQ(vertices(inventor("IndexedFaceSet { coordIndex [ 0, 1, 2, 3 ] }")).size(), 4U);
}

// Users who miss a part of the scene in the model find the reason in the report's notes.
TEST_F(CoinImport, WhatIsLeftOutIsNoted) {
  const std::string square = "IndexedFaceSet { coordIndex [ 0, 1, 2, 3, -1 ] } ";
  const auto notes = [&](const std::string& content) {
    const Outcome done = import(content);
    EXPECT_EQ(done.status, 0) << done.output << content;
    const auto brace = done.output.find("{\"");
    if (brace == std::string::npos) return std::vector<std::string>{done.output};
    return nlohmann::json::parse(done.output.substr(brace))["notes"]
        .get<std::vector<std::string>>();
  };
  using Notes = std::vector<std::string>;
  EXPECT_EQ(notes(inventor(square)), Notes{});
  EXPECT_EQ(notes(inventor(square + "LineSet { numVertices 3 } PointSet { numPoints 2 }")),
            Notes{"left out: 4 lines and points"})
      << "two lines and two points";
  EXPECT_EQ(
      notes(inventor(square +
                     "Image { image 1 1 3 0xff0000 } Text2 { string \"hall\" }\n"
                     "NurbsSurface { numUControlPoints 2 numVControlPoints 2 uKnotVector [ 0, 0, "
                     "1, 1 ] vKnotVector [ 0, 0, 1, 1 ] }\n"
                     "NurbsCurve { numControlPoints 2 knotVector [ 0, 0, 1, 1 ] }")),
      Notes{"left out: 4 images, flat texts (Text2) and NURBS, for which Coin needs a display"});
  EXPECT_EQ(notes(inventor(square + "WWWInline { name \"a.iv\" } WWWInline { name \"b.iv\" }")),
            Notes{"left out: 2 other files that it includes"});
  const Notes missing = notes(faceSet("coordIndex [ 0 1 2 3 -1 ]") + "Inline { url \"c.wrl\" }\n");
  ASSERT_FALSE(missing.empty());
  EXPECT_EQ(missing[0], "left out: 1 other files that it includes");
}

TEST_F(CoinImport, AByteOrderMarkIsPassedOver) {
  EXPECT_EQ(vertices("\xEF\xBB\xBF" + faceSet("coordIndex [ 0 1 2 3 -1 ]")).size(), 4U);
}

TEST_F(CoinImport, AFaceOfTwoCornersIsRefused) {
  expectRefused(faceSet("coordIndex [ 0 1 -1 0 1 2 -1 ]"),
                "IndexedFaceSet: its coordIndex has a face of 2 corners");
  expectRefused(faceSet("coordIndex [ 0 1 2 -1 -1 0 1 2 -1 ]"),
                "IndexedFaceSet: its coordIndex has a face of 0 corners");
  expectRefused(inventor("IndexedFaceSet { coordIndex [ 0, 1, -1, 0, 1, 2, -1 ] }"),
                "IndexedFaceSet: its coordIndex has a face of 2 corners");
  EXPECT_EQ(vertices(faceSet("coordIndex [ 0 1 2 -1 0 1 ]")).size(), 3U);
}

TEST_F(CoinImport, MoreCornersThanCoordinatesAreRefused) {
  expectRefused(inventor("FaceSet { numVertices [ 3, 3 ] }"),
                "FaceSet: it takes 6 coordinates, and there are 4");
  expectRefused(inventor("FaceSet { startIndex 2 numVertices 3 }"),
                "FaceSet: it takes 5 coordinates, and there are 4");
  expectRefused(inventor("FaceSet { startIndex 5 }"),
                "FaceSet: it takes 5 coordinates, and there are 4");
  expectRefused(inventor("FaceSet { startIndex -1 numVertices 3 }"),
                "FaceSet: its startIndex is -1");
  expectRefused(
      inventor("TriangleStripSet { numVertices [ 3, -2 ] }"),
      "TriangleStripSet: its numVertices has -2 beside other values; -1 is allowed alone");
  expectRefused(inventor("QuadMesh { verticesPerRow 2 verticesPerColumn 3 }"),
                "QuadMesh: it takes 6 coordinates, and there are 4");
  EXPECT_EQ(vertices(inventor("FaceSet { }")).size(), 4U);
  EXPECT_EQ(vertices(inventor("QuadMesh { verticesPerRow 2 verticesPerColumn 2 }")).size(), 4U);
}

TEST_F(CoinImport, AColourThatIsNotThereIsRefused) {
  const std::string red = "color Color { color [ 1 0 0 ] } coordIndex [ 0 1 2 -1 0 2 3 -1 ] ";
  expectRefused(faceSet(red + "colorIndex [ 0 0 7 -1 0 0 0 -1 ]"),
                "IndexedFaceSet: its colorIndex has 7, and there are 1 colours");
  expectRefused(faceSet(red + "colorIndex [ 0 0 0 -1 ]"),
                "IndexedFaceSet: its colorIndex has 4 entries, and coordIndex has 8");
  expectRefused(faceSet(red), "IndexedFaceSet: its coordIndex has 1, and there are 1 colours");
  expectRefused(faceSet(red + "colorPerVertex FALSE"),
                "IndexedFaceSet: it has 2 faces, and there are 1 colours");
  expectRefused(faceSet(red + "colorPerVertex FALSE colorIndex [ 0 1 ]"),
                "IndexedFaceSet: its colorIndex has 1, and there are 1 colours");
  expectRefused(faceSet(red + "colorPerVertex FALSE colorIndex [ 0 ]"),
                "IndexedFaceSet: its colorIndex has 1 entries, and it has 2 faces");
  EXPECT_EQ(colourAt(vertices(faceSet(red + "colorPerVertex FALSE colorIndex [ 0 0 ]")), {0, 0, 0}),
            (Colour{255, 0, 0}));
  fs::remove(out_);
  const std::string two = "Material { diffuseColor [ 1 0 0, 0 0 1 ] } ";
  expectRefused(inventor(two + "MaterialBinding { value PER_VERTEX_INDEXED } IndexedFaceSet { "
                               "coordIndex [ 0, 1, 2, -1 ] materialIndex [ 0, 1, 2, -1 ] }"),
                "IndexedFaceSet: its materialIndex has 2, and there are 2 materials");
  expectRefused(inventor(two + "MaterialBinding { value PER_FACE_INDEXED } IndexedFaceSet { "
                               "coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] materialIndex [ 0, 2 ] }"),
                "IndexedFaceSet: its materialIndex has 2, and there are 2 materials");
  expectRefused(
      inventor(two + "MaterialBinding { value PER_FACE_INDEXED } IndexedTriangleStripSet { "
                     "coordIndex [ 0, 1, 2, 3, -1 ] materialIndex [ 0 ] }"),
      "IndexedTriangleStripSet: its materialIndex has 1 entries, and it has 2 faces");
  for (const char* binding : {"PER_FACE_INDEXED", "PER_PART_INDEXED"})
    expectRefused(inventor(two + fmt::format("MaterialBinding {{ value {} }} IndexedFaceSet {{ "
                                             "coordIndex [ 0, 1, 2, -1, 0, 2, 3, -1 ] }}",
                                             binding)),
                  "IndexedFaceSet: it has no materialIndex, which its MaterialBinding needs for "
                  "its 2 faces");
}

// Coin draws such faces with the last material. If the import read beyond the materials in memory,
// each run would give a different colour.
TEST_F(CoinImport, FacesBeyondTheLastMaterialHaveIt) {
  const auto all = vertices(
      inventor("Material { diffuseColor [ 1 0 0, 0 0 1 ] } MaterialBinding { value PER_FACE }\n"
               "IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 0, 1, 2, -1, 0, 2, 3, -1 ] }"));
  EXPECT_EQ(colourAt(all, {0, 1, 0}), (Colour{0, 0, 255}));
}

TEST_F(CoinImport, TextureCoordinatesThatAreNotThereAreRefusedWhereTheyAreNeeded) {
  expectRefused(
      faceSet("coordIndex [ 0 1 2 -1 ] texCoord TextureCoordinate { point [ 0 0, 1 0 ] }"),
      "IndexedFaceSet: its coordIndex has 2, and there are 2 texture coordinates");
  expectRefused(faceSet("coordIndex [ 0 1 2 -1 ] texCoordIndex [ 0 1 -1 -1 ] texCoord "
                        "TextureCoordinate { point [ 0 0, 1 0 ] }"),
                "IndexedFaceSet: its texCoordIndex has -1, and there are 2 texture coordinates");
  const std::string picture = "Texture2 { image 1 1 3 0xff0000 } ";
  const std::string two = "TextureCoordinate2 { point [ 0 0, 1 0 ] } ";
  const std::string shape = "IndexedFaceSet { coordIndex [ 0, 1, 2, -1 ] }";
  expectRefused(inventor(picture + two + shape),
                "IndexedFaceSet: its coordIndex has 2, and there are 2 texture coordinates");
  expectRefused(inventor(picture + two + "FaceSet { numVertices 3 }"),
                "FaceSet: it takes 3 texture coordinates, and there are 2");
  EXPECT_EQ(vertices(inventor(two + shape)).size(), 3U) << "those of another shape";
}

TEST_F(CoinImport, NormalsThatAreNotThereDoNotMatter) {
  const std::string shape = "IndexedFaceSet { coordIndex [ 0, 1, 2, 3, -1 ] ";
  for (const std::string& content :
       {inventor("Normal { vector 0 0 1 } " + shape + "normalIndex [ 0, 1, 900, 3, -1 ] }"),
        inventor("Normal { vector 0 0 1 } " + shape + "}"),
        inventor(shape + "vertexProperty VertexProperty { normal [ 0 0 1 ] } }"),
        faceSet("coordIndex [ 0 1 2 3 -1 ] normal Normal { vector [ 0 0 1 ] } "
                "normalIndex [ 0 1 90000000 3 -1 ]")}) {
    const auto all = vertices(content);
    ASSERT_EQ(all.size(), 4U) << content;
    for (const Vertex& v : all) EXPECT_EQ(v.normal, (std::array<float, 3>{0, 0, 1})) << content;
  }
}

TEST_F(CoinImport, ClockwiseFacesOfVrml97AreTurned) {
  const auto normal = [&](const std::string& content) {
    const auto all = vertices(content);
    return all.empty() ? std::array<float, 3>{} : all[0].normal;
  };
  using N = std::array<float, 3>;
  const std::string faces = "coordIndex [ 0 1 2 3 -1 ]";
  EXPECT_EQ(normal(faceSet(faces)), (N{0, 0, 1}));
  EXPECT_EQ(normal(faceSet(faces + " ccw FALSE")), (N{0, 0, -1}));
  const std::string grid = "ElevationGrid { xDimension 2 zDimension 2 height [ 0 0 0 0 ]";
  EXPECT_EQ(normal(vrml97(grid + " }")), (N{0, 1, 0}));
  EXPECT_EQ(normal(vrml97(grid + " ccw FALSE }")), (N{0, -1, 0}));
  EXPECT_EQ(normal("#VRML V2.0 utf8\nTransform { scale -1 1 1 children " +
                   faceSet(faces + " ccw FALSE").substr(16) + "}"),
            (N{0, 0, -1}))
      << "mirrored, it is as clockwise as before";
}

TEST_F(CoinImport, AnElevationGridHasItsColours) {
  const std::string grid = "ElevationGrid { xDimension 3 zDimension 2 height [ 0 0 0 0 0 0 ] ";
  const auto corners = vertices(
      vrml97(grid + "color Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 0, 0 1 1, 1 0 1 ] } }"));
  ASSERT_EQ(corners.size(), 6U);
  EXPECT_EQ(colourAt(corners, {0, 0, 0}), (Colour{255, 0, 0}));
  EXPECT_EQ(colourAt(corners, {1, 0, 0}), (Colour{0, 255, 0}));
  EXPECT_EQ(colourAt(corners, {2, 0, 0}), (Colour{0, 0, 255}));
  EXPECT_EQ(colourAt(corners, {0, 0, 1}), (Colour{255, 255, 0}));
  EXPECT_EQ(colourAt(corners, {1, 0, 1}), (Colour{0, 255, 255}));
  EXPECT_EQ(colourAt(corners, {2, 0, 1}), (Colour{255, 0, 255}));
  const auto faces =
      vertices(vrml97(grid + "colorPerVertex FALSE color Color { color [ 1 0 0, 0 1 0 ] } }"));
  ASSERT_EQ(faces.size(), 8U) << "of which two lie at two places, in two colours";
  EXPECT_EQ(colourAt(faces, {0, 0, 1}), (Colour{255, 0, 0}));
  EXPECT_EQ(colourAt(faces, {2, 0, 1}), (Colour{0, 255, 0}));
  fs::remove(out_);
  expectRefused(vrml97(grid + "color Color { color [ 1 0 0 ] } }"),
                "ElevationGrid: it takes 6 colours, and there are 1");
  expectRefused(vrml97(grid + "texCoord TextureCoordinate { point [ 0 0 ] } }"),
                "ElevationGrid: it takes 6 texture coordinates, and there are 1");
  expectRefused(vrml97("ElevationGrid { xDimension 65536 zDimension 65536 }"),
                "ElevationGrid: it takes 4294967296 heights, and there are 0");
}

}  // namespace
}  // namespace merlin::test
