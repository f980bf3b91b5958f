// Colours of an OBJ file's materials: a picture, or one colour. Private to render/mesh/io.
#pragma once

#include <array>
#include <compare>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/image/image_file.h"

namespace merlin::render {

struct ObjMaterial {
  std::shared_ptr<const ImageFile> picture;     // map_Kd; shared by materials that name one file
  bool clamped = false;                         // the picture does not repeat
  std::optional<std::array<float, 3>> diffuse;  // Kd

  auto operator<=>(const ObjMaterial&) const = default;
};

// The materials of these names, from the libraries that an OBJ file in `folder` ("" or with a
// slash at its end) names. Only files in that folder or below are opened: of another path its last
// part. What could not be had is not there, and a line in `notes` says why.
std::vector<ObjMaterial> readMaterials(const std::vector<std::string>& names,
                                       const std::vector<std::string>& libraries,
                                       const std::string& folder, std::vector<std::string>& notes);

}  // namespace merlin::render
