#include "render/import/gltf_check.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/bytes.h"
#include "daemon/base/printable_text.h"
#include "render/import/gltf_json.h"

namespace merlin::render::import {
namespace {

using nlohmann::json;

constexpr std::int64_t kFloat = 5126;  // componentType

// Extensions that a file may require. They do not change what MERLIN displays (light, shine), or
// are supported (texture transforms), or their effects are checked separately (quantised
// attributes).
constexpr std::string_view kHarmless[] = {"KHR_mesh_quantization",
                                          "KHR_texture_transform",
                                          "KHR_lights_punctual",
                                          "KHR_materials_anisotropy",
                                          "KHR_materials_clearcoat",
                                          "KHR_materials_dispersion",
                                          "KHR_materials_emissive_strength",
                                          "KHR_materials_ior",
                                          "KHR_materials_iridescence",
                                          "KHR_materials_pbrSpecularGlossiness",
                                          "KHR_materials_sheen",
                                          "KHR_materials_specular",
                                          "KHR_materials_transmission",
                                          "KHR_materials_unlit",
                                          "KHR_materials_variants",
                                          "KHR_materials_volume",
                                          "KHR_xmp_json_ld"};

// Attributes that MERLIN takes from assimp and that must be floats, by the beginnings of their
// names. Normals are not listed, since they are computed from the surface; neither are colours,
// which assimp converts.
constexpr std::string_view kFloats[] = {"POSITION", "TEXCOORD_", "WEIGHTS_"};

Error malformedGltf(const std::string& what) { return {Errc::kMalformed, "glTF: " + what}; }

// Returns the array of this name; an empty one if there is none. Errors: kMalformed if it is not an
// array.
Result<const json*> arrayOf(const json& object, const char* name) {
  static const json kEmpty = json::array();
  const json* found = memberOf(object, name);
  if (!found) return &kEmpty;
  if (!found->is_array()) return malformedGltf(fmt::format("{} is not an array", name));
  return found;
}

// Returns the JSON of the file; for a .glb, this is its first chunk. Returns nothing for a .glb of
// another version.
Result<std::optional<std::string_view>> textOf(std::string_view file) {
  constexpr std::size_t kHead = 12, kChunkHead = 8;
  if (!file.starts_with("glTF")) return std::optional(file);
  if (file.size() < kHead + kChunkHead) return malformedGltf("is cut in its first 20 bytes");
  const auto* p = reinterpret_cast<const std::uint8_t*>(file.data());
  if (loadLe32(p + 4) != 2) return std::optional<std::string_view>();
  const std::size_t length = loadLe32(p + kHead);
  if (file.substr(kHead + 4, 4) != "JSON") return malformedGltf("its first chunk is not JSON");
  if (length > file.size() - kHead - kChunkHead)
    return malformedGltf(fmt::format("its first chunk has {} bytes, {} are there", length,
                                     file.size() - kHead - kChunkHead));
  const std::string_view text = file.substr(kHead + kChunkHead, length);
  // Some writers fill the chunk with zeros instead of blanks.
  return std::optional(text.substr(0, text.find_last_not_of('\0') + 1));
}

// Returns true for glTF 1, whose JSON has a different form.
bool isFirstVersion(const json& model) {
  const json* asset = memberOf(model, "asset");
  const json* version = asset ? memberOf(*asset, "version") : nullptr;
  if (!version) return false;
  return version->is_string() ? version->get_ref<const std::string&>().starts_with('1')
                              : version->is_number() && version->get<double>() < 2;
}

Result<Ok> checkExtensions(const json& model) {
  const auto required = arrayOf(model, "extensionsRequired");
  if (!required) return required.error();
  for (const json& name : **required) {
    if (!name.is_string())
      return malformedGltf("extensionsRequired has an entry that is not a name");
    const auto& text = name.get_ref<const std::string&>();
    if (std::ranges::find(kHarmless, text) != std::end(kHarmless)) continue;
    return Error{Errc::kUnsupported,
                 fmt::format("requires the glTF extension {}, which is not read; export the model "
                             "without it (compression and instances off, textures as PNG or JPEG)",
                             oneLine(excerpt(text)))};
  }
  return Ok{};
}

// Checks that an attribute is of floats, if it must be. `where`: the primitive, for messages.
Result<Ok> checkAttribute(const json& accessors, const std::string& where, const std::string& name,
                          const json& index) {
  const auto reads = [&](std::string_view begin) { return name.starts_with(begin); };
  if (std::ranges::none_of(kFloats, reads)) return Ok{};
  const std::string what = fmt::format("{}: {}", where, oneLine(excerpt(name)));
  if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors.size())
    return malformedGltf(fmt::format("{} names no accessor; there are {}", what, accessors.size()));
  const auto number = index.get<std::uint64_t>();
  const json* type = memberOf(accessors[number], "componentType");
  if (!type || !type->is_number_integer())
    return malformedGltf(fmt::format("accessor {} has no componentType", number));
  if (type->get<std::int64_t>() == kFloat) return Ok{};
  return Error{Errc::kUnsupported,
               fmt::format("{} is quantised (accessor {} has componentType {}); only floats "
                           "({}) are read: export the model without quantisation, or convert it: "
                           "gltfpack -noq -i IN -o OUT.glb",
                           what, number, type->get<std::int64_t>(), kFloat)};
}

// Returns the number of triangles that `count` corners or indices form.
std::uint64_t trianglesOf(const json& primitive, std::uint64_t count) {
  const json* mode = memberOf(primitive, "mode");
  if (mode && !mode->is_number_unsigned()) return 0;
  switch (mode ? mode->get<std::uint64_t>() : 4) {
    case 4: return count / 3;
    case 5:
    case 6: return count < 3 ? 0 : count - 2;  // a strip, a fan
    default: return 0;
  }
}

// Returns the number of triangles that a primitive declares; 0 if it is malformed, which assimp
// reports.
std::uint64_t promisedTriangles(const json& accessors, const json& primitive,
                                const json& attributes) {
  const json* of = memberOf(primitive, "indices");
  if (!of) of = memberOf(attributes, "POSITION");
  if (!of || !of->is_number_unsigned() || of->get<std::uint64_t>() >= accessors.size()) return 0;
  const json* count = memberOf(accessors[of->get<std::uint64_t>()], "count");
  return count && count->is_number_unsigned() ? trianglesOf(primitive, count->get<std::uint64_t>())
                                              : 0;
}

Result<Ok> checkMesh(const json& accessors, std::size_t number, const json& mesh,
                     GltfPromise& all) {
  const auto primitives = arrayOf(mesh, "primitives");
  if (!primitives) return primitives.error();
  for (std::size_t p = 0; p < (*primitives)->size(); ++p) {
    const std::string where = fmt::format("mesh {}, primitive {}", number, p);
    const json& primitive = (**primitives)[p];
    const json* attributes = memberOf(primitive, "attributes");
    if (!attributes || !attributes->is_object()) return malformedGltf(where + " has no attributes");
    for (const auto& [name, index] : attributes->items()) {
      if (const auto good = checkAttribute(accessors, where, name, index); !good) return good;
      if (name.starts_with('_')) all.own_attributes.insert(oneLine(excerpt(name)));
    }
    all.primitives.push_back({number, p, promisedTriangles(accessors, primitive, *attributes)});
  }
  return Ok{};
}

}  // namespace

Result<GltfPromise> checkGltf(std::string_view file, GltfBuffers& buffers) {
  GltfPromise all;
  const auto text = textOf(file);
  if (!text) return text.error();
  if (!*text) return all;
  const json model = json::parse((*text)->begin(), (*text)->end(), nullptr, false);
  if (!model.is_object()) return malformedGltf("its JSON is damaged or cut");
  if (isFirstVersion(model)) return all;
  if (const auto good = checkExtensions(model); !good) return good.error();
  const auto accessors = arrayOf(model, "accessors"), meshes = arrayOf(model, "meshes");
  if (!accessors) return accessors.error();
  if (!meshes) return meshes.error();
  for (std::size_t m = 0; m < (*meshes)->size(); ++m) {
    if (const auto good = checkMesh(**accessors, m, (**meshes)[m], all); !good) return good.error();
  }
  all.own = ownValuesOf(model, buffers);
  return all;
}

}  // namespace merlin::render::import
