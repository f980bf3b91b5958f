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

namespace merlin::render::import {

class ModelTextures {
 public:
  // folder: that of the model, in which (and below which) texture images are looked for.
  explicit ModelTextures(std::string folder) : folder_(std::move(folder)) {}

  // The image that the model calls `name`; null if it cannot be had, which a note then says.
  const image::ImageFile* named(const std::string& name);
  // An image inside the model, PNG or JPEG; `name` is its name there.
  const image::ImageFile* inside(const std::string& name, std::span<const std::uint8_t> file);
  // An image of pixels; null if it is empty.
  const image::ImageFile* ofPixels(const std::string& name, image::ImageFile pixels);

  // The image times a colour, proportional to light; each is made once. The image itself where that
  // fails, which a note then says.
  const image::ImageFile* tinted(const image::ImageFile& image, const std::array<float, 3>& factor);

  const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  const image::ImageFile* once(const std::string& name,
                               const std::function<Result<image::ImageFile>()>& read);

  std::string folder_;
  std::map<std::string, std::unique_ptr<image::ImageFile>> images_;
  std::map<std::pair<const image::ImageFile*, std::array<float, 3>>, image::ImageFile> tinted_;
  std::vector<std::string> notes_;
};

}  // namespace merlin::render::import
