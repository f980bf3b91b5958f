// `merlin mesh import` of glTF files that assimp alone would read wrongly, and of files that refer
// to other files. The test makes all files.
#include <bit>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/bytes.h"
#include "render/image/png_writer.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string floats(const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) appendLe32(bytes, std::bit_cast<std::uint32_t>(value));
  return bytes;
}

std::string shorts(const std::vector<unsigned>& values) {
  std::string bytes;
  for (const unsigned value : values) {
    bytes.push_back(static_cast<char>(value & 0xFF));
    bytes.push_back(static_cast<char>(value >> 8));
  }
  return bytes;
}

// The buffer of a triangle with texture coordinates as floats: 80 bytes. The function returns the
// triangle's JSON, which names the file `buffer` as its buffer.
const std::string kTriangle = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + shorts({0, 1, 2, 0}) +
                              floats({0, 0, 1, 0, 0, 1}) + std::string(12, '\0');
Json triangle(const std::string& buffer, const std::string& texture = {}) {
  Json json = {{"asset", {{"version", "2.0"}}},
               {"buffers", {{{"byteLength", 80}, {"uri", buffer}}}},
               {"bufferViews",
                {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}},
                 {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 6}},
                 {{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 24}}}},
               {"accessors",
                {{{"bufferView", 0},
                  {"componentType", 5126},
                  {"count", 3},
                  {"type", "VEC3"},
                  {"min", {0, 0, 0}},
                  {"max", {1, 1, 0}}},
                 {{"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}},
                 {{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}}},
               {"meshes",
                {{{"primitives",
                   {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}}}}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"scenes", {{{"nodes", {0}}}}},
               {"scene", 0}};
  if (texture.empty()) return json;
  json["images"] = {{{"uri", texture}}};
  json["textures"] = {{{"source", 0}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  json["meshes"][0]["primitives"][0]["material"] = 0;
  return json;
}

// Returns the triangle as a GLB file, with the buffer inside.
std::string glb(Json json) {
  json["buffers"][0].erase("uri");
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  for (const std::size_t n : {std::size_t{2}, 12 + 8 + text.size() + 8 + 80, text.size()})
    appendLe32(file, static_cast<std::uint32_t>(n));
  file += "JSON" + text;
  appendLe32(file, 80);
  return file + std::string("BIN\0", 4) + kTriangle;
}

class GltfImport : public testing::Test {
 protected:
  void SetUp() override { writeText(dir_ / "a.bin", kTriangle); }
  Outcome import(const std::string& content, const std::string& name = "a.gltf") {
    writeText(dir_ / name, content);
    return run({kMerlin, "mesh", "import", dir_ / name, "-o", out_, "--json"});
  }
  Json report(const std::string& content, const std::string& name = "a.gltf") {
    const Outcome done = import(content, name);
    EXPECT_EQ(done.status, 0) << done.output;
    const auto start = done.output.find("{\"input\"");
    return start == std::string::npos ? Json() : Json::parse(done.output.substr(start));
  }
  void expectRefused(const std::string& content, const std::string& why) {
    const Outcome done = import(content);
    EXPECT_EQ(done.status, 2) << done.output;
    EXPECT_NE(done.output.find("a.gltf: " + why), std::string::npos) << done.output;
    EXPECT_FALSE(fs::exists(out_));
  }
  void picture(const std::string& name) {
    const std::vector<std::uint8_t> red = {255, 0, 0, 255};
    ASSERT_TRUE(render::image::writePng(dir_ / name, 1, 1, red));
  }

  TempDir dir_;
  std::string out_ = dir_ / "out.ply";
};

TEST_F(GltfImport, WhatIsNoFloatIsRefusedWithTheWayOut) {
  for (const auto& [name, accessor] : {std::pair("POSITION", 0U), std::pair("TEXCOORD_0", 2U)}) {
    Json quantised = triangle("a.bin");
    quantised["accessors"][accessor]["componentType"] = 5123;
    quantised["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::string why = fmt::format(
        "mesh 0, primitive 0: {} is quantised (accessor {} has componentType 5123); only floats "
        "(5126) are read: export the model without quantisation, or convert it: gltfpack -noq -i "
        "IN -o OUT.glb",
        name, accessor);
    expectRefused(quantised.dump(), why);
    expectRefused(glb(quantised), why);
  }
  Json normals = triangle("a.bin");
  normals["accessors"].push_back(normals["accessors"][1]);
  normals["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = 3;
  expectRefused(normals.dump(), "mesh 0, primitive 0: WEIGHTS_0 is quantised");
}

TEST_F(GltfImport, AByteOrderMarkIsPassedOver) {
  EXPECT_EQ(report("\xEF\xBB\xBF" + triangle("a.bin").dump())["triangles"], 1);
}

TEST_F(GltfImport, ARequiredExtensionIsReadOrNamed) {
  Json json = triangle("a.bin");
  json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_unlit"};
  EXPECT_EQ(report(json.dump())["triangles"], 1);
  EXPECT_EQ(report(glb(json))["triangles"], 1);
  fs::remove(out_);
  json["extensionsRequired"].push_back("EXT_whatever");
  expectRefused(json.dump(), "requires the glTF extension EXT_whatever, which is not read; ");
  expectRefused(glb(json), "requires the glTF extension EXT_whatever, which is not read; ");
}

TEST_F(GltfImport, ASimulatedScannerTakesWhatAnImportReads) {
  writeText(dir_ / "a.gltf", triangle("a.bin").dump());
  const std::string scan = dir_ / "scan.pgm";
  const auto taken = [&](const std::string& model) {
    return run({kMerlin,   "mesh", "scan",     model, "--camera", "0.2", "0.2",
                "2",       "0.2",  "0.2",      "0",   "--angles", "10",  "10",
                "--width", "8",    "--height", "8",   "-o",       scan,  "--json"});
  };
  const Outcome done = taken(dir_ / "a.gltf");
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("\"returns\":64"), std::string::npos) << done.output;
  const Outcome info = run({kMerlin, "mesh", "info", scan, "--json"});
  EXPECT_NE(info.output.find("\"unit\":\"m\""), std::string::npos) << info.output;
  const Outcome image = taken(scan);
  EXPECT_EQ(image.status, 2);
  EXPECT_NE(image.output.find("is an input"), std::string::npos) << image.output;
  fs::copy_file(scan, dir_ / "other.pgm");
  EXPECT_NE(
      taken(dir_ / "other.pgm").output.find("is a range image or a map already; merlin mesh "),
      std::string::npos);
}

TEST_F(GltfImport, AMaterialsColourIsMultipliedWithItsTexture) {
  const std::vector<std::uint8_t> grey = {255, 128, 0, 255};
  ASSERT_TRUE(render::image::writePng(dir_ / "a.png", 1, 1, grey));
  Json json = triangle("a.bin", "a.png");
  json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.2158605, 1, 1, 1};
  ASSERT_EQ(report(json.dump())["triangles"], 1);
  const Outcome info = run({kMerlin, "mesh", "info", out_, "--json"});
  const Json said = Json::parse(info.output.substr(info.output.find('{')));
  for (const auto& f : said["features"]) {
    if (f["name"] != "colour") continue;
    EXPECT_NEAR(f["range"][1], 128 / 255.0, 0.003) << "0.2158605 of the light is half of the value";
    EXPECT_EQ(f["range"][0], 0);
    return;
  }
  ADD_FAILURE() << said["features"];
}

// Returns the largest red, green and blue of all vertices of a PLY file, 0 to 255; -1 if it has no
// colours.
std::array<int, 3> colourOf(const std::string& ply) {
  const std::string kEnd = "end_header\n";
  if (ply.find("property uchar red") == std::string::npos) return {-1, -1, -1};
  std::array<int, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = static_cast<unsigned char>(ply[ply.find(kEnd) + kEnd.size() + 12 + k]);
  return colour;
}

// Adds vertex colours, which are the first floats of the buffer, to the triangle.
Json coloured(Json json, const Json& factor) {
  json["accessors"].push_back(
      {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 3;
  json["meshes"][0]["primitives"][0]["material"] = 0;
  json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = factor;
  return json;
}

TEST_F(GltfImport, AMaterialsColourIsMultipliedWithThoseOfTheVertices) {
  // White vertex colours, stored as bytes in the last 12 bytes of the buffer.
  std::string buffer = kTriangle;
  std::fill(buffer.end() - 12, buffer.end(), '\xff');
  writeText(dir_ / "white.bin", buffer);
  Json json = coloured(triangle("white.bin"), {0, 0.5, 0, 1});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 68}, {"byteLength", 12}});
  json["accessors"][3] = {{"bufferView", 3},
                          {"componentType", 5121},
                          {"normalized", true},
                          {"count", 3},
                          {"type", "VEC4"}};
  report(json.dump());
  EXPECT_EQ(colourOf(readText(out_)), (std::array{0, 188, 0}));
}

TEST_F(GltfImport, ColoursThatATextureIsNotMultipliedWithAreSaid) {
  picture("t.png");
  const std::string left = "left out: the vertices' colours of 1 parts";
  const Json json = coloured(triangle("a.bin", "t.png"), {1, 1, 1, 1});
  EXPECT_NE(report(json.dump())["notes"].dump().find(left), std::string::npos);
  EXPECT_EQ(report(triangle("a.bin", "t.png").dump())["notes"].dump().find(left),
            std::string::npos);
}

TEST_F(GltfImport, TheDiffuseColourOfSpecularGlossinessIsRead) {
  Json json = triangle("a.bin");
  json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  json["meshes"][0]["primitives"][0]["material"] = 0;
  json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = {
      1, 0, 0, 1};
  report(json.dump());
  EXPECT_EQ(colourOf(readText(out_)), (std::array{255, 0, 0}));
}

TEST_F(GltfImport, TheDiffuseTextureOfSpecularGlossinessIsMultipliedWithItsColour) {
  const std::vector<std::uint8_t> white = {255, 255, 255, 255};
  ASSERT_TRUE(render::image::writePng(dir_ / "white.png", 1, 1, white));
  Json json = triangle("a.bin", "white.png");
  json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  json["materials"][0] = {
      {"extensions",
       {{"KHR_materials_pbrSpecularGlossiness",
         {{"diffuseFactor", {0, 0.5, 0, 1}}, {"diffuseTexture", {{"index", 0}}}}}}}};
  EXPECT_GT(report(json.dump())["texture_bytes"], 60);
  EXPECT_EQ(colourOf(readText(out_)), (std::array{0, 188, 0}));
}

TEST_F(GltfImport, AnIndexOutOfRangeIsRefused) {
  // Six indices at the end of the buffer; the last one is out of range.
  writeText(dir_ / "bad.bin", kTriangle.substr(0, 68) + shorts({0, 1, 2, 0, 1, 9}));
  Json json = triangle("bad.bin");
  json["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 68}, {"byteLength", 12}};
  json["accessors"][1]["count"] = 6;
  Json& primitives = json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[0].erase("indices");
  expectRefused(json.dump(),
                "glTF: mesh 0, primitive 1: 1 of its 2 triangles have an index beyond "
                "its 3 vertices");
  primitives[1]["mode"] = 5;
  expectRefused(json.dump(),
                "glTF: mesh 0, primitive 1: 1 of its 4 triangles have an index beyond "
                "its 3 vertices");
}

TEST_F(GltfImport, NodesMayShowMeshesInAnyOrder) {
  writeText(dir_ / "two.bin", kTriangle.substr(0, 68) + shorts({0, 1, 2, 0, 2, 1}));
  Json json = triangle("two.bin");
  json["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", 68}, {"byteLength", 12}};
  json["accessors"][1]["count"] = 6;
  json["meshes"].push_back(json["meshes"][0]);
  // a single triangle, whereas the first mesh has two
  json["meshes"][1]["primitives"][0].erase("indices");
  json["nodes"] = {{{"mesh", 1}}, {{"mesh", 0}, {"translation", {0, 0, 1}}}};
  json["scenes"] = {{{"nodes", {0, 1}}}};
  json["scene"] = 0;
  const Json made = report(json.dump());
  EXPECT_EQ(made["parts"], 2) << made;
}

TEST_F(GltfImport, OnlyMotionsThatAreThereAreSaidToBeLeftOut) {
  Json json = triangle("a.bin");
  json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  EXPECT_EQ(report(json.dump())["notes"], (Json{"left out: morph targets; this is the rest pose"}));
}

TEST_F(GltfImport, ValuesThatGltfDoesNotDefineAreSaidToBeLeftOut) {
  Json json = triangle("a.bin");
  Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  attributes["_CONFIDENCE"] = 0;
  attributes["_thermal"] = 0;
  EXPECT_EQ(report(json.dump())["notes"],
            (Json{"left out: vertex attributes that glTF does not define (_CONFIDENCE, "
                  "_thermal); a PLY file keeps such values as features"}));
  for (char c = 'a'; c < 'i'; ++c) attributes[std::string("_") + c] = 0;
  EXPECT_NE(report(json.dump())["notes"].dump().find("_f, _g and 2 others)"), std::string::npos);
}

// Three triangles. At (1, 0, 0) are two vertices with different heat, at (0, 1, 0) two identical
// ones.
constexpr const char* kHot =
    "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float "
    "z\nproperty float heat\nproperty float confidence\nelement face 3\nproperty list uchar int "
    "vertex_indices\nend_header\n0 0 0 -4.5 1\n1 0 0 20.25 1\n0 1 0 3 0.5\n1 0 0 21 1\n2 0 0 9 0\n"
    "0 1 0 3 0.5\n-1 0 0 7 1\n2 1 0 8 1\n3 0 1 2\n3 0 5 6\n3 3 4 7\n";

TEST_F(GltfImport, ValuesThatMerlinWroteComeBack) {
  writeText(dir_ / "hot.ply", kHot);
  ASSERT_EQ(run({kMerlin, "mesh", "export", dir_ / "hot.ply", "-o", dir_ / "a.glb"}).status, 0);
  const Outcome done = run({kMerlin, "mesh", "import", dir_ / "a.glb", "-o", out_, "--json"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output.find("left out"), std::string::npos) << done.output;
  const auto loaded = render::mesh::readMesh(out_);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const render::mesh::Mesh& mesh = loaded->mesh;
  ASSERT_EQ(mesh.vertexCount(), 7U) << "those that are alike are one again";
  const auto* heat = mesh.find("heat");
  const auto* confidence = mesh.find("confidence");
  ASSERT_TRUE(heat && confidence);
  EXPECT_EQ(heat->values, (std::vector<float>{-4.5, 20.25, 3, 7, 21, 9, 8}));
  EXPECT_EQ(confidence->values, (std::vector<float>{1, 1, 0.5, 1, 1, 0, 1}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4, 5, 6}));
}

TEST_F(GltfImport, ValuesInBase64ComeBackToo) {
  writeText(dir_ / "hot.ply", kHot);
  ASSERT_EQ(run({kMerlin, "mesh", "export", dir_ / "hot.ply", "-o", dir_ / "a.gltf"}).status, 0);
  const Outcome done = run({kMerlin, "mesh", "import", dir_ / "a.gltf", "-o", out_, "--json"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output.find("left out"), std::string::npos) << done.output;
  const auto loaded = render::mesh::readMesh(out_);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const auto* heat = loaded->mesh.find("heat");
  ASSERT_TRUE(heat);
  EXPECT_EQ(heat->values, (std::vector<float>{-4.5, 20.25, 3, 7, 21, 9, 8}));
}

TEST_F(GltfImport, ColoursThatMerlinWroteBesideATextureComeBack) {
  picture("red.png");
  writeText(dir_ / "a.mtl", "newmtl m\nmap_Kd red.png\n");
  writeText(dir_ / "a.obj",
            "mtllib a.mtl\nusemtl m\nv 0 0 0 0 0.4 1\nv 1 0 0 0 0.4 1\nv 0 1 0 0 0.4 1\nvt 0 0\nvt "
            "1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  ASSERT_EQ(run({kMerlin, "mesh", "export", dir_ / "a.obj", "-o", dir_ / "a.glb"}).status, 0);
  const Outcome done = run({kMerlin, "mesh", "import", dir_ / "a.glb", "-o", out_, "--json"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output.find("left out"), std::string::npos) << done.output;
  EXPECT_EQ(colourOf(readText(out_)), (std::array{0, 102, 255}));
}

// Returns the triangle's JSON with the attribute _heat; its values are three floats of the texture
// coordinates.
Json hotTriangle() {
  Json json = triangle("");
  json["meshes"][0]["primitives"][0]["attributes"]["_heat"] = 3;
  json["accessors"].push_back(
      {{"bufferView", 3}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 36}});
  return json;
}

TEST_F(GltfImport, ValuesBeyondTheBinaryChunkAreLeftOut) {
  const auto said = [&](const Json& json) { return report(glb(json), "a.glb")["notes"].dump(); };
  EXPECT_EQ(said(hotTriangle()), "[]");
  const Json huge = std::uint64_t{0xFFFFFFFFFFFFFFFC};
  const std::pair<const char*, Json> faults[] = {
      {"/accessors/3/count", 2},
      {"/accessors/3/count", 10},
      {"/accessors/3/count", huge},
      {"/accessors/3/count", -3},
      {"/accessors/3/byteOffset", 28},
      {"/accessors/3/byteOffset", huge},
      {"/accessors/3/byteOffset", "0"},
      {"/accessors/3/type", "VEC2"},
      {"/accessors/3/componentType", 5125},
      {"/accessors/3/sparse", Json::object()},
      {"/accessors/3/bufferView", 4},
      {"/accessors/3/bufferView", huge},
      {"/bufferViews/3/byteOffset", 48},
      {"/bufferViews/3/byteOffset", huge},
      {"/bufferViews/3/byteLength", 37},
      {"/bufferViews/3/byteLength", huge},
      {"/bufferViews/3/byteLength", 8},
      {"/bufferViews/3/byteStride", 8},
      {"/bufferViews/3/buffer", 1},
      {"/meshes/0/primitives/0/attributes/_heat", 4},
      {"/meshes/0/primitives/0/attributes/_heat", "3"},
  };
  for (const auto& [pointer, value] : faults) {
    Json json = hotTriangle();
    json[Json::json_pointer(pointer)] = value;
    EXPECT_NE(said(json).find("that glTF does not define (_heat)"), std::string::npos)
        << pointer << " " << value;
  }
}

// Returns the JSON and the buffer, a.bin, of two triangles at z = 0 and z = 1, in two meshes with
// the attribute _heat.
Json twoHotTriangles() {
  Json json = triangle("a.bin");
  std::string bin = kTriangle;
  const auto add = [&](const std::vector<float>& numbers, int dimension) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", 4 * numbers.size()}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", numbers.size() / static_cast<std::size_t>(dimension)},
                                 {"type", dimension == 3 ? "VEC3" : "SCALAR"}});
    for (const float x : numbers) appendLeFloat(bin, x);
    return json["accessors"].size() - 1;
  };
  Json second = json["meshes"][0];
  json["meshes"][0]["primitives"][0]["attributes"]["_heat"] = add({1, 2, 3}, 1);
  auto& attributes = second["primitives"][0]["attributes"];
  attributes["POSITION"] = add({0, 0, 1, 1, 0, 1, 0, 1, 1}, 3);
  json["accessors"].back()["min"] = {0, 0, 1};
  json["accessors"].back()["max"] = {1, 1, 1};
  attributes["_heat"] = add({4, 5, 6}, 1);
  json["meshes"].push_back(second);
  json["nodes"].insert(json["nodes"].begin(), Json{{"mesh", 1}});  // shown first
  json["scenes"] = {{{"nodes", Json::array()}}};
  for (std::size_t n = 0; n < json["nodes"].size(); ++n) json["scenes"][0]["nodes"].push_back(n);
  json["buffers"][0]["byteLength"] = bin.size();
  return Json::array({json, bin});
}

TEST_F(GltfImport, ValuesOfSeveralMeshesAreKeptIfAllHaveThem) {
  const Json made = twoHotTriangles();
  writeText(dir_ / "a.bin", made[1].get<std::string>());
  EXPECT_EQ(report(made[0].dump())["notes"].dump(), "[]");
  const auto loaded = render::mesh::readMesh(out_);
  ASSERT_TRUE(loaded) << loaded.error().what;
  const auto* heat = loaded->mesh.find("heat");
  ASSERT_TRUE(heat);
  ASSERT_EQ(heat->values.size(), 6U);
  for (std::size_t v = 0; v < 6; ++v) {
    const float* at = &loaded->mesh.positions[3 * v];
    EXPECT_EQ(heat->values[v], 1 + 3 * at[2] + at[0] + 2 * at[1]) << "vertex " << v;
  }
}

TEST_F(GltfImport, ValuesThatNotAllMeshesHaveAreNamed) {
  const Json made = twoHotTriangles();
  writeText(dir_ / "a.bin", made[1].get<std::string>());
  const auto expectNote = [&](const Json& json) {
    EXPECT_NE(report(json.dump())["notes"].dump().find("that glTF does not define (_heat)"),
              std::string::npos)
        << json;
    const auto loaded = render::mesh::readMesh(out_);
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->mesh.find("heat"), nullptr);
  };
  Json one = made[0];
  one["meshes"][1]["primitives"][0]["attributes"].erase("_heat");
  expectNote(one);
  // Both triangles are at the same places, so that nobody can tell which of them assimp returns.
  Json same = made[0];
  same["meshes"][1]["primitives"][0]["attributes"]["POSITION"] =
      same["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  expectNote(same);
  same["meshes"][1]["primitives"][0]["attributes"].erase("_heat");
  expectNote(same);
  Json missing = made[0];
  missing["buffers"].push_back({{"uri", "none.bin"}, {"byteLength", 12}});
  for (const std::size_t view : {3U, 5U}) missing["bufferViews"][view]["buffer"] = 1;
  writeText(dir_ / "none.bin", std::string(8, 'x'));  // shorter than its views
  expectNote(missing);
}

TEST_F(GltfImport, FaultsOfItsJsonAreSaid) {
  const std::string text = triangle("a.bin").dump();
  expectRefused(text.substr(0, text.size() - 9), "glTF: its JSON is damaged or cut");
  const auto with = [](const char* pointer, const Json& value) {
    Json json = triangle("a.bin");
    json[Json::json_pointer(pointer)] = value;
    return json.dump();
  };
  expectRefused(with("/extensionsRequired", 3), "glTF: extensionsRequired is not an array");
  expectRefused(with("/extensionsRequired", {3}),
                "glTF: extensionsRequired has an entry that is not a name");
  expectRefused(with("/accessors", 3), "glTF: accessors is not an array");
  expectRefused(with("/meshes/0/primitives", "x"), "glTF: primitives is not an array");
  expectRefused(with("/meshes/0/primitives/0/attributes", 1),
                "glTF: mesh 0, primitive 0 has no attributes");
  for (const Json& index : {Json(3), Json(-1), Json("0"), Json(0.0)})
    expectRefused(with("/meshes/0/primitives/0/attributes/POSITION", index),
                  "glTF: mesh 0, primitive 0: POSITION names no accessor; there are 3");
  expectRefused(with("/accessors/0/componentType", "5126"),
                "glTF: accessor 0 has no componentType");
  expectRefused(glb(triangle("")).substr(0, 15), "glTF: is cut in its first 20 bytes");
  expectRefused(glb(triangle("")).substr(0, 90), "glTF: its first chunk has ");
}

TEST_F(GltfImport, FilesMayBeNamedAsUris) {
  writeText(dir_ / "my scene.bin", kTriangle);
  picture("r\xC3\xB6t.png");
  const auto json = report(triangle("my%20scene.bin", "r%C3%B6t.png").dump());
  EXPECT_EQ(json["triangles"], 1);
  EXPECT_GT(json["texture_bytes"], 60) << json;
  picture("a%20b.png");
  EXPECT_GT(report(triangle("a.bin", "a%20b.png").dump())["texture_bytes"], 60)
      << "as it is written";
}

TEST_F(GltfImport, ANameThatIsDecodedDoesNotLeaveTheFolder) {
  picture("above.png");
  fs::create_directory(dir_ / "models");
  writeText(dir_ / "models/a.bin", kTriangle);
  for (const char* name : {"%2E%2E/above.png", "..%2Fabove.png", "%2e%2e%5cabove.png"}) {
    const auto json = report(triangle("a.bin", name).dump(), "models/a.gltf");
    EXPECT_EQ(json["texture_bytes"], 0) << name;
    EXPECT_NE(json["notes"].dump().find("models/above.png"), std::string::npos) << json["notes"];
  }
}

TEST_F(GltfImport, FilesInAFolderBesideItAreReadAndOthersAreExplained) {
  fs::create_directories(dir_ / "assets/deep");
  writeText(dir_ / "assets/s.bin", kTriangle);
  picture("assets/t.png");
  picture("assets/deep/t.png");
  const auto json = report(triangle("assets/s.bin", "assets/t.png").dump());
  EXPECT_GT(json["texture_bytes"], 60) << json;
  const auto deep = report(triangle("a.bin", "assets/deep/t.png").dump());
  const std::string notes = deep["notes"].dump();
  if (deep["texture_bytes"] != 0) GTEST_SKIP() << "this system lacks Landlock";
  EXPECT_NE(notes.find("assets/deep/t.png: Permission denied (only visible files in the "
                       "model's folder and in its visible folders are read, 4096 in all; put it "
                       "beside the model); this texture is left out"),
            std::string::npos)
      << notes;
}

TEST_F(GltfImport, ATransformOfTheTextureIsApplied) {
  picture("t.png");
  Json json = triangle("a.bin", "t.png");
  json["extensionsUsed"] = {"KHR_texture_transform"};
  json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform", {{"scale", {0.25, 0.25}}, {"offset", {0.5, 0}}}}};
  report(json.dump());
  const auto info = Json::parse(run({kMerlin, "mesh", "info", out_, "--json"}).output);
  for (const auto& feature : info["features"]) {
    if (feature["name"] != "texcoord") continue;
    // u is 0.5 to 0.75; v, which is counted upwards, is 0.75 to 1.
    EXPECT_NEAR(feature["range"][0], 0.5, 1e-6);
    EXPECT_NEAR(feature["range"][1], 1, 1e-6);
    return;
  }
  FAIL() << info["features"];
}

// A node moves the mesh to the coordinates of a map, where single-precision sums would be rounded
// to steps of 0.5.
TEST_F(GltfImport, AMeshThatANodeMovesToAMapKeepsItsDigitsByAnOrigin) {
  Json json = triangle("a.bin");
  json["nodes"] = {{{"children", {1}}, {"translation", {500000, 0, 0}}},
                   {{"mesh", 0}, {"translation", {0.125, 5200000, 0}}, {"scale", {0.25, 0.25, 1}}}};
  const auto said = report(json.dump());
  EXPECT_EQ(said["origin"], (Json{500000.0, 5200000.0, 0.0})) << said;
  EXPECT_EQ(said["origin_added"], true);
  // the JSON comes after a note
  const Outcome again = run({kMerlin, "mesh", "info", out_, "--json"});
  const Json info = Json::parse(again.output.substr(again.output.find('{')));
  EXPECT_EQ(info["origin"], (Json{500000.0, 5200000.0, 0.0}));
  EXPECT_EQ(info["box"]["low"], (Json{0.125, 0.0, 0.0}));
  EXPECT_EQ(info["box"]["high"], (Json{0.375, 0.25, 0.0}));
}

// A map exported by merlin mesh export is imported at the same place, from each format.
TEST_F(GltfImport, AnExportOfAMapIsImportedAtTheSamePlace) {
  writeText(dir_ / "far.obj",
            "v 500000.125 5200000.25 10\nv 500002.125 5200000.25 10\nv 500002.125 5200002.25 "
            "10.5\nf 1 2 3\n");
  out_ = dir_ / "again.mrm";
  for (const char* name : {"a.glb", "a.gltf", "a.ply", "a.obj"}) {
    const Outcome done = run({kMerlin, "mesh", "export", dir_ / "far.obj", "-o", dir_ / name});
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_NE(done.output.find("origin    500000, 5200000, 0 is added"), std::string::npos)
        << done.output;
    const Outcome back = run({kMerlin, "mesh", "import", dir_ / name, "-o", out_, "--json"});
    ASSERT_EQ(back.status, 0) << back.output;
    const Json info = Json::parse(run({kMerlin, "mesh", "info", out_, "--json"}).output);
    EXPECT_EQ(info["origin"], (Json{500000.0, 5200000.0, 0.0})) << name;
    EXPECT_EQ(info["box"]["low"], (Json{0.125, 0.25, 10.0})) << name;
    EXPECT_EQ(info["box"]["high"], (Json{2.125, 2.25, 10.5})) << name;
  }
}

TEST_F(GltfImport, ARotatedTextureIsLeftAsItIsWithANote) {
  picture("t.png");
  Json json = triangle("a.bin", "t.png");
  json["extensionsUsed"] = {"KHR_texture_transform"};
  json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform", {{"rotation", 1}}}};
  EXPECT_NE(
      report(json.dump())["notes"].dump().find(
          "left out: the rotations of 1 textures, which therefore lie otherwise than in the model"),
      std::string::npos);
}

}  // namespace
}  // namespace merlin::test
