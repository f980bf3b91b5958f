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
  // Texture images are searched for in the model's folder and below it.
  explicit ModelTextures(const ModelFile& model);

  // Returns the image that the model calls `name`; null if it cannot be read, and a note says why.
  const image::ImageFile* named(const std::string& name);
  // Decodes an image that the model contains as PNG or JPEG; `name` is its name in the model.
  const image::ImageFile* inside(const std::string& name, std::span<const std::uint8_t> file);
  // Takes an image that the model contains as pixels; returns null if it is empty.
  const image::ImageFile* ofPixels(const std::string& name, image::ImageFile pixels);

  // Returns the image multiplied by a colour, proportional to light; each product is computed once.
  // If that fails, returns the image itself, and a note says so.
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
