#include "render/import/model_textures.h"

#include <cerrno>
#include <filesystem>
#include <utility>

#include <fcntl.h>

#include "daemon/base/unique_fd.h"
#include "render/image/tint.h"
#include "render/import/companion_path.h"

namespace merlin::render::import {
namespace {

// Returns whether the file exists but the sandbox of daemon/import forbids opening it.
bool isForbidden(const std::string& path) {
  const UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return !file.valid() && errno == EACCES;
}

// Returns the files in the model's folder and below, as paths that begin with the folder as the
// model's path spells it.
std::vector<std::string> filesBeside(const ModelFile& model) {
  const std::string folder = mesh::folderOf(model.path);
  const std::string whole = mesh::folderOf(std::filesystem::absolute(model.path).string());
  std::vector<std::string> files;
  for (const std::string& file : model.beside) {
    if (file.starts_with(whole)) files.push_back(folder + file.substr(whole.size()));
  }
  return files;
}

}  // namespace

ModelTextures::ModelTextures(const ModelFile& model)
    : files_(mesh::folderOf(model.path), filesBeside(model)) {}

std::vector<std::string> ModelTextures::notes() const {
  std::vector<std::string> notes = notes_;
  if (std::string other = files_.note(); !other.empty()) notes.push_back(std::move(other));
  return notes;
}

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
    const std::string path = companionPath(files_, name);
    auto image = image::readImage(path);
    if (!image && isForbidden(path))
      return Error{image.error().code,
                   image.error().what +
                       " (only visible files in the model's folder and in its "
                       "visible folders are read, 4096 in all; put it beside the model)"};
    return image;
  });
}

const image::ImageFile* ModelTextures::inside(const std::string& name,
                                              std::span<const std::uint8_t> file) {
  return once(name, [&]() -> Result<image::ImageFile> {
    auto image = image::decodeImage(file);
    if (!image)
      return Error{image.error().code,
                   "the texture " + name + " inside the model: " + image.error().what};
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

const image::ImageFile* ModelTextures::tinted(const image::ImageFile& image,
                                              const std::array<float, 3>& factor) {
  const std::pair key(&image, factor);
  const auto found = tinted_.find(key);
  if (found != tinted_.end()) return &found->second;
  auto made = image::tinted(image, factor, image::Light::kLinear);
  if (made) return &tinted_.emplace(key, *std::move(made)).first->second;
  notes_.push_back("a texture is shown without its material's colour: " + made.error().what);
  return &image;
}

}  // namespace merlin::render::import
