// Third-party readers read the files that writeMesh() writes, and must find the mesh in them.
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_dir.h"

namespace merlin::render {
namespace {

using test::readText;
using test::TempDir;
using Floats = std::vector<float>;
using Names = std::vector<std::string>;
using Json = nlohmann::json;

// Returns a square with all features: normals that are zero or parallel to an axis, and colours
// that a byte holds exactly.
mesh::Mesh richSquare() {
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.positions[2] = -1.0F / 3;
  mesh.features = {{"normal", 3, {0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 0}},
                   {"colour", 3, {0, 0.2F, 0.4F, 0.6F, 0.8F, 1, 1, 0, 0, 0, 1, 0}},
                   {"texcoord", 2, {0, 0, 1, 0, 0, 0.25F, 1, 1}},
                   {"heat", 1, {20, 21.5F, -3, 1e30F}},
                   {"spectrum", 5, Floats(20, 0.5F)},
                   {"label", 1, {0, 1, 2, 70000}}};
  return mesh;
}

// Writes the mesh to `path`; returns the names of the features that the format could not store.
Names written(const std::string& path, const mesh::Mesh& mesh) {
  const auto result = mesh::writeMesh(path, mesh);
  EXPECT_TRUE(result) << result.error().what;
  return result ? result->left_out : Names{"nothing was written"};
}

struct Traits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Color |
                   OpenMesh::Attributes::TexCoord2D);
  FaceAttributes(OpenMesh::Attributes::Normal);
  using Color = OpenMesh::Vec3f;
};
using Judge = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Judge readByOpenMesh(const std::string& path, OpenMesh::IO::Options options) {
  Judge judge;
  EXPECT_TRUE(OpenMesh::IO::read_mesh(judge, path, options)) << path;
  return judge;
}

Judge::VertexHandle vertex(std::size_t v) { return Judge::VertexHandle(static_cast<int>(v)); }

TEST(ObjWriter, IsReadByOpenMeshWithNormalsColoursAndTextureCoordinates) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  EXPECT_EQ(written(dir / "a.obj", mesh), (Names{"heat", "spectrum", "label"}));
  using O = OpenMesh::IO::Options;
  O options(O::VertexNormal | O::VertexColor | O::VertexTexCoord | O::ColorFloat);
  const Judge judge = readByOpenMesh(dir / "a.obj", options);
  ASSERT_EQ(judge.n_vertices(), 4u);
  ASSERT_EQ(judge.n_faces(), 2u);
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(judge.point(vertex(v))[k], mesh.positions[3 * v + k]);
      EXPECT_EQ(judge.normal(vertex(v))[k], mesh.features[0].values[3 * v + k]);
      EXPECT_EQ(judge.color(vertex(v))[k], mesh.features[1].values[3 * v + k]);
    }
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(judge.texcoord2D(vertex(v))[k], mesh.features[2].values[2 * v + k]);
  }
}

TEST(ObjWriter, NumbersOnlyWhatIsThere) {
  const TempDir dir;
  mesh::Mesh mesh = test::grid(1, 1);
  const auto firstFace = [&] {
    EXPECT_EQ(written(dir / "a.obj", mesh), Names{});
    const std::string text = readText(dir / "a.obj");
    const auto at = text.find("\nf ");
    return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
  };
  EXPECT_EQ(firstFace(), "f 1 2 4");
  mesh.features = {{"normal", 3, Floats(12, 0)}};
  EXPECT_EQ(firstFace(), "f 1//1 2//2 4//4");
  mesh.features = {{"texcoord", 2, Floats(8, 0)}};
  EXPECT_EQ(firstFace(), "f 1/1 2/2 4/4");
}

TEST(StlWriter, IsReadByOpenMeshWithTheFacesNormals) {
  const TempDir dir;
  EXPECT_EQ(written(dir / "a.stl", richSquare()),
            (Names{"normal", "colour", "texcoord", "heat", "spectrum", "label"}));
  EXPECT_EQ(std::filesystem::file_size(dir / "a.stl"), 84u + 2 * 50u);
  EXPECT_EQ(written(dir / "cube.stl", test::cube()), Names{});
  const Judge cube = readByOpenMesh(dir / "cube.stl", OpenMesh::IO::Options::FaceNormal);
  EXPECT_EQ(cube.n_vertices(), 8u) << "OpenMesh joins what is in one place";
  EXPECT_EQ(cube.n_faces(), 12u);
  const std::string bytes = readText(dir / "cube.stl");
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data()) + 84;
  const float expected[] = {0, 0, -1, -1, -1, -1, -1, 1, -1, 1, 1, -1};  // the face 0 2 3
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(loadLeFloat(first + 4 * i), expected[i]) << i;
}

TEST(InventorWriter, HoldsEachNodeWithItsRows) {
  const TempDir dir;
  mesh::Mesh mesh = richSquare();
  EXPECT_EQ(written(dir / "a.iv", mesh), (Names{"heat", "spectrum", "label"}));
  const std::string text = readText(dir / "a.iv");
  EXPECT_TRUE(text.starts_with("#Inventor V2.1 ascii\n"));
  for (const char* part :
       {"Coordinate3 {\n    point [\n      0 0 -0.33333334,\n      1 0 0,\n",
        "Normal {\n    vector [\n      0 0 1,\n      0 1 0,\n",
        "NormalBinding { value PER_VERTEX_INDEXED }",
        "Material {\n    diffuseColor [\n      0 0.2 0.4,\n      0.6 0.8 1,\n",
        "MaterialBinding { value PER_VERTEX_INDEXED }",
        "TextureCoordinate2 {\n    point [\n      0 0,\n      1 0,\n      0 0.25,\n",
        "IndexedFaceSet {\n    coordIndex [\n      0, 1, 3, -1,\n      0, 3, 2, -1,\n    ]\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  mesh.features.clear();
  written(dir / "b.iv", mesh);
  for (const char* node : {"Normal", "Material", "Texture"})
    EXPECT_EQ(readText(dir / "b.iv").find(node), std::string::npos) << node;
}

// A glTF file, decoded as the specification prescribes.
struct Gltf {
  Json json;
  std::string buffer;

  // Returns the values of an accessor, floats or unsigned integers, located as the specification
  // prescribes.
  template <typename T>
  std::vector<T> numbers(std::size_t accessor) const {
    const Json& a = json["accessors"][accessor];
    const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::size_t width = std::map<std::string, std::size_t>{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}[a["type"].get<std::string>()];
    EXPECT_EQ(a["componentType"], (std::is_same_v<T, float> ? 5126 : 5125));
    const std::size_t at = view["byteOffset"], size = view["byteLength"];
    std::vector<T> values(a["count"].get<std::size_t>() * width);
    EXPECT_EQ(at % 4, 0u);
    EXPECT_EQ(size, 4 * values.size());
    EXPECT_LE(at + size, buffer.size());
    EXPECT_FALSE(view.contains("byteStride"));
    if (at + size <= buffer.size()) std::memcpy(values.data(), buffer.data() + at, size);
    return values;
  }
  Floats attribute(const std::string& name) const {
    const Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_TRUE(attributes.contains(name)) << attributes;
    return numbers<float>(attributes[name]);
  }
};

Gltf readGlb(const std::string& path) {
  const std::string bytes = readText(path);
  const auto word = [&](std::size_t at) {
    return std::size_t{loadLe32(reinterpret_cast<const std::uint8_t*>(bytes.data()) + at)};
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  const std::size_t json = word(12);
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(word(20 + json) % 4, 0u);
  EXPECT_EQ(word(20 + json), bytes.size() - 28 - json);
  EXPECT_EQ(bytes.substr(24 + json, 4), std::string("BIN\0", 4));
  return {Json::parse(bytes.substr(20, json)), bytes.substr(28 + json)};
}

// An independent decoder, so that MERLIN's encoder is not tested by MERLIN's decoder.
std::string fromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xFF);
  }
  return bytes;
}

TEST(GltfWriter, FollowsTheSpecification) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  EXPECT_EQ(written(dir / "a.glb", mesh), Names{"spectrum"}) << "5 dimensions";
  const Gltf gltf = readGlb(dir / "a.glb");
  EXPECT_EQ(gltf.json["asset"]["version"], "2.0");
  EXPECT_EQ(gltf.json["buffers"][0]["byteLength"], gltf.buffer.size());
  EXPECT_FALSE(gltf.json["buffers"][0].contains("uri"));
  EXPECT_EQ(gltf.json["scenes"][0]["nodes"], Json::array({0}));
  EXPECT_EQ(gltf.json["nodes"][0]["mesh"], 0);
  EXPECT_EQ(gltf.json["materials"][0]["doubleSided"], true);
  const Json& primitive = gltf.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["mode"], 4);
  EXPECT_EQ(gltf.numbers<std::uint32_t>(primitive["indices"]),
            (std::vector<std::uint32_t>{0, 1, 3, 0, 3, 2}));
  EXPECT_EQ(gltf.attribute("POSITION"), mesh.positions);
  const Json& position =
      gltf.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(position["min"].get<Floats>(), (Floats{0, 0, -1.0F / 3}));
  EXPECT_EQ(position["max"].get<Floats>(), (Floats{1, 1, 0}));
}

TEST(GltfWriter, TurnsFeaturesIntoWhatTheFormatWants) {
  const TempDir dir;
  written(dir / "a.glb", richSquare());
  const Gltf gltf = readGlb(dir / "a.glb");
  EXPECT_EQ(gltf.attribute("NORMAL"), (Floats{0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 1}))
      << "the last was zero, which the format does not allow";
  EXPECT_EQ(gltf.attribute("TEXCOORD_0"), (Floats{0, 1, 1, 1, 0, 0.75F, 1, 0}));
  EXPECT_EQ(gltf.attribute("_heat"), (Floats{20, 21.5F, -3, 1e30F}));
  EXPECT_EQ(gltf.attribute("_label"), (Floats{0, 1, 2, 70000}));
  const Floats colour = gltf.attribute("COLOR_0");
  // Linear values of the sRGB values n / 5.
  const float linear[] = {0, 0.0331048F, 0.1328683F, 0.3185468F, 0.6038273F, 1};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(colour[i], linear[i], 1e-6) << i;
}

TEST(GltfWriter, TakesTheTexturesPictureAlong) {
  const TempDir dir;
  mesh::Mesh mesh = richSquare();
  mesh.texture = {0x89, 'P', 'N', 'G', 7};
  EXPECT_EQ(written(dir / "a.glb", mesh), Names{"spectrum"});
  const Gltf gltf = readGlb(dir / "a.glb");
  const Json& matt = gltf.json["materials"][0]["pbrMetallicRoughness"];
  const Json& texture = gltf.json["textures"][matt["baseColorTexture"]["index"].get<std::size_t>()];
  const Json& image = gltf.json["images"][texture["source"].get<std::size_t>()];
  EXPECT_EQ(image["mimeType"], "image/png");
  const Json& view = gltf.json["bufferViews"][image["bufferView"].get<std::size_t>()];
  EXPECT_EQ(gltf.buffer.substr(view["byteOffset"].get<std::size_t>(),
                               view["byteLength"].get<std::size_t>()),
            "\x89PNG\x07");
  EXPECT_EQ(gltf.json["buffers"][0]["byteLength"], gltf.buffer.size());
  EXPECT_EQ(gltf.buffer.size() % 4, 0u);
  const Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_FALSE(attributes.contains("COLOR_0")) << "glTF would multiply it with the picture's";
  EXPECT_EQ(gltf.attribute("_colour").size(), 12u);
  mesh.texture[0] = 0xFF;
  written(dir / "a.gltf", mesh);
  EXPECT_EQ(Json::parse(readText(dir / "a.gltf"))["images"][0]["mimeType"], "image/jpeg");
  EXPECT_EQ(written(dir / "a.stl", mesh).back(), "the texture image");
}

TEST(GltfWriter, WritesTheSameBytesIntoOneJsonFile) {
  const TempDir dir;
  // These meshes have buffers of every length modulo 3.
  for (const std::uint32_t columns : {1U, 2U, 3U}) {
    const mesh::Mesh mesh = test::noisyGrid(columns, 1, 0.1, 7);
    written(dir / "a.glb", mesh);
    written(dir / "a.gltf", mesh);
    const Gltf glb = readGlb(dir / "a.glb");
    Json json = Json::parse(readText(dir / "a.gltf"));
    const std::string uri = json["buffers"][0]["uri"];
    const std::string scheme = "data:application/octet-stream;base64,";
    ASSERT_TRUE(uri.starts_with(scheme));
    EXPECT_EQ((uri.size() - scheme.size()) % 4, 0u);
    EXPECT_TRUE(fromBase64(uri.substr(scheme.size())) == glb.buffer) << columns;
    json["buffers"][0].erase("uri");
    EXPECT_EQ(json, glb.json);
  }
}

TEST(GltfWriter, KeepsAFeatureWhateverItsName) {
  const TempDir dir;
  mesh::Mesh mesh = test::grid(1, 1);
  mesh.features = {{"data:application/octet-stream;base64,\"\xFF", 1, {1, 2, 3, 4}}};
  written(dir / "a.gltf", mesh);
  const Json json = Json::parse(readText(dir / "a.gltf"));
  const std::string uri = json["buffers"][0]["uri"];
  EXPECT_EQ(fromBase64(uri.substr(uri.find(',') + 1)).size(), 88u);
}

constexpr mesh::Origin kUtm = {500'000, 5'200'000, -0.25};

// Returns the file's coordinates as doubles, with its origin added.
std::vector<double> placed(const mesh::LoadedMesh& loaded) {
  std::vector<double> all;
  for (std::size_t i = 0; i < loaded.mesh.positions.size(); ++i)
    all.push_back(loaded.mesh.positions[i] + loaded.origin[i % 3]);
  return all;
}

TEST(WriteMesh, AnOriginIsAddedAndFoundAgainByTheReaders) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  for (const char* name : {"a.ply", "a.obj"}) {
    const auto done = mesh::writeMesh(dir / name, mesh, kUtm);
    ASSERT_TRUE(done) << done.error().what;
    EXPECT_EQ(done->relative_to, mesh::Origin{}) << name;
    const auto loaded = mesh::readMesh(dir / name);
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->origin, (mesh::Origin{500'000, 5'200'000, 0})) << name;
    const auto found = placed(*loaded);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      EXPECT_NEAR(found[i], mesh.positions[i] + kUtm[i % 3], 1e-7) << name << " " << i;
    const mesh::Feature* const colour = loaded->mesh.find("colour");
    ASSERT_NE(colour, nullptr);
    EXPECT_NEAR(colour->values[4], 0.8, 1e-6) << name << ": what follows the position";
  }
  const std::string ply = readText(dir / "a.ply");
  EXPECT_NE(ply.find("property double x\nproperty double y\nproperty double z\n"
                     "property float nx\n"),
            std::string::npos);
  const std::string obj = readText(dir / "a.obj");
  EXPECT_NE(obj.find("\nv 500000 5200000 -0.583333343"), std::string::npos) << obj;
  EXPECT_NE(obj.find("\nv 500001 5200000 -0.25 "), std::string::npos) << obj;
}

TEST(WriteMesh, WithoutAnOriginThereAreFloatsAsBefore) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  for (const char* name : {"a.ply", "a.obj", "a.glb"}) {
    written(dir / name, mesh);
    ASSERT_TRUE(mesh::writeMesh(dir / "b" + name, mesh, mesh::Origin{}));
    EXPECT_TRUE(readText(dir / name) == readText(dir / "b" + name)) << name;
  }
  EXPECT_NE(readText(dir / "a.ply").find("property float x\n"), std::string::npos);
  EXPECT_NE(readText(dir / "a.obj").find("\nv 0 0 -0.33333334 "), std::string::npos);
  EXPECT_FALSE(readGlb(dir / "a.glb").json["nodes"][0].contains("translation"));
}

TEST(WriteMesh, AnOriginBecomesTheTranslationOfTheGltfNode) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  const mesh::Origin origin = {500'000.125, 5'200'000.0625, -1};
  ASSERT_TRUE(mesh::writeMesh(dir / "a.glb", mesh, origin));
  ASSERT_TRUE(mesh::writeMesh(dir / "a.gltf", mesh, origin));
  const Gltf glb = readGlb(dir / "a.glb");
  EXPECT_EQ(glb.json["nodes"][0]["translation"], Json(origin));
  EXPECT_EQ(glb.json["nodes"][0]["mesh"], 0);
  EXPECT_EQ(glb.attribute("POSITION"), mesh.positions) << "the positions stay floats near 0";
  EXPECT_EQ(Json::parse(readText(dir / "a.gltf"))["nodes"], glb.json["nodes"]);
}

TEST(WriteMesh, AFormatOfFloatsStaysRelativeToTheOrigin) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  for (const char* name : {"a.stl", "a.iv"}) {
    const auto done = mesh::writeMesh(dir / name, mesh, kUtm);
    ASSERT_TRUE(done) << done.error().what;
    EXPECT_EQ(done->relative_to, kUtm) << name;
    written(dir / "b" + name, mesh);
    EXPECT_TRUE(readText(dir / name) == readText(dir / "b" + name)) << name;
  }
}

TEST(PlyWriter, KeepsLabelsAsIntegers) {
  const TempDir dir;
  const mesh::Mesh mesh = richSquare();
  EXPECT_EQ(written(dir / "a.ply", mesh), Names{});
  EXPECT_NE(readText(dir / "a.ply").find("property int label\n"), std::string::npos);
  EXPECT_EQ(mesh::readMesh(dir / "a.ply")->mesh.find("label")->values, (Floats{0, 1, 2, 70000}));
  mesh::Mesh shares = mesh;
  shares.find("label")->values[1] = 0.5F;
  written(dir / "b.ply", shares);
  EXPECT_NE(readText(dir / "b.ply").find("property float label\n"), std::string::npos);
}

TEST(WriteMesh, RefusesAnEmptyMeshAndAnUnknownEnding) {
  const TempDir dir;
  for (const char* name : {"a.ply", "a.obj", "a.glb", "a.gltf", "a.stl", "a.iv"}) {
    const auto refused = mesh::writeMesh(dir / name, mesh::Mesh{});
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Errc::kUnsupported);
    EXPECT_EQ(refused.error().what, dir / name + ": the mesh has no triangles; nothing is written");
  }
  EXPECT_EQ(mesh::checkMeshEnding("a.off").error().what,
            "a.off: meshes are written as .ply, .obj, .glb, .gltf, .stl and .iv");
  EXPECT_TRUE(mesh::checkMeshEnding("a/b.STL"));
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

// If a mesh has no texture coordinates, its image is not written. If the image file cannot be
// written, writeMesh() fails.
TEST(WriteMesh, HasAPictureOnlyWhereItLiesSomewhere) {
  const TempDir dir;
  mesh::Mesh mesh = test::cube();
  mesh.texture = {0x89, 'P', 'N', 'G', 7};
  EXPECT_EQ(written(dir / "a.obj", mesh), Names{"the texture image"});
  mesh.features.push_back({"texcoord", 2, Floats(2 * mesh.vertexCount())});
  std::filesystem::create_directory(dir / "b.obj.mtl");
  EXPECT_FALSE(mesh::writeMesh(dir / "b.obj", mesh));
  EXPECT_FALSE(std::filesystem::exists(dir / "b.obj"));
}

TEST(WriteMesh, SaysSoWhereTheFolderIsGone) {
  for (const char* ending : {"ply", "obj", "glb", "gltf", "stl", "iv"}) {
    const auto refused = mesh::writeMesh(std::string("/nowhere/at/all.") + ending, test::cube());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::kNotFound);
  }
}

}  // namespace
}  // namespace merlin::render
