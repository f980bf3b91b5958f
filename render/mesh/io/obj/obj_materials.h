// Reads the materials of an OBJ file: each has a texture image, or one diffuse colour. Private to
// render/mesh/io.
#pragma once

#include <array>
#include <compare>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/image/image_file.h"

namespace merlin::render::mesh {

struct ObjMaterial {
  std::shared_ptr<const image::ImageFile>
      picture;           // map_Kd; shared by materials that name the same file
  bool clamped = false;  // the texture does not repeat
  std::optional<std::array<float, 3>> diffuse;  // Kd

  image::Wrap wrap() const noexcept { return clamped ? image::Wrap::kClamp : image::Wrap::kRepeat; }

  auto operator<=>(const ObjMaterial&) const = default;
};

// Reads the materials called `names` from the material files `libraries` of an OBJ file in `folder`
// ("" or with a trailing slash); returns one entry for each name. Only files in that folder or
// below are opened; any other path is reduced to its last component. Files that cannot be read are
// skipped, and a line in `notes` says why.
std::vector<ObjMaterial> readMaterials(const std::vector<std::string>& names,
                                       const std::vector<std::string>& libraries,
                                       const std::string& folder, std::vector<std::string>& notes);

// Returns the paths of the images that readMaterials() would read, each once. Opens no image.
std::vector<std::string> picturesOf(const std::vector<std::string>& names,
                                    const std::vector<std::string>& libraries,
                                    const std::string& folder);

}  // namespace merlin::render::mesh
