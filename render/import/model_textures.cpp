#include "render/import/model_textures.h"

#include <utility>

#include "render/mesh/io/companion_files.h"

namespace merlin::render::import {

const image::ImageFile* ModelTextures::once(const std::string& name,
                                            const std::function<Result<image::ImageFile>()>& read) {
  const auto [found, fresh] = images_.try_emplace(name);
  if (!fresh) return found->second.get();
  auto image = read();
  if (image)
    found->second = std::make_unique<image::ImageFile>(*std::move(image));
  else
    notes_.push_back(image.error().what + "; this texture is left out");
  return found->second.get();
}

const image::ImageFile* ModelTextures::named(const std::string& name) {
  return once(name, [&]() -> Result<image::ImageFile> {
    if (name.empty() || name.find('\0') != std::string::npos)
      return Error{Errc::kMalformed, "an empty name of a texture image"};
    return image::readImage(mesh::pathBeside(folder_, name));
  });
}

const image::ImageFile* ModelTextures::inside(const std::string& name,
                                              std::span<const std::uint8_t> file) {
  return once(name, [&]() -> Result<image::ImageFile> {
    auto image = image::decodeImage(file);
    if (!image)
      return Error{image.error().code, "the texture " + name + " inside: " + image.error().what};
    image->file.assign(file.begin(), file.end());
    return image;
  });
}

const image::ImageFile* ModelTextures::ofPixels(const std::string& name, image::ImageFile pixels) {
  return once(name, [&]() -> Result<image::ImageFile> {
    if (pixels.pixels.empty()) return Error{Errc::kMalformed, "a texture without pixels"};
    return std::move(pixels);
  });
}

}  // namespace merlin::render::import
