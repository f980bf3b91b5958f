// Reads the texture images of one model, up to a limit of their sizes together. Private to
// render/mesh/io.
#pragma once

#include <cstddef>
#include <string>

#include "daemon/base/result.h"
#include "render/image/image_file.h"

namespace merlin::render::mesh {

class TexturePictures {
 public:
  // As many pixels as one image may have.
  static constexpr std::size_t kMostBytes = std::size_t{3} << 28;

  explicit TexturePictures(std::size_t most_bytes = kMostBytes) : left_(most_bytes) {}

  // Errors: those of readImage(); kUnsupported if it and those before it have more pixels than the
  // limit allows, before memory is taken for it.
  Result<image::ImageFile> read(const std::string& path);

 private:
  std::size_t left_;  // [bytes] of pixels
};

}  // namespace merlin::render::mesh
