// ModelTextures: the texture images of a model, each read once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/image/image_file.h"
#include "render/import/model_file.h"
#include "render/mesh/io/companion_files.h"

namespace merlin::render::import {

class ModelTextures {
 public:
  // Makes an empty collection. Texture images will be searched for in the model's folder and below
  // it.
  explicit ModelTextures(const ModelFile& model);

  // Returns the image that the model calls `name`; null if it cannot be read, and a note explains
  // why. All images stay valid as long as this object.
  const image::ImageFile* named(const std::string& name);
  // Decodes a PNG or JPEG image that is embedded in the model; `name` is its name in the model.
  // Returns null if it cannot be decoded, and a note explains why.
  const image::ImageFile* inside(const std::string& name, std::span<const std::uint8_t> file);
  // Stores an image that is embedded in the model as pixels; returns null if it is empty.
  const image::ImageFile* ofPixels(const std::string& name, image::ImageFile pixels);

  // Returns the image multiplied by a colour, proportional to light; each product is computed once.
  // On failure returns the image itself and adds a note.
  const image::ImageFile* tinted(const image::ImageFile& image, const std::array<float, 3>& factor);

  std::vector<std::string> notes() const;

 private:
  const image::ImageFile* once(const std::string& name,
                               const std::function<Result<image::ImageFile>()>& read);

  mesh::CompanionFinder files_;
  std::map<std::string, std::unique_ptr<image::ImageFile>> images_;
  std::map<std::pair<const image::ImageFile*, std::array<float, 3>>, image::ImageFile> tinted_;
  std::vector<std::string> notes_;
};

}  // namespace merlin::render::import
