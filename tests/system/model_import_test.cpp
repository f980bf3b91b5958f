// `merlin mesh import` of models in other programs' formats, which merlin-import reads. The test
// makes all files.
#include <bit>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "daemon/base/sanitizer.h"
#include "render/correct/io/archive.h"
#include "render/image/image_file.h"
#include "render/image/png_writer.h"
#include "tests/support/gzip.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

// An Inventor scene with a transform: a red square of side 2 in the plane z = 0, then a blue
// triangle beside a degenerate one.
const std::string kSquareIv =
    "#Inventor V2.1 ascii\nSeparator {\n Transform { translation 10 0 0 scaleFactor 1 3 1 }\n"
    " Material { diffuseColor 1 0 0 }\n Coordinate3 { point [ 0 0 0, 2 0 0, 2 2 0, 0 2 0 ] }\n"
    " IndexedFaceSet { coordIndex [ 0, 1, 2, 3, -1 ] }\n"
    " Material { diffuseColor 0 0 1 }\n Translation { translation 0 0 5 }\n"
    " IndexedFaceSet { coordIndex [ 0, 1, 2, -1, 1, 1, 2, -1 ] }\n}\n";

const std::string kVrml97 =
    "#VRML V2.0 utf8\nTransform { translation 0 0 7 children Shape {\n"
    " appearance Appearance { material Material { diffuseColor 0 1 0 } }\n"
    " geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }\n"
    "  coordIndex [ 0 1 2 3 -1 ] } } }\n";

// Returns a COLLADA file with two instances of a square, one of them moved and enlarged to twice
// its size.
std::string collada() {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>0.2 0.4 0.6 1</color>
</diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="s" count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w">
<node id="a"><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="s" target="#m"/>
</technique_common></bind_material></instance_geometry></node>
<node id="b"><translate>0 0 4</translate><scale>2 2 2</scale><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>
)";
}

// Returns a triangle as AMF; `root`: the start tag of the outermost element.
std::string amf(const std::string& root, const std::string& colour) {
  std::string text = "<?xml version=\"1.0\"?>" + root + "<object id=\"0\"><mesh><vertices>";
  for (const char* at : {"<x>0</x><y>0</y>", "<x>1</x><y>0</y>", "<x>0</x><y>1</y>"})
    text += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates>{}</vertex>", at, colour);
  return text +
         "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh>"
         "</object></amf>";
}

// Returns the triangle of amf() as 3MF; `attribute`: added to the outermost element.
std::string threeMf(const std::string& attribute) {
  return *render::correct::zipBytes(
      {{"[Content_Types].xml",
        "<?xml version=\"1.0\"?><Types "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default "
        "Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default "
        "Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
       {"_rels/.rels",
        "<?xml version=\"1.0\"?><Relationships "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
        "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
       {"3D/3dmodel.model",
        "<?xml version=\"1.0\"?><model " + attribute +
            " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
            "<object id=\"1\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>"
            "<vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>"
            "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>"
            "</resources><build><item objectid=\"1\"/></build></model>"}});
}

void appendLe16(std::string& bytes, int value) {
  bytes.push_back(static_cast<char>(value & 0xFF));
  bytes.push_back(static_cast<char>(value >> 8));
}

std::string chunk(int id, const std::string& content) {
  std::string bytes;
  appendLe16(bytes, id);
  appendLe32(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

std::string threeDs() {
  std::string vertices, faces;
  appendLe16(vertices, 3);
  for (const float x : {0.F, 0.F, 0.F, 3.F, 0.F, 0.F, 0.F, 4.F, 0.F})
    appendLe32(vertices, std::bit_cast<std::uint32_t>(x));
  for (const int x : {1, 0, 1, 2, 7}) appendLe16(faces, x);
  const std::string mesh =
      chunk(0x4000, std::string("one\0", 4) +
                        chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces)));
  return chunk(0x4D4D, chunk(2, std::string("\3\0\0\0", 4)) + chunk(0x3D3D, mesh));
}

std::string le(float x) {
  std::string bytes;
  appendLe32(bytes, std::bit_cast<std::uint32_t>(x));
  return bytes;
}

// The same with a picture, whose coordinates are to be scaled.
std::string threeDsWithPicture(float scale, const std::string& picture = "t.png") {
  const std::string named("m\0", 2);
  const std::string material =
      chunk(0xA000, named) + chunk(0xA200, chunk(0xA300, picture + '\0') +
                                               chunk(0xA354, le(scale)) + chunk(0xA356, le(scale)));
  std::string vertices, faces, coordinates, of_material = named;
  for (std::string* counted : {&vertices, &coordinates}) appendLe16(*counted, 3);
  for (const float x : {0.F, 0.F, 0.F, 3.F, 0.F, 0.F, 0.F, 4.F, 0.F}) vertices += le(x);
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 1.F}) coordinates += le(x);
  for (const int x : {1, 0, 1, 2, 7}) appendLe16(faces, x);
  for (const int x : {1, 0}) appendLe16(of_material, x);
  const std::string mesh =
      chunk(0x4000, std::string("one\0", 4) +
                        chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4140, coordinates) +
                                          chunk(0x4120, faces + chunk(0x4130, of_material))));
  return chunk(
      0x4D4D, chunk(2, std::string("\3\0\0\0", 4)) + chunk(0x3D3D, chunk(0xAFFF, material) + mesh));
}

class ModelImport : public testing::Test {
 protected:
  Outcome import(const std::string& in, std::vector<std::string> more = {}) {
    std::vector<std::string> command = {kMerlin, "mesh", "import", in, "-o", out_};
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  }
  nlohmann::json report(const std::string& name, const std::string& content) {
    writeText(dir_ / name, content);
    const Outcome done = import(dir_ / name, {"--json"});
    EXPECT_EQ(done.status, 0) << done.output;
    const auto start = done.output.find("{\"input\"");
    if (start == std::string::npos) return {};
    return nlohmann::json::parse(done.output.substr(start));
  }
  nlohmann::json info() {
    return nlohmann::json::parse(run({kMerlin, "mesh", "info", out_, "--json"}).output);
  }
  std::string features() {
    std::string names;
    const auto json = info();
    for (const auto& f : json["features"]) names += f["name"].get<std::string>() + " ";
    return names;
  }
  // Expects that the file is refused by one line that names it and contains `why`, and that no
  // output file is left.
  void expectRefused(const std::string& name, const std::string& content, const std::string& why,
                     const std::vector<std::string>& more = {}) {
    writeText(dir_ / name, content);
    const Outcome done = import(dir_ / name, more);
    EXPECT_EQ(done.status, 2) << done.output;
    EXPECT_NE(done.output.find(dir_ / name + ":"), std::string::npos) << done.output;
    EXPECT_NE(done.output.find(why), std::string::npos) << done.output;
    for (const auto& entry : fs::directory_iterator(dir_.path())) {
      const std::string left = entry.path().filename();
      EXPECT_FALSE(left.starts_with("out") || left.starts_with(".merlin")) << left;
    }
  }

  TempDir dir_;
  std::string out_ = dir_ / "out.ply";
};

TEST_F(ModelImport, OpenInventorIsTransformedColouredAndLabelledByPart) {
  const auto json = report("a.iv", kSquareIv);
  EXPECT_EQ(json["format"], "Open Inventor");
  EXPECT_EQ(json["parts"], 2);
  EXPECT_EQ(json["triangles"], 3) << "a square, and a triangle";
  EXPECT_EQ(json["degenerate_dropped"], 1);
  EXPECT_EQ(json["vertices"], 7) << "a square's and a triangle's";
  EXPECT_EQ(features(), "colour label normal ");
  EXPECT_EQ(info()["box"]["low"], nlohmann::json({10.0, 0.0, 0.0}));
  EXPECT_EQ(info()["box"]["high"], nlohmann::json({12.0, 6.0, 5.0}));
  const std::string ply = readText(out_);
  EXPECT_NE(ply.find(std::string("\xff\0\0", 3)), std::string::npos) << "a red vertex";
}

TEST_F(ModelImport, ItsContentDecidesWhatAFileIs) {
  const auto json = report("vrml.obj", kVrml97);
  EXPECT_EQ(json["format"], "VRML");
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(info()["box"]["low"][2], 7.0);
  EXPECT_EQ(report("obj.dae", "# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")["format"], "mesh");
  EXPECT_EQ(report("off.bin", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")["triangles"], 1);
}

TEST_F(ModelImport, ColladaIsOneMeshOfItsInstances) {
  const auto json = report("a.dae", collada());
  EXPECT_EQ(json["format"], "COLLADA");
  EXPECT_EQ(json["parts"], 2);
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["vertices"], 8);
  EXPECT_EQ(features(), "colour label normal ");
  EXPECT_EQ(info()["box"]["high"], nlohmann::json({2.0, 2.0, 4.0}));
  EXPECT_NE(readText(out_).find("\x33\x66\x99"), std::string::npos) << "its diffuse colour";
}

TEST_F(ModelImport, ColladaIsInMetresByItsOwnUnit) {
  std::string inches = collada();
  inches.insert(inches.find("<up_axis>"), "<unit name=\"inch\" meter=\"0.0254\"/>");
  writeText(dir_ / "a.dae", inches);
  const auto about =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "a.dae", "--json"}).output);
  EXPECT_EQ(about["unit"], "m");
  EXPECT_NEAR(about["box"]["high"][0], 0.0508, 1e-6);
}

TEST_F(ModelImport, AmfWithoutColoursHasNoneAndItsUnitIsSaid) {
  const auto plain = report("a.amf", amf("<amf unit=\"inch\">", ""));
  EXPECT_EQ(features(), "normal ");
  EXPECT_EQ(plain["notes"].dump(),
            "[\"its coordinates are left in its unit, inch; --scale 0.0254 makes them metres\"]");
  const auto red = report("a.amf", amf("<amf>", "<color><r>1</r><g>0</g><b>0</b></color>"));
  EXPECT_EQ(features(), "colour normal ");
  EXPECT_EQ(red["notes"].dump(), "[]");
  EXPECT_NE(readText(out_).find(std::string("\xff\0\0", 3)), std::string::npos);
}

TEST_F(ModelImport, TheUnitOf3mfIsSaid) {
  const auto notes = [&](const std::string& attribute) {
    const auto json = report("a", threeMf(attribute));
    EXPECT_EQ(json["format"], "3MF");
    EXPECT_EQ(json["triangles"], 1);
    return json["notes"].dump();
  };
  const std::string left = "[\"its coordinates are left in its unit, ";
  EXPECT_EQ(notes("unit=\"inch\""), left + "inch; --scale 0.0254 makes them metres\"]");
  EXPECT_EQ(notes(""), left + "millimeter; --scale 0.001 makes them metres\"]");
  EXPECT_EQ(notes("unit=\"meter\""), left + "meter\"]");
}

TEST_F(ModelImport, ThreeDsIsReadByItsChunks) {
  const auto json = report("a", threeDs());
  EXPECT_EQ(json["format"], "3DS");
  EXPECT_EQ(json["triangles"], 1);
  EXPECT_NEAR(info()["diagonal"], 5, 1e-5);
}

TEST_F(ModelImport, AScaledTextureOf3dsIsLeftAsItIsWithANote) {
  const std::vector<std::uint8_t> red = {255, 0, 0, 255};
  ASSERT_TRUE(render::image::writePng(dir_ / "t.png", 1, 1, red));
  const auto plain = report("a.3ds", threeDsWithPicture(1));
  EXPECT_GT(plain["texture_bytes"], 60) << plain;
  EXPECT_EQ(plain["notes"].dump().find("left out"), std::string::npos) << plain["notes"];
  EXPECT_NE(report("a.3ds", threeDsWithPicture(0.25F))["notes"].dump().find(
                "left out: the scales, offsets and rotations of 1 textures"),
            std::string::npos);
}

// Names in DOS-era formats are in capitals, however the file beside the model is spelled.
TEST_F(ModelImport, ATextureIsFoundWhoseNameDiffersInCapitals) {
  const std::vector<std::uint8_t> red = {255, 0, 0, 255};
  fs::create_directory(dir_ / "Maps");
  ASSERT_TRUE(render::image::writePng(dir_ / "Maps/T.png", 1, 1, red));
  std::string model = threeDsWithPicture(1, "MAPS\\T.PNG");
  const auto found = report("a.3ds", model);
  EXPECT_GT(found["texture_bytes"], 60) << found;
  EXPECT_NE(found["notes"].dump().find("/Maps/T.png: is taken for MAPS/T.PNG, which is not "
                                       "there; the names differ only in capitals\""),
            std::string::npos)
      << found["notes"];
  ASSERT_TRUE(render::image::writePng(dir_ / "T.PNG", 1, 1, red));
  const auto exact = report("a.3ds", threeDsWithPicture(1, "T.PNG"));
  EXPECT_GT(exact["texture_bytes"], 60) << exact;
  EXPECT_EQ(exact["notes"].dump().find("capitals"), std::string::npos) << exact["notes"];
}

TEST_F(ModelImport, GltfColoursComeBackAsTheyWere) {
  writeText(dir_ / "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 10 100 200\n1 0 0 10 100 200\n0 1 0 10 100 200\n3 0 1 2\n");
  ASSERT_EQ(run({kMerlin, "mesh", "import", dir_ / "a.ply", "-o", dir_ / "a.glb"}).status, 0);
  const auto json = report("b", readText(dir_ / "a.glb"));
  EXPECT_EQ(json["format"], "glTF");
  EXPECT_EQ(features(), "colour normal ") << "one part needs no label";
  EXPECT_NE(readText(out_).find("\x0a\x64\xc8"), std::string::npos);
}

TEST_F(ModelImport, AModelForTheWallIsMadeInOneStep) {
  out_ = dir_ / "out.mrm";
  std::string spheres = "#Inventor V2.1 ascii\n";
  for (int i = 0; i < 3; ++i) spheres += "Translation { translation 3 0 0 } Sphere { }\n";
  const auto json = report("a.iv", spheres);
  EXPECT_GT(json["triangles"], 500);
  EXPECT_LT(json["triangles_coarsest"], json["triangles"]);
}

TEST_F(ModelImport, ATextureBesideTheModelIsKeptAndNoOtherFileIsRead) {
  const auto textured = [](const std::string& name) {
    return "#VRML V2.0 utf8\nShape { appearance Appearance { texture ImageTexture { url \"" + name +
           "\" } } geometry Box { } }\n";
  };
  fs::create_directory(dir_ / "models");
  const std::vector<std::uint8_t> red = {255, 0, 0, 255};
  ASSERT_TRUE(render::image::writePng(dir_ / "models/beside.png", 1, 1, red));
  ASSERT_TRUE(render::image::writePng(dir_ / "above.png", 1, 1, red));
  const auto kept = report("models/a.wrl", textured("beside.png"));
  EXPECT_GT(kept["texture_bytes"], 60) << kept;
  EXPECT_EQ(features(), "colour texcoord normal ");
  fs::remove(out_ + ".png");
  EXPECT_TRUE(kept["notes"].empty()) << kept["notes"];
  const std::string square = "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] } FaceSet { }";
  const auto inventor = report("models/a.iv",
                               "#Inventor V2.1 ascii\nSeparator { Texture2 { filename "
                               "\"beside.png\" } " +
                                   square + " }\n");
  EXPECT_GT(inventor["texture_bytes"], 60) << inventor;
  EXPECT_TRUE(inventor["notes"].empty()) << "Coin itself reads no pictures: " << inventor["notes"];
  fs::remove(out_ + ".png");
  const auto left = report("models/b.wrl", textured("../above.png"));
  EXPECT_EQ(left["texture_bytes"], 0);
  EXPECT_NE(left["notes"].dump().find("this texture is left out"), std::string::npos) << left;
}

// The synthetic room in the three formats that tests/support/textured_models.py writes: a floor
// whose picture repeats, a wall, a board, and a pillar without a picture.
class TexturedRoom : public ModelImport, public testing::WithParamInterface<const char*> {};

TEST_P(TexturedRoom, HasOneTextureOfAllItsPictures) {
  ASSERT_EQ(
      run({"python3", "-B", kSource + "/tests/support/textured_models.py", dir_.path()}).status, 0);
  const std::string name = GetParam();
  const auto json = report(name, readText(dir_ / name));
  EXPECT_EQ(json["triangles"], 2 + 2 + 2 + 48);
  EXPECT_NE(json["notes"].dump().find("3 textures and 1 plain colour became one of"),
            std::string::npos)
      << json["notes"];
  const auto atlas = render::image::readImage(out_ + ".png");
  ASSERT_TRUE(atlas) << atlas.error().what;
  EXPECT_GE(atlas->width * atlas->height, 12 * 64 * 12 * 64) << "twelve repeats each way";
  if (name == "room.obj") return;
  EXPECT_EQ(json["parts"], 4);
  EXPECT_EQ(features(), "colour texcoord label normal ");
}

// Returns the share of pixels that resemble a colour [%].
double shareOf(const render::image::ImageFile& picture, const std::array<int, 3>& like) {
  std::size_t n = 0;
  for (std::size_t i = 0; i + 2 < picture.pixels.size(); i += 3) {
    bool same = true;
    for (std::size_t k = 0; k < 3; ++k)
      same = same && std::abs(picture.pixels[i + k] - like[k]) <= 30;
    n += same;
  }
  return 300.0 * static_cast<double>(n) / static_cast<double>(picture.pixels.size());
}

// Seen from the front, the wall is red, the board has a yellow frame and a white arrow, the pillar
// is green, and the floor is light and dark.
TEST_P(TexturedRoom, LooksAsItsPicturesDo) {
  ASSERT_EQ(
      run({"python3", "-B", kSource + "/tests/support/textured_models.py", dir_.path()}).status, 0);
  ASSERT_EQ(import(dir_ / GetParam()).status, 0);
  const Outcome drawn = run({kMerlin, "mesh", "picture", out_, "-o", dir_ / "room.png", "--backend",
                             "osmesa", "--yaw", "25", "--pitch", "25"});
  ASSERT_EQ(drawn.status, 0) << drawn.output;
  const auto picture = render::image::readImage(dir_ / "room.png");
  ASSERT_TRUE(picture) << picture.error().what;
  struct Seen {
    const char* what;
    std::array<int, 3> colour;
    double least, most;  // [%] of the picture's pixels
  };
  // glTF states material colours in linear light
  const bool linear = std::string_view(GetParam()) == "room.gltf";
  const Seen all[] = {
      {"bricks", {140, 60, 40}, 5, 20},
      {"the board's frame", {215, 170, 0}, 0.2, 1.5},
      {"the arrow", {215, 215, 215}, 0.3, 9},
      {"light tiles", {195, 195, 187}, 4, 12},
      {"dark tiles", {52, 60, 77}, 4, 12},
      {"the pillar", {linear ? 105 : 45, linear ? 175 : 140, linear ? 130 : 70}, 1, 5}};
  for (const Seen& seen : all) {
    EXPECT_GE(shareOf(*picture, seen.colour), seen.least) << seen.what;
    EXPECT_LE(shareOf(*picture, seen.colour), seen.most) << seen.what;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, TexturedRoom, testing::Values("room.obj", "room.wrl", "room.gltf"));

// Two squares side by side, each of which is a part of its own.
TEST_F(ModelImport, PartsOfOneSurfaceAreWelded) {
  const auto square = [](int x) {
    return fmt::format(
        "Separator {{ Coordinate3 {{ point [ {0} 0 0, {1} 0 0, {1} 1 0, {0} 1 0 ] }}"
        " IndexedFaceSet {{ coordIndex [ 0, 1, 2, 3, -1 ] }} }}\n",
        x, x + 1);
  };
  const auto json = report("a.iv", "#Inventor V2.1 ascii\n" + square(0) + square(1) + square(5));
  EXPECT_EQ(json["parts"], 3);
  EXPECT_EQ(json["welded_edges"], 1);
  EXPECT_EQ(json["welded_vertices"], 2);
  EXPECT_EQ(json["vertices"], 10);
  EXPECT_EQ(info()["components"], 2);
  const Outcome text = import(dir_ / "a.iv");
  EXPECT_NE(text.output.find("  welded    2 vertices of different parts, along 1 common edges\n"),
            std::string::npos)
      << text.output;
}

TEST_F(ModelImport, InventorAndVrmlMayBePackedByGzip) {
  const auto json = report("a.iv.gz", gzipped(kSquareIv));
  EXPECT_EQ(json["format"], "Open Inventor, gzip");
  EXPECT_EQ(json["triangles"], 3);
  EXPECT_EQ(report("vrml", gzipped(kVrml97))["triangles"], 2);
  EXPECT_EQ(info()["unit"], "");
  writeText(dir_ / "b.wrz", gzipped(kVrml97));
  const auto about =
      nlohmann::json::parse(run({kMerlin, "mesh", "info", dir_ / "b.wrz", "--json"}).output);
  EXPECT_EQ(about["unit"], "m") << "as the rules of VRML say";
  const std::string packed = gzipped(kSquareIv);
  std::filesystem::remove(out_);
  expectRefused("cut.gz", packed.substr(0, packed.size() - 20), "gzip: is cut");
  for (const char* name : {"other.gz", "other.ply"})
    expectRefused(name, gzipped("ply\n"), "is packed by gzip; of packed files only Inventor");
  expectRefused("twice.gz", gzipped(packed), "is packed by gzip; of packed files only Inventor");
  std::string damaged = gzipped("ply\n");
  damaged[10] = '\xff';  // the first byte after the header
  for (const char* name : {"damaged.gz", "damaged.ply"})
    expectRefused(name, damaged, "gzip: is damaged at byte ");
#if !defined(MERLIN_ANY_SANITIZER)
  std::string bomb = gzipped(kSquareIv);
  const std::string member = gzipped(std::string(std::size_t{1} << 24, '#'));
  for (int i = 0; i < 64; ++i) bomb += member;
  expectRefused("bomb.iv", bomb, "gzip: unpacks to more than 1073741824 bytes",
                {"--memory", "4G"});  // the limit is fixed, whatever memory this machine has free
#endif
}

TEST_F(ModelImport, WhatIsWrongIsSaidInOneMessageThatNamesTheFile) {
  expectRefused("cut.iv", kSquareIv.substr(0, 150), "cannot be read: Couldn't read");
  expectRefused("cut.dae", collada().substr(0, 900), "cannot be read as .dae");
  expectRefused("cut.3ds", threeDs().substr(0, 40), "cannot be read as .3ds");
  expectRefused("lies.wrl", "#VRML V1.0 ascii\nP5\n3 3 255\n", "cannot be read: ");
  expectRefused("cyclic.iv", "#Inventor V2.1 ascii\nDEF A Separator { Cube { } USE A }\n",
                "is cyclic: a Separator contains itself");
  expectRefused("empty.iv", "#Inventor V2.1 ascii\nSeparator { }\n", "holds no surface");
  expectRefused("unknown.bin", "what is this", "has a format that MERLIN does not read");
  expectRefused("a.iv", kSquareIv, "--angles is for range images", {"--angles", "1", "2"});
  std::string multiplies = "#Inventor V2.1 ascii\nSeparator { DEF A0 Separator { Cube { } }\n";
  for (int i = 1; i < 30; ++i)
    multiplies += fmt::format("DEF A{} Separator {{ USE A{} USE A{} }}\n", i, i - 1, i - 1);
  expectRefused("bomb.iv", multiplies + "}\n", "uses its shapes ");
}

TEST_F(ModelImport, ACrashAndALimitOfMemoryAreMessages) {
// Not with a sanitizer, which would report the crash and needs terabytes of address space.
#if !defined(MERLIN_ANY_SANITIZER)
  std::string deep = "#Inventor V2.1 ascii\n";
  for (int i = 0; i < 200'000; ++i) deep += "Group {";
  expectRefused("deep.iv", deep, "the import ended by signal 11");
  std::string large = "#Inventor V2.1 ascii\nDEF A Separator { Sphere { } }\n";
  for (int i = 0; i < 20'000; ++i) large += "Translation { translation 1 0 0 } USE A\n";
  expectRefused("large.iv", large, "takes more memory than the 150 MB that are allowed (--memory,",
                {"--memory", "150M"});
  // A file with more bytes than the memory limit; only the first bytes are written, the rest is a
  // hole.
  writeText(dir_ / "large.glb", std::string("glTF\2\0\0\0", 8));
  std::filesystem::resize_file(dir_ / "large.glb", std::size_t{101} << 20);
  const Outcome outcome = run(
      {kMerlin, "mesh", "import", dir_ / "large.glb", "-o", dir_ / "x.ply", "--memory", "100M"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("large.glb: reading it takes more memory than the 100 MB that are "
                                "allowed (--memory, by default the free memory)"),
            std::string::npos)
      << outcome.output;
#endif
}

}  // namespace
}  // namespace merlin::test
