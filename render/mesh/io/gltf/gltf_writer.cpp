// Writes glTF 2.0: .glb (a JSON chunk, a binary chunk) and .gltf (the same bytes in base64 inside
// the JSON, so that it is a single file). Source: Khronos, "glTF 2.0 Specification", 2021, sections
// 3.6, 3.7.2 and 4.4.
//
// The format requires linear colours, unit normals, and texture coordinates from the top left; the
// values are converted. Features without a name in glTF become application-specific attributes
// ("_heat"); so do the colours of a textured mesh, since glTF would multiply the texture by them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;           // componentType
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;  // target
constexpr const char* kPayload = "data:application/octet-stream;base64,";

bool carries(const Mesh&, const Feature& f) { return f.dimension >= 1 && f.dimension <= 4; }

const char* typeOf(std::size_t dimension) {
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return kTypes[dimension];
}

std::string attributeOf(const Feature& f, bool textured) {
  if (!isUsual(f) || (textured && f.name == "colour")) return "_" + f.name;
  return f.name == "normal" ? "NORMAL" : f.name == "colour" ? "COLOR_0" : "TEXCOORD_0";
}

// Converts an sRGB value to a linear one, by the equation of IEC 61966-2-1.
float linearOf(float srgb) {
  const float c = std::clamp(srgb, 0.0F, 1.0F);
  return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

// Converts one row of a usual feature to glTF's conventions.
void adapt(const Feature& f, float* row) {
  if (!isUsual(f)) return;
  if (f.name == "colour") {
    std::transform(row, row + 3, row, linearOf);
  } else if (f.name == "texcoord") {
    row[1] = 1 - row[1];
  } else {
    const float length = std::hypot(row[0], row[1], row[2]);
    const float none[] = {0, 0, 1};  // arbitrary direction that replaces a zero normal
    for (int k = 0; k < 3; ++k) row[k] = length > 0 ? row[k] / length : none[k];
  }
}

// Rounds a size up, because chunks and views begin at multiples of 4 bytes.
std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

// Returns the size of the buffer in bytes. The buffer holds, in this order: positions, features and
// corners, with 4 bytes per number; then the picture, padded to a multiple of 4.
std::uint64_t bytesIn(const Mesh& mesh) {
  std::uint64_t numbers = mesh.positions.size() + mesh.triangles.size();
  for (const Feature& f : mesh.features) numbers += carries(mesh, f) ? f.values.size() : 0;
  return 4 * numbers + (isTextured(mesh) ? padded(mesh.texture.size()) : 0);
}

class Document {
 public:
  // `origin` becomes the node's translation.
  Document(const Mesh& mesh, const Origin& origin) : mesh_(mesh) {
    if (origin != Origin{}) node_["translation"] = origin;
    const Box box = boundingBox(mesh.positions);
    Json& position = add("POSITION", 3);
    position["min"] = box.low;
    position["max"] = box.high;
    for (const Feature& f : mesh.features) {
      if (carries(mesh, f)) add(attributeOf(f, isTextured(mesh)), f.dimension);
    }
    addView(mesh.triangles.size(), kIndexBuffer);
    accessors_.push_back({{"bufferView", accessors_.size()},
                          {"componentType", kUnsignedInt},
                          {"count", mesh.triangles.size()},
                          {"type", "SCALAR"}});
    if (!isTextured(mesh)) return;
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", mesh.texture.size()}});
    bytes_ = bytesIn(mesh);
  }

  // Returns the JSON document. `uri`: URI of the buffer; empty if the buffer is the binary chunk of
  // a .glb file.
  std::string text(const std::string& uri) const {
    Json buffer = {{"byteLength", bytes_}};
    if (!uri.empty()) buffer["uri"] = uri;
    const Json primitive = {{"attributes", attributes_},
                            {"indices", accessors_.size() - 1},
                            {"material", 0},
                            {"mode", 4}};
    Json matt = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (isTextured(mesh_)) matt["baseColorTexture"] = {{"index", 0}};
    Json document = {{"asset", {{"version", "2.0"}, {"generator", "MERLIN"}}},
                     {"scene", 0},
                     {"scenes", {{{"nodes", {0}}}}},
                     {"nodes", Json::array({node_})},
                     {"meshes", {{{"primitives", {primitive}}}}},
                     {"materials", {{{"pbrMetallicRoughness", matt}, {"doubleSided", true}}}},
                     {"buffers", {buffer}},
                     {"bufferViews", views_},
                     {"accessors", accessors_}};
    if (isTextured(mesh_)) {
      document["images"] =
          Json::array({{{"bufferView", views_.size() - 1},
                        {"mimeType", isPng(mesh_.texture) ? "image/png" : "image/jpeg"}}});
      document["textures"] = Json::array({{{"source", 0}}});
    }
    return document.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

 private:
  Json& add(const std::string& attribute, std::size_t dimension) {
    attributes_[attribute] = accessors_.size();
    addView(mesh_.vertexCount() * dimension, kVertexBuffer);
    accessors_.push_back({{"bufferView", accessors_.size()},
                          {"componentType", kFloat},
                          {"count", mesh_.vertexCount()},
                          {"type", typeOf(dimension)}});
    return accessors_.back();
  }

  void addView(std::uint64_t numbers, int target) {
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", 4 * numbers}, {"target", target}});
    bytes_ += 4 * numbers;
  }

  const Mesh& mesh_;
  std::uint64_t bytes_ = 0;
  Json node_ = {{"mesh", 0}};
  Json attributes_ = Json::object(), views_ = Json::array(), accessors_ = Json::array();
};

bool writeBuffer(const Mesh& mesh, const WriteBytes& bytes) {
  std::string row;
  const auto put = [&] { return bytes(std::as_bytes(std::span(row))); };
  for (const float x : mesh.positions) {
    row.clear();
    appendLeFloat(row, x);
    if (!put()) return false;
  }
  for (const Feature& f : mesh.features) {
    if (!carries(mesh, f)) continue;
    for (std::size_t i = 0; i < f.values.size(); i += f.dimension) {
      float values[4];
      std::copy_n(&f.values[i], f.dimension, values);
      adapt(f, values);
      row.clear();
      for (std::size_t k = 0; k < f.dimension; ++k) appendLeFloat(row, values[k]);
      if (!put()) return false;
    }
  }
  for (const std::uint32_t v : mesh.triangles) {
    row.clear();
    appendLe32(row, v);
    if (!put()) return false;
  }
  if (!isTextured(mesh)) return true;
  row.assign(mesh.texture.begin(), mesh.texture.end());
  row.resize(padded(row.size()));
  return put();
}

std::string jsonChunk(const Mesh& mesh, const Origin& origin) {
  std::string json = Document(mesh, origin).text("");
  json.resize(padded(json.size()), ' ');
  return json;
}

std::uint64_t glbSize(const Mesh& mesh, const Origin& origin) {
  return 12 + 8 + jsonChunk(mesh, origin).size() + 8 + bytesIn(mesh);
}

Result<Ok> fitsGlb(const Mesh& mesh, const Origin& origin) {
  const std::uint64_t size = glbSize(mesh, origin);
  if (size <= 0xFFFFFFFF) return Ok{};
  return Error{
      Errc::kUnsupported,
      fmt::format("{} bytes, but a .glb file has at most 4 GiB; write .gltf or .ply", size)};
}

bool writeGlb(const Mesh& mesh, const Origin& origin, const std::string&, const WriteBytes& bytes) {
  const std::string json = jsonChunk(mesh, origin);
  std::string head = "glTF";
  appendLe32(head, 2);
  appendLe32(head, static_cast<std::uint32_t>(glbSize(mesh, origin)));
  appendLe32(head, static_cast<std::uint32_t>(json.size()));
  head += "JSON" + json;
  appendLe32(head, static_cast<std::uint32_t>(bytesIn(mesh)));
  head += std::string("BIN\0", 4);
  return bytes(std::as_bytes(std::span(head))) && writeBuffer(mesh, bytes);
}

// Encodes bytes, passed in portions of any size, as base64 (RFC 4648).
class Base64 {
 public:
  explicit Base64(const WriteBytes& bytes) : bytes_(bytes) {}

  bool put(std::span<const std::byte> more) {
    for (const std::byte b : more) {
      pending_ = pending_ << 8 | std::to_integer<std::uint32_t>(b);
      if (++count_ == 3) encode(0);
    }
    return text_.size() < kBlock || flush();
  }
  bool finish() {
    if (count_ > 0) {
      const unsigned missing = 3 - count_;
      pending_ <<= 8 * missing;
      encode(missing);
    }
    return flush();
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;

  void encode(unsigned missing) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (unsigned k = 0; k < 4; ++k)
      text_ += k + missing < 4 ? kDigits[pending_ >> (18 - 6 * k) & 63] : '=';
    pending_ = count_ = 0;
  }
  bool flush() {
    const bool taken = bytes_(std::as_bytes(std::span(text_)));
    text_.clear();
    return taken;
  }

  const WriteBytes& bytes_;
  std::string text_;
  std::uint32_t pending_ = 0;
  unsigned count_ = 0;
};

bool writeGltf(const Mesh& mesh, const Origin& origin, const std::string&,
               const WriteBytes& bytes) {
  const std::string json = Document(mesh, origin).text(kPayload);
  // The search includes the quotes of the key, which no feature name can imitate: quotes in names
  // are escaped.
  const std::string uri = fmt::format("\"uri\":\"{}", kPayload);
  const std::size_t cut = json.find(uri) + uri.size();
  const auto put = [&](std::string_view text) { return bytes(std::as_bytes(std::span(text))); };
  if (!put(std::string_view(json).substr(0, cut))) return false;
  Base64 base64(bytes);
  return writeBuffer(mesh, [&](std::span<const std::byte> b) { return base64.put(b); }) &&
         base64.finish() && put(std::string_view(json).substr(cut)) && put("\n");
}

}  // namespace

const MeshWriter kGlbWriter{"glb", carries, writeGlb, PicturePlace::kInside, true, fitsGlb};
const MeshWriter kGltfWriter{"gltf", carries, writeGltf, PicturePlace::kInside, true};

}  // namespace merlin::render::mesh
