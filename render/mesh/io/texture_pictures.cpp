#include "render/mesh/io/texture_pictures.h"

namespace merlin::render::mesh {

Result<image::ImageFile> TexturePictures::read(const std::string& path) {
  const auto bytes = image::imageBytes(path);
  if (!bytes) return bytes.error();
  if (*bytes > left_)
    return Error{Errc::kUnsupported,
                 path + ": the model's texture images have more than 2^28 pixels together"};
  left_ -= *bytes;
  return image::readImage(path);
}

}  // namespace merlin::render::mesh
