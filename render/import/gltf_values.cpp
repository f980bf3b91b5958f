#include "render/import/gltf_values.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "render/import/companion_path.h"
#include "render/import/gltf_json.h"
#include "render/mesh/io/feature_names.h"

namespace merlin::render::import {
namespace {

using nlohmann::json;

constexpr std::uint64_t kComponentFloat = 5126;  // componentType

// Returns the array's element with this number; null if there is none.
const json* elementOf(const json* array, std::optional<std::uint64_t> number) {
  const bool there = array && array->is_array() && number && *number < array->size();
  return there ? &(*array)[*number] : nullptr;
}

std::optional<std::uint64_t> unsignedOf(const json& object, const char* name) {
  const json* found = memberOf(object, name);
  if (!found || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::uint64_t>();
}

// Returns the member byteOffset of an object; 0 if there is no such member, nothing if it is not an
// unsigned number.
std::optional<std::uint64_t> offsetOf(const json& object) {
  return memberOf(object, "byteOffset") ? unsignedOf(object, "byteOffset") : std::uint64_t{0};
}

bool isString(const json& object, const char* name, std::string_view text) {
  const json* found = memberOf(object, name);
  return found && found->is_string() && found->get_ref<const std::string&>() == text;
}

// Returns the binary chunk of a .glb, which follows the JSON; empty if there is none.
std::string_view binaryChunk(std::string_view glb) {
  constexpr std::size_t kHead = 12, kChunkHead = 8;
  const auto number = [&](std::size_t at) {
    return std::size_t{loadLe32(reinterpret_cast<const std::uint8_t*>(glb.data()) + at)};
  };
  if (glb.size() < kHead + kChunkHead) return {};
  const std::size_t at = kHead + kChunkHead + number(kHead);  // number() has at most 32 bits
  if (at > glb.size() || glb.size() - at < kChunkHead) return {};
  const std::size_t length = number(at);
  if (glb.substr(at + 4, 4) != std::string_view("BIN\0", 4)) return {};
  if (length > glb.size() - at - kChunkHead) return {};
  return glb.substr(at + kChunkHead, length);
}

// Returns the value of a base64 digit (RFC 4648); 64 for any other character.
std::uint32_t digitOf(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint32_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint32_t>(c - 'a' + 26);
  if (c >= '0' && c <= '9') return static_cast<std::uint32_t>(c - '0' + 52);
  return c == '+' ? 62 : c == '/' ? 63 : 64;
}

// Returns the bytes of a URI "data:...;base64,..."; nothing if the text has another form.
std::optional<std::string> decodedUri(std::string_view uri) {
  constexpr std::string_view kCoded = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(kCoded))
    return std::nullopt;
  std::string_view text = uri.substr(comma + 1);
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t pending = 0, bits = 0;
  for (const char c : text) {
    const std::uint32_t digit = digitOf(c);
    if (digit > 63) return std::nullopt;
    pending = (pending << 6 | digit) & 0xFFFF;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(pending >> bits & 0xFF);
  }
  return bytes;
}

class ValueReader {
 public:
  ValueReader(const json& model, GltfBuffers& buffers) : model_(model), buffers_(buffers) {}

  // Returns the bytes of an accessor of floats, `dimension` per element, without gaps; nothing if
  // it has another type, or extends beyond its view or its buffer.
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
  // Returns the bytes of an accessor's buffer view; nothing if there are gaps between its elements,
  // each of `bytes` bytes.
  std::optional<std::string_view> viewOf(const json& accessor, std::size_t bytes) const {
    const json* view =
        elementOf(memberOf(model_, "bufferViews"), unsignedOf(accessor, "bufferView"));
    if (!view) return std::nullopt;
    if (memberOf(*view, "byteStride") && unsignedOf(*view, "byteStride") != bytes)
      return std::nullopt;
    const auto number = unsignedOf(*view, "buffer");
    const auto buffer = number ? buffers_.bytesOf(model_, *number) : std::nullopt;
    const auto offset = offsetOf(*view), length = unsignedOf(*view, "byteLength");
    if (!buffer || !offset || !length || *offset > buffer->size() ||
        *length > buffer->size() - *offset)
      return std::nullopt;
    return buffer->substr(*offset, *length);
  }

  const json& model_;
  GltfBuffers& buffers_;
};

// Returns whether MERLIN wrote vertex colours as an application-specific attribute in addition to a
// texture: glTF's own vertex colours would be multiplied with the texture.
bool hasColoursBesideTexture(const json& model, const json& attributes) {
  const json* asset = memberOf(model, "asset");
  return asset && isString(*asset, "generator", "MERLIN") && memberOf(attributes, "TEXCOORD_0");
}

// Returns the number of floats per vertex of the feature that an attribute with this name becomes;
// 0 if it becomes no feature.
std::size_t dimensionOf(const std::string& name, bool coloured) {
  if (!name.starts_with('_')) return 0;
  const std::string feature = name.substr(1);
  if (feature == "colour") return coloured ? 3 : 0;
  const bool other = feature == "normal" || feature == "texcoord";
  return other || !mesh::featureNameFault(feature).empty() ? 0 : 1;
}

// Returns the values of a primitive's application-specific attributes, as far as they can be read.
GltfValues valuesOf(const ValueReader& reader, const json& model, const json& attributes) {
  GltfValues own;
  const json* position = memberOf(attributes, "POSITION");
  const auto places =
      position ? reader.bytesOf(reader.accessor(*position), "VEC3", 3) : std::nullopt;
  if (!places) return own;
  own.positions = *places;
  const bool coloured = hasColoursBesideTexture(model, attributes);
  for (const auto& [name, index] : attributes.items()) {
    const std::size_t n = dimensionOf(name, coloured);
    if (n == 0) continue;
    const auto bytes = reader.bytesOf(reader.accessor(index), n == 1 ? "SCALAR" : "VEC3", n);
    if (bytes && bytes->size() / n == places->size() / 3)
      own.features.push_back({name.substr(1), n, *bytes});
  }
  return own;
}

// Returns the attributes of all primitives.
std::vector<const json*> attributesOf(const json& model) {
  std::vector<const json*> all;
  const auto arrayIn = [](const json& object, const char* name) {
    const json* found = memberOf(object, name);
    return found && found->is_array() ? found : nullptr;
  };
  const json* meshes = arrayIn(model, "meshes");
  for (std::size_t m = 0; meshes && m < meshes->size(); ++m) {
    const json* primitives = arrayIn((*meshes)[m], "primitives");
    for (std::size_t p = 0; primitives && p < primitives->size(); ++p) {
      const json* attributes = memberOf((*primitives)[p], "attributes");
      if (attributes && attributes->is_object()) all.push_back(attributes);
    }
  }
  return all;
}

// Returns whether a primitive may have application-specific values; only then are the buffers read.
bool hasOwnAttribute(const json& attributes) {
  for (const auto& [name, index] : attributes.items()) {
    if (name.starts_with('_')) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string_view> GltfBuffers::bytesOf(const json& model, std::uint64_t number) {
  const auto known = buffers_.find(number);
  if (known != buffers_.end()) return known->second.bytes;
  Buffer& buffer = buffers_[number];
  read(model, number, buffer);
  return buffer.bytes;
}

void GltfBuffers::read(const json& model, std::uint64_t number, Buffer& buffer) const {
  const json* const entry = elementOf(memberOf(model, "buffers"), number);
  if (!entry || !entry->is_object()) return;
  const json* const uri = memberOf(*entry, "uri");
  if (!uri && number == 0 && file_.starts_with("glTF")) buffer.bytes = binaryChunk(file_);
  if (!uri || !uri->is_string()) return;
  const auto& text = uri->get_ref<const std::string&>();
  if (text.starts_with("data:")) {
    if (auto decoded = decodedUri(text)) buffer.decoded = *std::move(decoded);
    buffer.bytes = buffer.decoded;
  } else if (auto file = MappedFile::open(companionPath(folder_, text))) {
    buffer.file = *std::move(file);
    const auto bytes = buffer.file.bytes();
    buffer.bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
}

std::vector<GltfValues> ownValuesOf(const json& model, GltfBuffers& buffers) {
  const std::vector<const json*> primitives = attributesOf(model);
  if (std::ranges::none_of(primitives, [](const json* a) { return hasOwnAttribute(*a); }))
    return {};
  const ValueReader reader(model, buffers);
  std::vector<GltfValues> all;
  for (const json* attributes : primitives) all.push_back(valuesOf(reader, model, *attributes));
  const auto has = [](const GltfValues& values) { return !values.features.empty(); };
  return std::ranges::any_of(all, has) ? all : std::vector<GltfValues>();
}

std::vector<float> floatsOf(std::string_view bytes) {
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  std::vector<float> values(bytes.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = loadLeFloat(p + 4 * i);
  return values;
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
