// Reads the vertex attributes of a glTF file that glTF does not define, since assimp skips them.
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

// The bytes of a glTF file's buffers: the binary chunk of a .glb, base64 in the JSON, or a file
// beside it. Each is read when it is first asked for. Thread-bound.
class GltfBuffers {
 public:
  // `file`: the whole file, and must outlive this; `folder`: that of the file ("" or with a
  // trailing slash), below which other files are opened (companion_path.h).
  GltfBuffers(std::string_view file, std::string folder)
      : file_(file), folder_(std::move(folder)) {}

  // Returns the bytes of that buffer, which stay as long as this; nothing if there is no such
  // buffer or it cannot be read. `model`: the file's JSON, the same one each time.
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

// Numbers of a primitive's vertices, as little-endian floats in one of the file's buffers.
struct GltfFeature {
  std::string name{};  // of the feature: "heat" of the attribute "_heat"
  std::size_t dimension = 1;
  std::string_view bytes{};
};

// What could be read of a primitive; all empty if its positions could not.
struct GltfValues {
  std::string_view positions{};  // vertices x 3 floats, to match them with another reader's
  // Also "colour" (3, proportional to light) if MERLIN wrote the file with a texture. May contain
  // NaN.
  std::vector<GltfFeature> features{};
};

// Finds the vertex attributes of floats whose names begin with "_". They must lie without gaps in a
// buffer; others are ignored, and the caller may add a note about them. Returns an entry for each
// primitive, or none at all if no primitive has such an attribute. `model`: the JSON of a whole
// file of version 2. Each offset and count is checked against the buffer. The values stay as long
// as `buffers`. May throw std::bad_alloc.
std::vector<GltfValues> ownValuesOf(const nlohmann::json& model, GltfBuffers& buffers);

// The numbers of such bytes.
std::vector<float> floatsOf(std::string_view bytes);

// Returns for each row of the features the index of the first row with the same values. O(n log n).
// REQUIRES: no value is NaN, and each feature has `rows` rows.
std::vector<std::uint32_t> firstEqualRows(const std::vector<mesh::Feature>& features,
                                          std::size_t rows);

}  // namespace merlin::render::import
