// Reads application-specific vertex attributes of a glTF file, i.e. those that the format does not
// define, since assimp skips them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"

namespace merlin::render::import {

// The bytes of a glTF file's buffers: the binary chunk of a .glb, base64 in the JSON, or a separate
// file in the same folder or below. Each buffer is read on its first use. Thread-bound.
class GltfBuffers {
 public:
  // `file`: the whole glTF file, which must outlive this object. `folder`: the folder of the file
  // ("" or with a trailing slash), below which other files are opened (companion_path.h).
  GltfBuffers(std::string_view file, std::string folder)
      : file_(file), folder_(std::move(folder)) {}

  // Returns the bytes of buffer `number`, which stay valid as long as this object; nothing if there
  // is no such buffer or it cannot be read. `model`: the file's JSON, the same object in each call.
  std::optional<std::string_view> bytesOf(const nlohmann::json& model, std::uint64_t number);

 private:
  struct Buffer {
    MappedFile file{};
    std::string decoded{};
    std::optional<std::string_view> bytes{};
  };
  void read(const nlohmann::json& model, std::uint64_t number, Buffer& buffer) const;

  std::string_view file_;
  std::string folder_;
  std::map<std::uint64_t, Buffer> buffers_{};
};

// A feature of a primitive's vertices: little-endian floats in one of the file's buffers.
struct GltfFeature {
  std::string name{};  // name of the feature: "heat" for the attribute "_heat"
  std::size_t dimension = 1;
  std::string_view bytes{};
};

// The values that could be read of a primitive; all are empty if its positions could not be read.
struct GltfValues {
  std::string_view positions{};  // vertices x 3 floats, for matching with assimp's meshes
  // Features of the vertices. They include "colour" (3, proportional to light) if MERLIN wrote the
  // file with a texture. Values may be NaN.
  std::vector<GltfFeature> features{};
};

// Finds vertex attributes of floats whose names begin with "_". Attributes with gaps between their
// elements in the buffer are ignored; the caller may add a note about them. Returns an entry for
// each primitive, or none at all if no primitive has such an attribute. `model`: the JSON of a
// whole file of glTF 2. Each offset and count is checked against the buffer. The values stay valid
// as long as `buffers`. May throw std::bad_alloc.
std::vector<GltfValues> ownValuesOf(const nlohmann::json& model, GltfBuffers& buffers);

// Converts little-endian floats, such as GltfFeature::bytes, to numbers.
std::vector<float> floatsOf(std::string_view bytes);

// Returns for each row of the features the index of the first row with the same values. O(n log n).
// REQUIRES: no value is NaN, and each feature has `rows` rows.
std::vector<std::uint32_t> firstEqualRows(const std::vector<mesh::Feature>& features,
                                          std::size_t rows);

}  // namespace merlin::render::import
