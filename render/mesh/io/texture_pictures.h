// TexturePictures: reads the texture images of one model, up to a limit of their total size.
// Private to render/mesh/io.
#pragma once

#include <cstddef>
#include <string>

#include "daemon/base/result.h"
#include "render/image/image_file.h"

namespace merlin::render::mesh {

class TexturePictures {
 public:
  // Size of 2^28 RGB pixels [bytes]; a single image may have as many pixels.
  static constexpr std::size_t kMostBytes = std::size_t{3} << 28;

  explicit TexturePictures(std::size_t most_bytes = kMostBytes) : left_(most_bytes) {}

  // Reads an image file. Errors: those of readImage(); kUnsupported if this image and those read
  // before exceed the limit together, which is checked before memory is allocated for the image.
  Result<image::ImageFile> read(const std::string& path);

 private:
  std::size_t left_;  // remaining size of pixels [bytes]
};

}  // namespace merlin::render::mesh
