#include "render/import/gltf_values.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "render/import/gltf_json.h"
#include "render/mesh/io/feature_names.h"

namespace merlin::render::import {
namespace {

using nlohmann::json;

constexpr std::uint64_t kComponentFloat = 5126;  // componentType

// The element of that number; null if there is none.
const json* elementOf(const json* array, std::optional<std::uint64_t> number) {
  const bool there = array && array->is_array() && number && *number < array->size();
  return there ? &(*array)[*number] : nullptr;
}

std::optional<std::uint64_t> unsignedOf(const json& object, const char* name) {
  const json* found = memberOf(object, name);
  if (!found || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::uint64_t>();
}

// The same as unsignedOf() for byteOffset, but 0 if there is no such member.
std::optional<std::uint64_t> offsetOf(const json& object) {
  return memberOf(object, "byteOffset") ? unsignedOf(object, "byteOffset") : std::uint64_t{0};
}

bool isString(const json& object, const char* name, std::string_view text) {
  const json* found = memberOf(object, name);
  return found && found->is_string() && found->get_ref<const std::string&>() == text;
}

// The binary chunk, which stands behind the JSON; empty if there is none.
std::string_view binaryChunk(std::string_view glb) {
  constexpr std::size_t kHead = 12, kChunkHead = 8;
  const auto number = [&](std::size_t at) {
    return std::size_t{loadLe32(reinterpret_cast<const std::uint8_t*>(glb.data()) + at)};
  };
  if (glb.size() < kHead + kChunkHead) return {};
  const std::size_t at = kHead + kChunkHead + number(kHead);  // of at most 32 bits
  if (at > glb.size() || glb.size() - at < kChunkHead) return {};
  const std::size_t length = number(at);
  if (glb.substr(at + 4, 4) != std::string_view("BIN\0", 4)) return {};
  if (length > glb.size() - at - kChunkHead) return {};
  return glb.substr(at + kChunkHead, length);
}

class ValueReader {
 public:
  ValueReader(const json& model, std::string_view chunk) : model_(model), chunk_(chunk) {}

  // Returns the bytes of an accessor of floats, `dimension` per element, without gaps; nothing if
  // it is of another kind or goes beyond its view or the chunk.
  std::optional<std::string_view> bytesOf(const json* accessor, const char* type,
                                          std::size_t dimension) const {
    if (!accessor || unsignedOf(*accessor, "componentType") != kComponentFloat ||
        !isString(*accessor, "type", type) || memberOf(*accessor, "sparse"))
      return std::nullopt;
    const auto view = viewOf(*accessor, 4 * dimension);
    const auto offset = offsetOf(*accessor), count = unsignedOf(*accessor, "count");
    if (!view || !offset || !count || *offset > view->size()) return std::nullopt;
    if (*count > (view->size() - *offset) / (4 * dimension)) return std::nullopt;
    return view->substr(*offset, *count * 4 * dimension);
  }

  const json* accessor(const json& index) const {
    if (!index.is_number_unsigned()) return nullptr;
    return elementOf(memberOf(model_, "accessors"), index.get<std::uint64_t>());
  }

 private:
  // Returns the view of an accessor; nothing if there are gaps between its elements of `bytes`
  // bytes.
  std::optional<std::string_view> viewOf(const json& accessor, std::size_t bytes) const {
    const json* view =
        elementOf(memberOf(model_, "bufferViews"), unsignedOf(accessor, "bufferView"));
    if (!view || unsignedOf(*view, "buffer") != std::uint64_t{0}) return std::nullopt;
    if (memberOf(*view, "byteStride") && unsignedOf(*view, "byteStride") != bytes)
      return std::nullopt;
    const auto offset = offsetOf(*view), length = unsignedOf(*view, "byteLength");
    if (!offset || !length || *offset > chunk_.size() || *length > chunk_.size() - *offset)
      return std::nullopt;
    return chunk_.substr(*offset, *length);
  }

  const json& model_;
  std::string_view chunk_;
};

std::vector<float> floatsOf(std::string_view bytes) {
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  std::vector<float> values(bytes.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = loadLeFloat(p + 4 * i);
  return values;
}

// Returns the attributes of the only primitive, shown by one node; null if there are several.
const json* onlyAttributes(const json& model) {
  const auto only = [](const json* array) {
    return array && array->is_array() && array->size() == 1 ? &(*array)[0] : nullptr;
  };
  const json* nodes = memberOf(model, "nodes");
  const auto shows = [](const json& node) { return memberOf(node, "mesh") != nullptr; };
  if (!nodes || !nodes->is_array() || std::count_if(nodes->begin(), nodes->end(), shows) != 1)
    return nullptr;
  const json* mesh = only(memberOf(model, "meshes"));
  const json* primitive = mesh ? only(memberOf(*mesh, "primitives")) : nullptr;
  return primitive ? memberOf(*primitive, "attributes") : nullptr;
}

// Whether the binary chunk is buffer 0.
bool hasChunk(const json& model) {
  const json* buffer = elementOf(memberOf(model, "buffers"), 0);
  return buffer && buffer->is_object() && !memberOf(*buffer, "uri");
}

// Whether MERLIN wrote vertex colours beside a texture, as its own attribute: glTF's vertex colours
// would be multiplied with the texture.
bool hasColoursBesideTexture(const json& model, const json& attributes) {
  const json* asset = memberOf(model, "asset");
  return asset && isString(*asset, "generator", "MERLIN") && memberOf(attributes, "TEXCOORD_0");
}

// Returns how many floats per vertex the feature of an attribute with this name has; 0 if it is no
// feature.
std::size_t dimensionOf(const std::string& name, bool coloured) {
  if (!name.starts_with('_')) return 0;
  const std::string feature = name.substr(1);
  if (feature == "colour") return coloured ? 3 : 0;
  const bool other = feature == "normal" || feature == "texcoord";
  return other || !mesh::featureNameFault(feature).empty() ? 0 : 1;
}

}  // namespace

GltfValues ownValuesOf(const json& model, std::string_view glb) {
  const json* attributes = onlyAttributes(model);
  if (!attributes || !hasChunk(model)) return {};
  const ValueReader reader(model, binaryChunk(glb));
  const json* position = memberOf(*attributes, "POSITION");
  const auto places =
      position ? reader.bytesOf(reader.accessor(*position), "VEC3", 3) : std::nullopt;
  if (!places) return {};
  GltfValues own;
  const bool coloured = hasColoursBesideTexture(model, *attributes);
  for (const auto& [name, index] : attributes->items()) {
    const std::size_t n = dimensionOf(name, coloured);
    if (n == 0) continue;
    const auto bytes = reader.bytesOf(reader.accessor(index), n == 1 ? "SCALAR" : "VEC3", n);
    if (bytes && bytes->size() / n == places->size() / 3)
      own.features.push_back({name.substr(1), n, floatsOf(*bytes)});
  }
  if (!own.features.empty()) own.positions = floatsOf(*places);
  return own;
}

std::vector<std::uint32_t> firstEqualRows(const std::vector<mesh::Feature>& features,
                                          std::size_t rows) {
  const auto less = [&](std::size_t a, std::size_t b) {
    for (const mesh::Feature& f : features) {
      for (std::size_t k = 0; k < f.dimension; ++k) {
        const float x = f.values[a * f.dimension + k], y = f.values[b * f.dimension + k];
        if (x != y) return x < y;
      }
    }
    return false;
  };
  std::vector<std::uint32_t> order(rows), first(rows);
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return less(a, b) || (!less(b, a) && a < b); });
  for (std::size_t i = 0; i < rows; ++i)
    first[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

}  // namespace merlin::render::import
